"""Ctrl-C and time limits: what was found so far is given, and files are whole."""

import contextlib
import json
import os
import signal
import subprocess
import sys

import numpy as np
import pytest
from command import program
from planted import planted_task
from sessions import NAMES, ONE_TARGET, names, status

from synth.cli.session import Session

# Signals come exactly where they hurt, so that no test waits or hopes.
SIGNAL = "import os, signal\ndef press(): os.kill(os.getpid(), signal.{signal})\n"


def noisy_content(count):
    """A task without an exact answer, of which the least worst miss is asked."""
    task, _ = planted_task(5, count)
    noise = np.random.default_rng(0).normal(scale=0.03, size=(count, 3))
    targets = [
        {"position": (target.position + shift).tolist()}
        for target, shift in zip(task.targets, noise, strict=True)
    ]
    header = "synth: 1\nlength_unit: m\nrobot: malleable-2dof\nfloor: null\nobjective: minimax\n"
    return f"{header}targets: {json.dumps(targets)}\n"


def test_a_time_limit_keeps_the_best_so_far(tmp_path):
    file = tmp_path / "noisy.yaml"
    file.write_text(noisy_content(12))
    # The time is up as soon as one start point is polished, on a fast machine and on a slow one.
    late = (
        "from synth.synthesis.searching import Search\n"
        "original = Search.polish\n"
        "def polished(self, start):\n"
        "    original(self, start)\n"
        "    self._watch._began -= 1000.0\n"
        "Search.polish = polished\n"
    )
    answer = program("solve", file, "--json", "--time-limit", "500", before=late)
    solution = json.loads(answer.stdout)
    assert answer.returncode == 1
    assert (solution["status"], solution["starts"]) == ("limit", 1)
    unlimited = json.loads(program("solve", file, "--json").stdout)
    assert unlimited["status"] == "best_effort"
    assert unlimited["starts"] > 1


@pytest.mark.skipif(os.name == "nt", reason="Windows sends no SIGINT to one process")
def test_ctrl_c_keeps_the_best_so_far(tmp_path):
    # The command waits for what is written into a pipe: when it has read that, its search is about to begin.
    pipe = tmp_path / "noisy.yaml"
    os.mkfifo(pipe)
    with subprocess.Popen(
        [sys.executable, "-m", "synth", "solve", str(pipe), "--json"],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    ) as process:  # fmt: skip
        pipe.write_text(noisy_content(40))
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=60)
    assert "Traceback" not in err
    assert "the best shape so far is kept" in err
    solution = json.loads(out)
    assert process.returncode == 1
    assert solution["status"] == "limit"


@pytest.mark.skipif(os.name == "nt", reason="Windows sends no such signal to one process")
@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM"])
@pytest.mark.parametrize(
    ("module", "function"),
    [
        ("synth.task.reading", "load_task"),
        ("synth.synthesis.run", "why_impossible"),
        ("synth.export.files", "draw_sheet"),
    ],
)
def test_a_wish_to_stop_anywhere_still_gives_the_best_so_far(tmp_path, module, function, name):
    before = SIGNAL.format(signal=name) + (
        f"import {module} as module\n"
        f"original = module.{function}\n"
        "def pressed(*arguments, **options):\n"
        "    press()\n"
        "    return original(*arguments, **options)\n"
        f"module.{function} = pressed\n"
    )
    if function == "load_task":
        before += "import synth.task\nsynth.task.load_task = pressed"
    answer = program("solve", ONE_TARGET, "-o", tmp_path, before=before)
    assert "the best shape so far is kept" in answer.stderr
    assert "Aborted" not in answer.stderr
    assert "Traceback" not in answer.stderr
    assert names(tmp_path) == NAMES
    assert (status(tmp_path), answer.returncode) == ("found", 0)


@pytest.mark.skipif(os.name == "nt", reason="Windows sends no such signal to one process")
def test_a_wish_to_stop_while_modules_load_is_kept_until_the_search(tmp_path):
    before = SIGNAL.format(signal="SIGINT") + (
        "import sys\n"
        "class Finder:\n"
        "    def find_spec(self, name, path=None, target=None):\n"
        "        if name == 'numpy':\n"
        "            sys.meta_path.remove(self)\n"
        "            press()\n"
        "sys.meta_path.insert(0, Finder())\n"
    )
    answer = program("solve", ONE_TARGET, "-o", tmp_path, before=before)
    assert answer.stderr.count("the best shape so far is kept") == 1
    assert names(tmp_path) == NAMES
    assert "Traceback" not in answer.stderr


