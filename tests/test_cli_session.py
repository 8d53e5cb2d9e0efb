"""A run of a command never loses its answer: files first, a net, signals, streams that take nothing."""

import errno
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from command import program
from sessions import NAMES, ONE_TARGET, names, status

OUT_OF_REACH = ONE_TARGET.parents[1] / "out-of-reach" / "task.yaml"
# Run before the command: changes one thing inside.
SHEET_FAILS = "import synth.export.files as files\ndef fail(*_): raise {error}\nfiles.draw_sheet = fail"


@pytest.mark.parametrize("error", ["MemoryError", "RecursionError('too deep')", "OSError(5, 'I/O error')"])
def test_a_sheet_that_cannot_be_drawn_costs_no_answer(tmp_path, error):
    (tmp_path / "guide.pdf").write_text("of another solution")
    answer = program("solve", ONE_TARGET, "-o", tmp_path, before=SHEET_FAILS.format(error=error))
    assert answer.returncode == 3
    assert names(tmp_path) == NAMES - {"guide.pdf"}
    assert status(tmp_path) == "found"
    assert "guide.pdf could not be made" in answer.stderr
    assert "every target is within its tolerance" in answer.stdout
    assert "Traceback" not in answer.stderr


@pytest.mark.parametrize(
    ("function", "keeps"),
    [
        ("synth.synthesis.starts.screening.estimated_misses", False),
        ("synth.synthesis.run.message", True),
        ("synth.guide.text.points_sentence", True),
        ("synth.export.files.solution_to_json", None),
        ("synth.task.reading.load_task", None),
    ],
)
def test_what_nobody_foresaw_is_one_sentence_and_exit_3(tmp_path, function, keeps):
    module, name = function.rsplit(".", 1)
    before = f"import {module} as module\ndef fail(*_, **__): raise ZeroDivisionError('by nought')\n"
    before += f"module.{name} = fail\nimport synth.task as task\ntask.load_task = module.{name} "
    before += f"if '{name}' == 'load_task' else task.load_task"
    answer = program("solve", ONE_TARGET, "-o", tmp_path / "out", before=before)
    assert answer.returncode == 3, answer.stderr
    assert "Traceback" not in answer.stderr
    assert len([line for line in answer.stderr.splitlines() if "by nought" in line]) == 1
    if keeps:
        assert status(tmp_path / "out") == "found"
    environment = os.environ | {"SYNTH_DEBUG": "1"}
    told = program("solve", ONE_TARGET, "-o", tmp_path / "out", before=before, env=environment)
    assert told.returncode == 3
    assert "Traceback" in told.stderr


def test_what_was_found_before_the_search_broke_off_is_kept(tmp_path):
    before = (
        "import synth.synthesis.searching.polishing as module\n"
        "keep, calls = module.Polishing.keep, []\n"
        "def once(self, *arguments):\n"
        "    if calls: raise MemoryError\n"
        "    calls.append(1)\n"
        "    return keep(self, *arguments)\n"
        "module.Polishing.keep = once"
    )
    answer = program("solve", OUT_OF_REACH, "-o", tmp_path, before=before)
    assert answer.returncode == 3
    assert "the search broke off: MemoryError" in answer.stderr
    assert names(tmp_path) == NAMES
    written = json.loads((tmp_path / "solution.json").read_text(encoding="utf-8"))
    assert written["status"] == "failed"
    assert max(target["miss"] for target in written["targets"]) > 0.1  # the shelf is out of reach
    assert "MISSED" in answer.stdout


