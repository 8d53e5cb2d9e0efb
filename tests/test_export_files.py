"""The files: what they hold, and that there is never half of one."""

import csv
import io
import json
import math
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from pypdf import PdfReader

from synth.errors import SynthError
from synth.export import draw_sheet, markers_csv, prepare_directory, write_files
from synth.export.sheet import typesetting
from synth.export.sheet.missed_page import fill_missed
from synth.export.sheet.obstacle_outlines import clipped, solid_outline
from synth.export.sheet.page import HEIGHT, WIDTH, Page
from synth.geometry import Box, Capsule
from synth.guide import make_guide
from synth.robot import PRESETS, Arm, BasePose, Interval, JointLimits, LinkShape, MalleableLink
from synth.synthesis import Design, Solution, Status, Timing, verify
from synth.synthesis.wanted.ways import Motion
from synth.task import Obstacle, PointTarget, Task

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


def words_of(solution):
    """The text of a sheet with its lines joined: a name may be wrapped anywhere."""
    return " ".join(text_of(solution).split())


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
    for words in ("two crates", "Set joint 1 to 180.0 deg and hold it there", "Found", "target 2", "END"):
        assert words in text
    told = " ".join(text.split())
    s = 1e3 * np.sqrt(SOLUTION.robot.squared_distances)
    assert f"d13 {s[0, 2]:.1f}, d14 {s[0, 3]:.1f}, d23 {s[1, 2]:.1f}, d24 {s[1, 3]:.1f} mm" in told
    for words in (
        "horizontal, heading",
        "P1 at (100.0, -200.0, 50.0) mm, turned by 40.1 deg",
        "No hand holds this",
    ):
        assert words in told
    assert "target 0 to target 1: joint 1 by" in told
    assert "Cut the rigid link" not in told


def test_a_rigid_link_that_was_chosen_is_cut_first():
    robot = replace(ROBOT, rigid_link=replace(ROBOT.rigid_link, d35=Interval(0.3, 0.5)))
    told = words_of(make_solution(robot=robot))
    assert "1 Cut the rigid link to d35 = 455.0 mm and d45 = 460.0 mm" in told


def test_obstacles_are_drawn_and_named_with_the_clearance_at_each_target():
    obstacles = (
        Obstacle("the cabinet", Box([1.1, -0.2, 0.3], [0.2, 0.5, 0.6], 0.4)),
        Obstacle("the pipe", Capsule([[-0.5, 0.5, 0.0], [-0.5, 0.5, 1.0]], 0.03)),
        Obstacle("the door", Box([-3.0, 0.0, 1.0], [0.1, 1.0, 2.0])),
    )
    task = replace(SOLUTION.task, obstacles=obstacles)
    design = Design(SOLUTION.robot, verify(task, SOLUTION.robot))
    assert design.verification.found
    text = text_of(replace(SOLUTION, task=task, designs=(design,)))
    assert text.count("the cabinet") == text.count("the pipe") == 3  # in each view
    # What no view shows has no label there: the legend says that there is more.
    assert text.count("the door") == 1
    assert "Too far off to be drawn: the door." in " ".join(text.split())
    assert "clear, mm" in text
    assert "obstacles" in text


@pytest.mark.parametrize("view", [(0, 1), (0, 2), (1, 2)])
@pytest.mark.parametrize(
    "solid", [Box([0.3, 0.1, 0.2], [0.1, 0.4, 0.2], 0.4), Capsule([[0.0, 0.1, 0.2], [0.3, 0.4, 0.9]], 0.05)]
)
def test_the_outline_of_an_obstacle_is_what_a_view_shows_of_it(solid, view):
    outline = solid_outline(solid, view)
    for angle in np.linspace(0.0, 2.0 * math.pi, 36, endpoint=False):
        direction = np.zeros(3)
        direction[list(view)] = math.cos(angle), math.sin(angle)
        farthest = (outline @ direction[list(view)]).max()
        assert farthest == pytest.approx(solid.support(direction), abs=1e-9)


def test_of_an_obstacle_a_view_shows_the_part_in_its_frame():
    """A square on its tip, of half diagonal 1: in a frame that cuts off a corner 7/8 of it are left."""
    square = np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])

    def area(corners):
        following = np.roll(corners, -1, axis=0)
        return 0.5 * abs(np.sum(corners[:, 0] * following[:, 1] - corners[:, 1] * following[:, 0]))

    assert area(clipped(square, np.array([[-2.0, 0.5], [-2.0, 2.0]]))) == pytest.approx(1.75)
    assert area(clipped(square, np.array([[-0.5, 0.5], [-0.5, 0.5]]))) == pytest.approx(1.0)
    assert len(clipped(square, np.array([[0.8, 2.0], [0.8, 2.0]]))) == 0  # beside it, though its box is not


def test_a_shape_that_misses_says_so_in_large_letters_and_gives_no_instructions():
    missed = make_solution(offset=0.4)
    impossible = replace(missed, status=Status.PROVEN_IMPOSSIBLE, reasons=("it is out of reach",))
    for solution, word in ((missed, "NOT FOUND: no shape was found"), (impossible, "IMPOSSIBLE: no shape")):
        text = text_of(solution)
        assert word in text
        assert "NO " in text
        for words in (
            "Found:",
            "Set joint 1",
            "Hold axis 2",
            "What to do",
            "Points with",
            "P3",
            "END",
            "joints 1, 2",
        ):
            assert words not in text
        assert markers_csv(make_guide(solution.task, solution.best)) == markers_csv(None)
    assert "it is out of reach" in text


