"""The sheet: one page with what the operator needs, whatever the task is called or what became of it."""

import io
import math
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from pypdf import PdfReader
from sheets import GUIDE, NOTHING, ROBOT, SOLUTION, make_solution

from synth.export import draw_sheet, markers_csv
from synth.export.sheet import typesetting
from synth.export.sheet.missed_page import fill_missed
from synth.export.sheet.obstacle_outlines import clipped, solid_outline
from synth.export.sheet.page import HEIGHT, WIDTH, Page
from synth.geometry import Box, Capsule
from synth.guide import make_guide
from synth.robot import Interval, JointLimits, MalleableLink, RigidLink, RigidLinkChoices
from synth.synthesis import Design, Status, verify
from synth.synthesis.wanted.ways import Motion
from synth.task import Obstacle


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
    catalogue = RigidLinkChoices(["short", "long"], [RigidLink(0.41, 0.415), ROBOT.rigid_link])
    told = words_of(make_solution(robot=replace(ROBOT, rigid_links=catalogue)))
    assert "1 Of the rigid links take long: d35 = 455.0 mm and d45 = 460.0 mm" in told


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