@pytest.mark.skipif(os.name == "nt", reason="Windows sends no such signal to one process")
def test_a_second_wish_ends_at_once_and_keeps_what_is_written_whole(tmp_path):
    before = SIGNAL.format(signal="SIGINT") + (
        "import synth.export.files as files\n"
        "def pressed(*_):\n"
        "    press()\n"
        "    press()\n"
        "files.draw_sheet = pressed"
    )
    answer = program("solve", ONE_TARGET, "-o", tmp_path, before=before)
    assert answer.returncode == 130
    assert "ended at once" in answer.stderr
    assert "Traceback" not in answer.stderr
    assert answer.stdout == ""
    # The sheet was interrupted; the data were there.
    assert names(tmp_path) == NAMES - {"guide.pdf"}
    assert status(tmp_path) == "found"


@pytest.mark.skipif(os.name == "nt", reason="Windows sends no such signal to one process")
def test_a_second_wish_ends_the_search_at_once():
    before = SIGNAL.format(signal="SIGINT") + (
        "import synth.synthesis.searching.search as module\n"
        "def twice(*_):\n"
        "    press()\n"
        "    press()\n"
        "module.Search.run = twice"
    )
    answer = program("solve", ONE_TARGET, before=before)
    assert answer.returncode == 130
    assert answer.stdout == ""
    assert "Traceback" not in answer.stderr


def test_of_a_time_limit_something_is_left_for_writing():
    now = [50.0]
    session = Session(10.0, clock=lambda: now[0])
    now[0] += 3.0
    assert session.remaining == 7.0
    assert session.for_search(0) == pytest.approx(5.7)
    assert session.for_search(50_000) == pytest.approx(5.2)  # all of them are written
    assert session.for_search(10**6) == pytest.approx(2.1)
    now[0] += 6.0
    assert session.for_search(0) == pytest.approx(0.3)
    now[0] += 1.1
    assert session.remaining == session.for_search(0) == 0.0
    assert not session.is_late()  # a small task may still be looked at
    now[0] += 0.4
    assert session.is_late()


def test_a_task_that_is_not_read_in_time_is_not_searched_for(tmp_path):
    (tmp_path / "scan.csv").write_text("500,100,200\n" * 3)
    surface = "synth: 1\nlength_unit: mm\nrobot: malleable-2dof\nsurface: {points: scan.csv}\n"
    (tmp_path / "task.yaml").write_text(surface)
    before = "from synth.cli.session import Session\nSession.is_late = lambda self: True\n"
    answer = program("solve", tmp_path / "task.yaml", "--time-limit", 5, "-o", tmp_path, before=before)
    assert answer.returncode == 1
    assert answer.stdout == ""
    assert "before the task was read: nothing was searched for" in answer.stderr
    assert not (tmp_path / "solution.json").exists()


def test_a_sheet_is_not_begun_when_the_time_is_up(tmp_path):
    (tmp_path / "guide.pdf").write_text("of an earlier run")
    before = "from synth.cli.session import Session\nSession.is_up = lambda self: True\n"
    answer = program("solve", ONE_TARGET, "-o", tmp_path, before=before)
    assert answer.returncode == 0  # the answer is whole without it
    assert "guide.pdf could not be made: the time limit was over before it was begun" in answer.stderr
    assert json.loads((tmp_path / "solution.json").read_text())["status"] == "found"
    assert not (tmp_path / "guide.pdf").exists()


def test_signals_are_as_before_after_a_command():
    before = [signal.getsignal(each) for each in (signal.SIGINT, signal.SIGTERM)]
    with contextlib.suppress(ZeroDivisionError), Session(1.0).interruptible():
        raise ZeroDivisionError
    assert [signal.getsignal(each) for each in (signal.SIGINT, signal.SIGTERM)] == before
