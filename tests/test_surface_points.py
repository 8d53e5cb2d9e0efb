"""A surface given by the points of a CSV file."""

import numpy as np
import pytest

from synth.errors import InputError, TimeLimitError
from synth.task import load_task, parse_task

TASK = """synth: 1
length_unit: mm
robot: malleable-2dof
surface: {points: scan.csv, tolerance: 5}
"""


def written(tmp_path, text, task=TASK):
    (tmp_path / "scan.csv").write_bytes(text if isinstance(text, bytes) else text.encode())
    (tmp_path / "task.yaml").write_text(task)
    return tmp_path / "task.yaml"


@pytest.mark.parametrize("header", ["", "x,y,z\n", "\n X, Y ,z\n", "\ufeffx,y,z\r\n"])
def test_points_are_targets_in_metres_with_or_without_a_header(tmp_path, header):
    task = load_task(written(tmp_path, header + "500, 10,200\n\n-3e2,400.5,180\n"))
    assert np.array_equal(task.positions_in_base, [[0.5, 0.01, 0.2], [-0.3, 0.4005, 0.18]])
    assert np.array_equal(task.tolerances, [0.005, 0.005])
    assert [target.name for target in task.targets] == ["surface point 1", "surface point 2"]


def test_points_stand_behind_targets(tmp_path):
    content = TASK + "targets: [{name: pick, position: [100, 200, 300]}]\n"
    task = load_task(written(tmp_path, "500,10,200\n", content))
    assert [target.name for target in task.targets] == ["pick", "surface point 1"]
    assert np.array_equal(task.tolerances, [0.001, 0.005])


@pytest.mark.parametrize(
    ("text", "places"),
    [
        ("x,y,z\n1,2,3\n1,two,3\n4,5,nan\n", [(3, "y must be a number"), (4, "z must be a finite number")]),
        ("1,2,3\n1,2\n", [(2, "must hold three numbers")]),
        ("1;2;3\n", [(1, "must hold three numbers")]),
        ("a,b,c\n1,2,3\n", [(1, "x must be a number")]),
        ("1,2,1e9\n", [(1, "z must be a finite number")]),
        ("x\n" * 12, [(i, "must hold") for i in range(1, 11)] + [(None, "more such lines")]),
    ],
)
def test_every_mistake_is_named_with_its_file_and_line(tmp_path, text, places):
    path = written(tmp_path, text)
    with pytest.raises(InputError) as caught:
        load_task(path)
    mistakes = caught.value.mistakes
    assert [mistake.line for mistake in mistakes] == [line for line, _ in places]
    for mistake, (_, words) in zip(mistakes, places, strict=True):
        assert mistake.file == str(tmp_path / "scan.csv")
        assert words in mistake.message


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "holds no points"),
        ("x,y,z\n\n", "holds no points"),
        (b"\xff\xfe1,2,3", "UTF-8"),
        (None, "no such"),
    ],
)
def test_a_file_that_is_wrong_as_a_whole_is_told_with_the_key_and_line_of_the_task(tmp_path, text, words):
    path = written(tmp_path, text or "")
    if text is None:
        (tmp_path / "scan.csv").unlink()
    with pytest.raises(InputError) as caught:
        load_task(path)
    (mistake,) = caught.value.mistakes
    assert (mistake.file, mistake.line, mistake.key) == (str(path), 4, "surface.points")
    assert words in mistake.message
    assert "scan.csv" in mistake.message


@pytest.mark.parametrize("cell", ["1_000", "\u0661\u0662", "0x10", "1e", "--1", "infinity"])
def test_what_is_no_plain_number_is_named_with_its_cell(tmp_path, cell):
    with pytest.raises(InputError) as caught:
        load_task(written(tmp_path, f"500,10,200\n500,{cell},200\n"))
    (mistake,) = caught.value.mistakes
    assert mistake.line == 2
    assert "y must be a" in mistake.message
    assert repr(cell) in mistake.message


def test_what_is_no_table_is_never_quoted(tmp_path):
    (tmp_path / "shadow").write_text("root:SECRET:1\nSECRET,SECRET,SECRET\n")
    path = written(tmp_path, "", TASK.replace("scan.csv", "shadow"))
    with pytest.raises(InputError) as caught:
        load_task(path)
    assert [mistake.line for mistake in caught.value.mistakes] == [1, 2]
    assert "SECRET" not in str(caught.value)
    (tmp_path / "robot.yaml").write_text("root:SECRET:1")
    path.write_text(TASK.replace("malleable-2dof", "robot.yaml"))
    with pytest.raises(InputError) as caught:
        load_task(path)
    assert "SECRET" not in str(caught.value)


def test_a_missing_file_is_named_beside_other_mistakes(tmp_path):
    (tmp_path / "task.yaml").write_text(TASK.replace("5}", "0}"))
    with pytest.raises(InputError) as caught:
        load_task(tmp_path / "task.yaml")
    assert "scan.csv: there is no such file" in str(caught.value)
    assert "surface.tolerance" in str(caught.value)


def test_without_surface_or_targets_the_targets_are_missing():
    with pytest.raises(InputError, match="targets: is missing"):
        parse_task(TASK.replace("surface: {points: scan.csv, tolerance: 5}\n", ""))


@pytest.mark.parametrize("answers", [1, 2, 3])
def test_reading_ends_at_the_next_step_when_its_time_is_up(tmp_path, answers):
    asked = []

    def is_up():
        asked.append(1)
        return len(asked) == answers

    with pytest.raises(TimeLimitError, match="nothing was searched for"):
        load_task(written(tmp_path, "500,10,200\n"), is_up=is_up)
    assert len(asked) == answers


def test_of_thousands_of_targets_in_yaml_not_all_are_read_when_the_time_is_up(tmp_path):
    rows = "".join(f"  - {{position: [500, {i / 100}, 200]}}\n" for i in range(1000))
    (tmp_path / "task.yaml").write_text("length_unit: mm\nrobot: malleable-2dof\ntargets:\n" + rows)
    asked = []
    with pytest.raises(TimeLimitError, match="much faster from a table"):
        load_task(tmp_path / "task.yaml", is_up=lambda: asked.append(1) or len(asked) == 3)
    assert len(asked) == 3
