"""`synth new`: a first task that solves as it is; the version; completion in a shell."""

import json
import os
import re

import pytest
from command import invoked, program

import synth
from synth.cli.new import FIRST_TASK


@pytest.mark.parametrize(("name", "file"), [((), "task.yaml"), (("a.b",), "a.b.yaml"), (("x.yml",), "x.yml")])
def test_the_first_task_solves_as_it_is(name, file, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    answer = invoked("new", *name)
    assert answer.exit_code == 0
    assert answer.output == f"wrote {file}; it solves as it is: synth solve {file} -o out\n"
    assert [path.name for path in tmp_path.iterdir()] == [file]
    solution = synth.solve(synth.load_task(file), alternatives=0)
    assert solution.found
    assert (solution.task.tolerances == 5e-3).all()


def test_what_the_first_task_leaves_to_choose_can_be_taken_as_it_stands(tmp_path):
    chosen = re.sub(
        r"^# (?=(name|base|floor|topology|objective|obstacles|  - \{)\b)", "", FIRST_TASK, flags=re.MULTILINE
    )
    chosen = re.sub(r"^#(?=   - \{)", "", chosen, flags=re.MULTILINE)
    (tmp_path / "task.yaml").write_text(chosen)
    task = synth.load_task(tmp_path / "task.yaml")
    assert [obstacle.name for obstacle in task.obstacles] == ["column", "shelf", "lamp"]
    assert task.name == "two crates"
    assert chosen.count("\n#") == FIRST_TASK.count("\n#") - 9


def test_every_key_of_a_task_but_the_rarest_is_in_the_first_one():
    keys = set(re.findall(r"^(?:# )?(\w+):", FIRST_TASK, flags=re.MULTILINE))
    assert keys == set(synth.task.task_schema()["properties"]) - {"surface", "path", "current"}


def test_the_first_line_names_the_schema_that_the_second_one_says_how_to_make():
    first, second = FIRST_TASK.splitlines()[:2]
    file = re.fullmatch(r"# yaml-language-server: \$schema=(\S+)", first).group(1)
    command = re.search(r"`synth (.+) > (\S+)`", second)
    assert command.group(2) == file
    assert json.loads(invoked(*command.group(1).split()).output) == synth.task.task_schema()


def test_what_is_there_already_is_left_as_it_was(tmp_path):
    file = tmp_path / "mine.yaml"
    file.write_text("mine\n")
    answer = program("new", tmp_path / "mine")
    assert (answer.returncode, answer.stdout) == (2, "")
    assert "is there already and was left as it was" in answer.stderr
    assert file.read_text() == "mine\n"


@pytest.mark.parametrize("name", ["no/such/folder/task", "x" * 300, "a\nb/c"])
def test_a_task_that_cannot_be_written_is_told_in_a_sentence(name, tmp_path):
    answer = program("new", name, cwd=tmp_path)
    assert answer.returncode == 2
    assert answer.stderr.startswith("cannot write ")
    assert "Traceback" not in answer.stderr


def test_the_name_of_a_file_is_quoted_as_a_shell_asks_for_it(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert invoked("new", "two crates").output.endswith("synth solve 'two crates.yaml' -o out\n")


def test_the_version_has_a_short_option():
    assert invoked("-V").output == invoked("--version").output == f"synth, version {synth.__version__}\n"


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_a_shell_is_told_how_to_complete(shell):
    answer = program(env={**os.environ, "_SYNTH_COMPLETE": f"{shell}_source"})
    assert answer.returncode == 0
    assert f"_SYNTH_COMPLETE={shell}_complete" in answer.stdout