def test_a_search_for_releases_that_breaks_off_keeps_the_solution(tmp_path):
    before = (
        "import synth.synthesis.blocking as module\n"
        "def fail(*_): raise ZeroDivisionError('by nought')\n"
        "module.limits_of = fail"
    )
    answer = program("solve", OUT_OF_REACH, "--why", "-o", tmp_path, before=before)
    assert answer.returncode == 3
    assert status(tmp_path) == "proven_impossible"
    assert "what would release the task was not found out" in answer.stdout


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a device that is full")
@pytest.mark.parametrize("form", [[], ["--json"]])
def test_an_output_that_is_full_costs_no_file(tmp_path, form):
    with Path("/dev/full").open("w") as full:
        answer = program(
            "solve", ONE_TARGET, "-o", tmp_path, *form, capture_output=False, stdout=full, stderr=full
        )
        assert answer.returncode == 0
        assert names(tmp_path) == NAMES
        # Without files the answer is lost, and that is no success.
        answer = program("solve", ONE_TARGET, capture_output=False, stdout=full, stderr=subprocess.PIPE)
    assert answer.returncode == 3
    assert "could not be printed" in answer.stderr
    assert "Exception ignored" not in answer.stderr


@pytest.mark.skipif(os.name == "nt", reason="a POSIX shell closes the streams")
def test_streams_that_are_closed_cost_no_file(tmp_path):
    command = f'"{sys.executable}" -m synth solve "{ONE_TARGET}" -o "{tmp_path}" >&- 2>&-'
    assert subprocess.run(["/bin/sh", "-c", command], check=False, timeout=300).returncode == 0
    assert names(tmp_path) == NAMES
    assert status(tmp_path) == "found"


def test_a_reader_that_has_gone_is_no_failure():
    with subprocess.Popen(
        [sys.executable, "-m", "synth", "solve", str(ONE_TARGET)],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    ) as process:  # fmt: skip
        process.stdout.close()
        err = process.stderr.read()
    assert process.returncode == 0
    assert err == ""


@pytest.mark.parametrize("encoding", ["ascii", "cp1252", "latin-1"])
def test_what_a_stream_cannot_print_is_replaced(tmp_path, encoding):
    task = tmp_path / "task.yaml"
    task.write_text(ONE_TARGET.read_text().replace("one crate", "ящик 机器人"), encoding="utf-8")
    out = tmp_path / "выход"
    environment = os.environ | {"PYTHONIOENCODING": encoding, "PYTHONUTF8": "0"}
    answer = program("solve", task, "-o", out, env=environment, encoding=encoding)
    assert answer.returncode == 0, answer.stderr
    assert "???? ???: every target is within its tolerance" in answer.stdout
    assert "+ crate" in answer.stdout
    assert ("•" if encoding == "cp1252" else "*") + " link " in answer.stdout
    assert names(out) == NAMES


def test_a_directory_in_the_place_of_a_file_is_noticed_before_anything_is_replaced(tmp_path):
    (tmp_path / "guide.pdf").mkdir()
    (tmp_path / "solution.json").write_text("old")
    answer = program("solve", ONE_TARGET, "-o", tmp_path)
    assert answer.returncode == 2
    assert "guide.pdf is a directory" in answer.stderr
    assert answer.stdout == ""  # before the search
    assert (tmp_path / "solution.json").read_text() == "old"


def test_a_disk_that_filled_up_costs_the_files_but_not_the_words(tmp_path):
    before = (
        "from pathlib import Path\n"
        f"def full(*_): raise OSError({errno.ENOSPC}, 'No space left on device')\n"
        "Path.write_bytes = full"
    )
    answer = program("solve", ONE_TARGET, "-o", tmp_path, before=before)
    assert answer.returncode == 3
    assert "No space left on device" in answer.stderr
    assert "every target is within its tolerance" in answer.stdout
    assert names(tmp_path) == set()


def test_inspect_has_the_same_net():
    before = (
        "import synth.measurement.distances.inspection as module\n"
        "import synth.measurement\n"
        "def fail(*_, **__): raise ZeroDivisionError('by nought')\n"
        "synth.measurement.inspect = fail"
    )
    file = ONE_TARGET.parents[1] / "clark2020.yaml"
    answer = program("inspect", file, before=before)
    assert answer.returncode == 3
    assert "by nought" in answer.stderr
    assert "Traceback" not in answer.stderr
