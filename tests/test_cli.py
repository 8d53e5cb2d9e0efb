"""The command line: exit codes, what is printed where, and Ctrl-C."""

import io
import json
import re
import subprocess
import sys
from pathlib import Path

import click
import numpy as np
import pytest
from command import invoked, program
from planted import out_of_reach, planted_task
from wrong_tasks import WRONG

from synth.cli.terminal import as_shown

OUT_OF_REACH = Path(__file__).parents[1] / "problems" / "out-of-reach" / "task.yaml"

HEADER = "synth: 1\nlength_unit: m\nrobot: malleable-2dof\n"


def written(path, task, **keys):
    targets = [
        {"name": target.name, "position": target.position.tolist(), "tolerance": target.tolerance}
        for target in task.targets
    ]
    extra = "".join(f"{key}: {value}\n" for key, value in keys.items())
    path.write_text(f"{HEADER}{extra}targets: {json.dumps(targets)}\n")
    return path


@pytest.fixture
def easy(tmp_path):
    return written(tmp_path / "easy.yaml", planted_task(1, 3)[0])


def test_help_needs_no_heavy_library():
    program = (
        "import sys; from synth.cli import main\n"
        "try: main(['--help'], standalone_mode=False)\n"
        "finally: print(sorted({m.split('.')[0] for m in sys.modules}))"
    )
    answer = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert "Exit codes" in answer.stdout
    for library in ("numpy", "casadi", "scipy", "matplotlib", "pydantic", "rich", "ruamel"):
        assert f"'{library}'" not in answer.stdout


def test_a_found_task_exits_with_0_and_writes_its_files(easy, tmp_path):
    answer = program("solve", easy, "-o", tmp_path / "out")
    assert answer.returncode == 0
    assert "every target is within its tolerance" in answer.stdout
    assert {path.name for path in (tmp_path / "out").iterdir()} == {
        "solution.json", "guide.pdf", "guide.html", "markers.csv"
    }  # fmt: skip
    assert json.loads((tmp_path / "out" / "solution.json").read_text())["status"] == "found"


def test_json_is_all_that_stands_on_stdout_and_stderr_is_silent_in_a_pipe(easy):
    answer = program("solve", easy, "--json", "--seed", "3")
    solution = json.loads(answer.stdout)
    assert solution["schema"] == "synth.solution/2"
    assert solution["seed"] == 3
    assert answer.stderr == ""


def test_the_same_task_and_seed_give_the_same_answer(easy):
    first, second = (json.loads(program("solve", easy, "--json").stdout) for _ in range(2))
    del first["time"], second["time"]
    assert first == second


def test_a_task_out_of_reach_exits_with_1_and_still_writes_its_best_effort(tmp_path):
    answer = program(
        "solve", written(tmp_path / "far.yaml", out_of_reach(2)), "-o", tmp_path / "out", "--json"
    )
    assert answer.returncode == 1
    solution = json.loads(answer.stdout)
    assert solution["status"] == "proven_impossible"
    assert "reaches at most" in solution["message"]
    assert all(np.isfinite(target["miss"]) for target in solution["targets"])
    assert (tmp_path / "out" / "guide.pdf").exists()


def test_another_shape_is_given_on_request_and_one_too_many_is_refused(easy, tmp_path):
    best = json.loads(program("solve", easy, "--json").stdout)
    count = 1 + len(best["alternatives"])
    assert count > 1
    answer = program("solve", easy, "--json", "--shape", 2, "-o", tmp_path / "out")
    assert answer.returncode == 0
    second = json.loads(answer.stdout)
    assert second["shape"] == 2
    assert second["link"]["arcs"] == best["alternatives"][0]["link"]["arcs"]
    assert json.loads((tmp_path / "out" / "solution.json").read_text())["guide"] == second["guide"]
    answer = program("solve", easy, "--shape", count + 1)
    assert answer.returncode == 2
    assert answer.stdout == ""
    assert re.fullmatch(rf"there is no shape {count + 1} to show: there are \d+ distinct .*\n", answer.stderr)


class Stream(io.StringIO):
    """A stream with an encoding, which says whether it is a terminal."""

    def __init__(self, encoding, terminal):
        super().__init__()
        self._encoding, self._terminal = encoding, terminal

    @property
    def encoding(self):
        return self._encoding

    def isatty(self):
        return self._terminal


