"""The files: what they hold, and that there is never half of one."""

import csv
import io
import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pypdf import PdfReader

from synth.errors import SynthError
from synth.export import draw_sheet, markers_csv, prepare_directory, write_files
from synth.guide import make_guide
from synth.robot import PRESETS, Arm, BasePose, Interval, JointLimits, LinkShape, MalleableLink
from synth.synthesis import Design, Solution, Status, Timing, verify
from synth.task import PointTarget, Task

ROBOT = PRESETS["malleable-2dof"]
NAMES = ["solution.json", "guide.pdf", "markers.csv"]


def make_solution(name="two crates", robot=ROBOT, count=3, offset=0.0, length=0.63, floor=-1.0):
    base = BasePose([0.1, -0.2, 0.05], 0.7)
    arm = Arm(robot, LinkShape([[3.0, 1.0], [-2.0, 4.0], [1.0, 5.0]], [length / 3] * 3), 0.455, 0.460, base)
    points = arm.forward_kinematics(np.linspace(1.0, 5.0, count), np.linspace(2.0, 4.6, count))
    targets = tuple(
        PointTarget(f"target {i}", point + np.array([0.0, 0.0, offset])) for i, point in enumerate(points)
    )
    task = Task(name, robot, targets, base, floor)
    design = Design(arm, verify(task, arm))
    status = Status.FOUND if all(design.verification.within_tolerance) else Status.BEST_EFFORT
    return Solution(task, status, status.sentence, (), 7, (design,), 3, Timing(1.0, 0.25, 0.5, 0.25))


SOLUTION = make_solution()
GUIDE = make_guide(SOLUTION.task, SOLUTION.best)
NOTHING = replace(SOLUTION, status=Status.FAILED, reasons=("ran out of luck",), designs=())


def page_of(content):
    reader = PdfReader(io.BytesIO(content))
    assert len(reader.pages) == 1
    return reader.pages[0]


def text_of(solution):
    guide = make_guide(solution.task, solution.best) if solution.designs else None
    return page_of(draw_sheet(solution, guide)).extract_text()


def test_the_csv_holds_the_points_at_the_angle_to_hold():
    rows = list(csv.DictReader(io.StringIO(markers_csv(GUIDE))))
    assert list(rows[0]) == ["marker", "x_mm", "y_mm", "z_mm", "joint1_deg"]
    expected = GUIDE.points(GUIDE.hold)
    assert [row["marker"] for row in rows] == list(expected)
    for row in rows:
        point = [float(row[column]) for column in ("x_mm", "y_mm", "z_mm")]
        np.testing.assert_allclose(point, 1e3 * expected[row["marker"]], atol=1e-4)
        assert float(row["joint1_deg"]) == pytest.approx(180.0)
    assert markers_csv(None) == "marker,x_mm,y_mm,z_mm,joint1_deg\n"


def test_the_sheet_is_one_a4_page_with_what_the_operator_needs():
    page = page_of(draw_sheet(SOLUTION, GUIDE))
    assert [float(side) for side in page.mediabox[2:]] == pytest.approx([595.3, 841.9], abs=0.1)
    text = page.extract_text()
    for value in GUIDE.hold.markers[2]:
        assert f"{1e3 * value:.1f}" in text
    for words in ("two crates", "Set joint 1 to 180.0 deg and hold it there.", "Found", "target 2", "END"):
        assert words in text


def test_a_shape_that_misses_says_so_in_large_letters():
    text = text_of(make_solution(offset=0.4))
    assert "NOT FOUND" in text
    assert "NO " in text
    assert "Found:" not in text


def test_a_solution_without_a_shape_has_a_sheet_and_no_points():
    text = text_of(NOTHING)
    for words in ("NOT FOUND", "ran out of luck", "There is no shape", "no shape"):
        assert words in text
    assert "Set joint 1" not in text


@pytest.mark.parametrize(
    "solution",
    [
        pytest.param(make_solution(count=40, offset=0.01), id="many targets"),
        pytest.param(make_solution(name="$x_ 机器人\n" * 30, floor=None), id="a name of any kind"),
        pytest.param(
            make_solution(
                robot=replace(ROBOT, link=MalleableLink(Interval(1.0, 3.0), 0.1), joint_limits=JointLimits()),
                length=2.5,
                count=1,
            ),
            id="a long link without a diameter, joints without limits",
        ),
        pytest.param(replace(NOTHING, task=make_solution(count=20).task), id="no shape for many targets"),
    ],
)
def test_every_solution_fits_on_a_page(solution):
    assert solution.task.robot.name in text_of(solution)


def test_files_are_written_and_the_same_each_time(tmp_path):
    first = write_files(SOLUTION, tmp_path / "new" / "directory")
    second = write_files(SOLUTION, str(tmp_path / "other"))
    assert [path.name for path in first] == [path.name for path in second] == NAMES
    for one, other in zip(first, second, strict=True):
        assert one.read_bytes() == other.read_bytes()
    assert sorted(path.name for path in first[0].parent.iterdir()) == sorted(NAMES)
    assert json.loads(first[0].read_text(encoding="utf-8"))["guide"]["hold"]["joint1"] == pytest.approx(
        math.pi
    )
    write_files(NOTHING, tmp_path / "other")
    assert json.loads(second[0].read_text(encoding="utf-8"))["guide"] is None


@pytest.mark.parametrize("broken", ["write_bytes", "replace"])
def test_a_failure_leaves_the_old_files_and_no_others(tmp_path, monkeypatch, broken):
    old = {path: path.read_bytes() for path in write_files(NOTHING, tmp_path)}
    original = getattr(Path, broken)

    def fail(self, *args):
        if broken == "replace" or "guide.pdf" in self.name:
            raise OSError(28, "No space left on device")
        return original(self, *args)

    with monkeypatch.context() as patch:
        patch.setattr(Path, broken, fail)
        with pytest.raises(SynthError, match="No space left on device"):
            write_files(SOLUTION, tmp_path)
    assert {path: path.read_bytes() for path in tmp_path.iterdir()} == old


@pytest.mark.parametrize("write", [prepare_directory, lambda directory: write_files(SOLUTION, directory)])
def test_a_directory_that_is_a_file_is_named_in_the_error(tmp_path, write):
    (tmp_path / "taken").write_text("")
    with pytest.raises(SynthError, match=r"cannot write to .*taken"):
        write(tmp_path / "taken")


def test_a_directory_is_prepared_and_left_empty(tmp_path):
    prepare_directory(tmp_path / "a" / "b")
    prepare_directory(str(tmp_path / "a" / "b"))
    assert list((tmp_path / "a" / "b").iterdir()) == []