def test_the_banner_is_no_wider_than_its_band():
    """White on white is read by nobody: what is drawn of each banner lies on black."""
    for status in set(Status) - {Status.FOUND}:
        figure = Figure(figsize=(WIDTH / 25.4, HEIGHT / 25.4))
        fill_missed(Page(figure), replace(make_solution(offset=0.4), status=status))
        renderer = FigureCanvasAgg(figure).get_renderer()
        (band,) = figure.artists
        (banner,) = [text for text in figure.texts if text.get_color() == "white"]
        box, inside = band.get_window_extent(renderer), banner.get_window_extent(renderer)
        assert box.x0 <= inside.x0
        assert inside.x1 <= box.x1
        assert box.y0 <= inside.y0 <= inside.y1 <= box.y1


def test_long_and_many_reasons_push_the_table_down():
    long = "because the link would have to bend more sharply than it can where the shelf is " * 12
    reasons = tuple(f"{i}: {long}" for i in range(30))
    solution = replace(make_solution(offset=0.4, count=20), status=Status.PROVEN_IMPOSSIBLE, reasons=reasons)
    figure = Figure(figsize=(WIDTH / 25.4, HEIGHT / 25.4))
    bottom = fill_missed(Page(figure), solution)
    renderer = FigureCanvasAgg(figure).get_renderer()
    boxes = [text.get_window_extent(renderer) for text in figure.texts]
    for index, one in enumerate(boxes):
        assert one.x0 > 0.0
        assert one.x1 < figure.bbox.x1
        assert not any(one.shrunk(0.9, 0.6).overlaps(other.shrunk(0.9, 0.6)) for other in boxes[:index])
    assert bottom < 180.0
    assert "and 25 more of this kind" in [text.get_text() for text in figure.texts]


def test_names_of_one_long_word_can_be_read_on_the_sheet():
    solution = make_solution(name="Werkstueckaufnahmevorrichtungspositionierung_Halle_7_Nord")
    targets = tuple(
        replace(t, name=f"Schraubenlochmittelpunkt_oben_{i}") for i, t in enumerate(solution.task.targets)
    )
    task = replace(solution.task, targets=targets)
    text = text_of(replace(solution, task=task))
    assert "Werkstueckaufnahmevorrich...itionierung_Halle_7_Nord" in text
    for index in range(3):
        assert f"Schraubenl...kt_oben_{index}" in text


def test_a_name_in_any_script_prints_no_boxes(monkeypatch):
    """A sign that no font has is spelled, in every place of the sheet, and no library warns of it."""
    monkeypatch.setattr(typesetting, "_others", list)
    typesetting._family.cache_clear()
    typesetting._drawable.cache_clear()
    solution = make_solution(name="机器人 \N{ROBOT FACE}")
    targets = tuple(replace(t, name=f"箱 {i}") for i, t in enumerate(solution.task.targets))
    wall = Obstacle("墙", Box([0.9, -0.2, 0.3], [0.2, 0.5, 0.6]))
    task = replace(solution.task, targets=targets, obstacles=(wall,))
    text = words_of(
        replace(solution, task=task, designs=(Design(solution.robot, verify(task, solution.robot)),))
    )
    assert r"\u673a\u5668\u4eba [robot face]" in text
    assert r"\u7bb1 0" in text
    assert text.count(r"\u5899") == 3
    typesetting._family.cache_clear()
    typesetting._drawable.cache_clear()


def test_the_sheet_of_a_task_that_was_explained_does_not_send_the_user_there_again():
    missed = make_solution(offset=0.4)
    advice = "solving with --why looks for one limit"
    assert advice in words_of(missed)
    note = "neither one limit relaxed alone nor another place of the base was found that would do"
    told = words_of(replace(missed, explained=True, notes=(note,)))
    assert advice not in told
    assert note in told


def test_the_sheet_of_a_task_without_a_way_says_so_first():
    ways = (Motion("t0", "t1", np.zeros((0, 2))), Motion("t1", "t2", np.zeros((2, 2))))
    text = words_of(replace(SOLUTION, designs=(replace(SOLUTION.best, ways=ways),)))
    assert "Found: every target is reached, but no way was found from t0 to t1." in text


def test_to_draw_a_sheet_loads_no_more_than_it_takes():
    """To cut fonts to size, which no sheet does, takes a library that is as slow to load as all others."""
    told = (
        "import sys, test_export_files as t; t.draw_sheet(t.SOLUTION, t.GUIDE); "
        "print([name for name in ('fontTools.varLib', 'matplotlib.pyplot') if name in sys.modules])"
    )
    answer = subprocess.run(
        [sys.executable, "-c", told], capture_output=True, text=True, check=True, cwd=Path(__file__).parent
    )
    assert answer.stdout == "[]\n"


def test_a_solution_without_a_shape_has_a_sheet_and_no_points():
    text = text_of(NOTHING)
    for words in ("NOT FOUND", "ran out of luck", "There is no shape", "no shape"):
        assert words in text
    assert "Set joint 1" not in text


@pytest.mark.parametrize(
    "solution",
    [
        pytest.param(make_solution(count=40, offset=0.01), id="many targets"),
        pytest.param(make_solution(name="$x_ 机器人 " * 9, floor=None), id="a name of any kind"),
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