TEXT = "✓ two crates: found\n✗ place  MISSED\n• 9.6 ± 2.1 mm"


def test_colour_comes_on_a_terminal_only_and_not_where_it_is_not_wanted(monkeypatch):
    monkeypatch.delenv("NO_COLOR", raising=False)
    shown = as_shown(TEXT, Stream("utf-8", terminal=True))
    assert click.unstyle(shown) == TEXT
    found, missed, bullet = shown.split("\n")
    assert found.startswith("\x1b[32m")
    assert missed.startswith("\x1b[31m")
    assert bullet == "• 9.6 ± 2.1 mm"
    assert as_shown(TEXT, Stream("utf-8", terminal=False)) == TEXT
    monkeypatch.setenv("NO_COLOR", "1")
    assert as_shown(TEXT, Stream("utf-8", terminal=True)) == TEXT


@pytest.mark.parametrize("encoding", ["ascii", "cp1252", "latin-1", None])
def test_signs_that_an_encoding_lacks_give_way_to_others_that_tell_found_from_missed(encoding):
    shown = as_shown(TEXT, Stream(encoding, terminal=False))
    shown.encode(encoding or "ascii")
    assert [line[0] for line in shown.split("\n")][:2] == ["+", "x"]


def test_why_says_what_would_release_a_task_that_is_not_met(tmp_path):
    answer = program("solve", OUT_OF_REACH, "--why", "-o", tmp_path)
    assert answer.returncode == 1
    assert re.search(r"• a link 12\d\.\d mm longer \(up to 82\d\.\d mm\) would do", answer.stdout)
    assert re.search(r"• the base moved by 12\d\.\d mm \(x .*, y .*, z .* mm\) would do", answer.stdout)
    first = json.loads((tmp_path / "solution.json").read_text())["releases"][0]
    assert first["limit"] == "link length"
    assert 0.119 < first["amount"] < 0.125


def test_wrong_input_exits_with_2_and_names_every_mistake(tmp_path):
    task = tmp_path / "wrong.yaml"
    task.write_text(HEADER + "topologie: any\ntargets:\n  - {position: [1, 2], tolerance: -1}\n")
    answer = program("solve", task, "-o", tmp_path / "out")
    assert answer.returncode == 2
    assert answer.stdout == ""
    for words in (
        r"wrong\.yaml:4: topologie", "did you mean 'topology'",
        r"wrong\.yaml:6: targets\[0\]\.position", r"targets\[0\]\.tolerance",
    ):  # fmt: skip
        assert re.search(words, answer.stderr), answer.stderr
    assert "Traceback" not in answer.stderr
    assert not (tmp_path / "out" / "solution.json").exists()


@pytest.mark.parametrize(("content", "key", "line", "words"), WRONG.values(), ids=WRONG)
def test_each_kind_of_malformed_file_exits_with_2_and_names_its_key(tmp_path, content, key, line, words):
    task = tmp_path / "task.yaml"
    task.write_bytes(content if isinstance(content, bytes) else content.encode())
    answer = invoked("solve", task, "--json")
    assert isinstance(answer.exception, SystemExit), answer.exception
    assert answer.exit_code == 2
    assert answer.stdout == ""
    place = f"{task}:{line}" if line else str(task)
    assert f"{place}: {key}: " in answer.stderr if key else f"{place}: " in answer.stderr
    assert all(word in answer.stderr for word in words.split())


@pytest.mark.parametrize(
    "arguments", [["solve"], ["solve", "x.yaml", "--seed", "-1"], ["slove"], ["solve", "--time-limit"]]
)
def test_wrong_usage_exits_with_2(arguments):
    answer = program(*arguments)
    assert answer.returncode == 2
    assert "Traceback" not in answer.stderr


def test_an_output_directory_that_cannot_be_exits_with_2_before_the_search(easy, tmp_path):
    (tmp_path / "file").write_text("")
    answer = program("solve", easy, "-o", tmp_path / "file" / "out")
    assert answer.returncode == 2
    assert "Traceback" not in answer.stderr


def test_the_module_and_the_command_are_the_same_program():
    ways = [Path(sys.executable).with_name("synth")], [sys.executable, "-m", "synth"]
    for way in ways:
        answer = subprocess.run([*way, "--version"], capture_output=True, text=True, check=True)
        assert answer.stdout == program("--version").stdout
