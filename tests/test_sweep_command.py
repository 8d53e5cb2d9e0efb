"""`synth solve` with several tasks and folders."""

import json
from pathlib import Path

import pytest
from command import invoked
from planted import planted_task

import synth

TASKS = [planted_task(seed, 3)[0] for seed in (5, 6, 8)]
ROOT = Path(__file__).parents[1]
QUICK = {"alternatives": 0}


@pytest.fixture
def folder(tmp_path):
    for name in ("one-target", "out-of-reach"):
        text = (ROOT / "problems" / name / "task.yaml").read_text()
        (tmp_path / "tasks" / name).mkdir(parents=True)
        (tmp_path / "tasks" / name / "task.yaml").write_text(text)
    (tmp_path / "tasks" / "robot.yaml").write_text("length_unit: mm\nd12: 58\n")
    return tmp_path / "tasks"


def test_the_command_solves_a_folder_and_resumes(folder, tmp_path):
    out = tmp_path / "out"
    result = invoked("solve", folder, "-o", out)
    assert result.exit_code == 1, result.output
    lines = result.stdout.splitlines()
    assert lines[0].split() == ["task", "status", "worst", "miss", "time"]
    assert lines[1].startswith("one-target/task.yaml")
    assert "found" in lines[1]
    assert "proven_impossible" in lines[2]
    assert lines[3] == "1 of 2 found"
    solution = synth.load_solution(out / "one-target" / "task" / "solution.json")
    assert solution.found
    assert (out / "one-target" / "task" / "guide.pdf").exists()
    written = (out / "one-target" / "task" / "guide.pdf").stat().st_mtime_ns
    again = invoked("solve", folder, "-o", out)
    assert again.stdout.count("stored") == 2
    assert (out / "one-target" / "task" / "guide.pdf").stat().st_mtime_ns == written


def test_the_command_names_what_is_wrong_and_solves_the_rest(folder, tmp_path):
    wrong = tmp_path / "wrong.yaml"
    wrong.write_text("synth: 1\nlength_unit: mm\nrobot: malleable-2dof\ntargets: []\n")
    result = invoked("solve", wrong, folder / "one-target" / "task.yaml", "--json")
    assert result.exit_code == 2
    first, second = map(json.loads, result.stdout.splitlines())
    assert first["solution"] is None
    assert "wrong.yaml:4: targets: must hold one target" in first["error"]
    assert second["solution"]["status"] == "found"
    assert synth.Solution.from_json(second["solution"]).found


def test_the_command_solves_with_processes(folder):
    result = invoked("solve", folder / "one-target" / "task.yaml", folder, "--jobs", 2)
    assert result.exit_code == 1, result.output
    assert "2 of 3 found" in result.stdout


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["--shape", 2], "are for one task"),
        (["--all"], "are for one task"),
        (["--why"], "are for one task"),
    ],
)
def test_options_for_one_task_are_refused_for_many(folder, options, told):
    result = invoked("solve", folder, *options)
    assert result.exit_code == 2
    assert told in result.output


def test_jobs_are_refused_for_one_task_and_a_folder_without_tasks_too(folder, tmp_path):
    result = invoked("solve", folder / "one-target" / "task.yaml", "--jobs", 2)
    assert result.exit_code == 2
    (tmp_path / "empty").mkdir()
    result = invoked("solve", tmp_path / "empty")
    assert result.exit_code == 2
    assert "holds no task file" in result.output
