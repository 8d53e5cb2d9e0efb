"""What the pictures show: names, where they stand, and that nothing covers them or is cut off."""

import importlib
import itertools
from pathlib import Path

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.proj3d import proj_transform

from synth import load_task, solve
from synth.export import draw_robot
from synth.export.sheet.robot_drawing import RobotDrawing

DOCS = Path(__file__).parents[1] / "docs"
POINTS = {"P1", "P2", "P3", "P4", "P5"}


@pytest.fixture
def figures(monkeypatch):
    monkeypatch.syspath_prepend(str(DOCS))
    return importlib.import_module("figures")


@pytest.fixture
def revolution(monkeypatch):
    monkeypatch.syspath_prepend(str(DOCS))
    return importlib.import_module("figure_of_revolution")


def small_picture():
    """The drawing as it stands in the corner of the sheet."""
    figure = Figure(figsize=(30 / 25.4, 30 / 25.4), dpi=300)
    FigureCanvasAgg(figure)
    draw_robot(figure.add_axes((0, 0, 1, 1)), 5.0, whole=False)
    return figure


def texts(figure):
    """Each text of a figure with its box in pixels, and the axes that it belongs to."""
    figure.draw_without_rendering()
    shown = [*figure.texts, *itertools.chain(*(axes.texts for axes in figure.axes))]
    return {text.get_text(): text.get_window_extent() for text in shown if text.get_text()}


def covering(figure):
    """Pairs of texts that cover each other."""
    pairs = itertools.combinations(texts(figure).items(), 2)
    return [(one, other) for (one, box), (other, at) in pairs if box.overlaps(at)]


def cut_off(figure):
    """Texts that reach beyond the figure."""
    whole = figure.bbox
    return [name for name, box in texts(figure).items() if not (
        whole.x0 <= box.x0 and box.x1 <= whole.x1 and whole.y0 <= box.y0 and box.y1 <= whole.y1
    )]  # fmt: skip


def test_the_drawing_of_the_robot_names_all_that_a_task_and_a_solution_speak_of(figures):
    lengths = {"d12", "d34", "tip offset", *(f"d{i}{j}" for i in "12" for j in "34"), "d35", "d45"}
    words = {"axis 1 (z)", "axis 2", "x", "y", "θ1", "θ2", "malleable link", "rigid link"}
    zeros = {"θ2 = 0°:\nfolded back", "θ2 = 180°:\nstraight on"}
    assert set(texts(figures.robot_picture())) == POINTS | lengths | words | zeros


def test_the_corner_of_the_sheet_names_points_axes_and_angles():
    assert set(texts(small_picture())) == POINTS | {"axis 1", "axis 2", "x", "y", "θ1", "θ2"}


@pytest.mark.parametrize("name", ["robot_picture", "revolution_picture", "small"])
def test_no_name_covers_another_or_is_cut_off(figures, name):
    figure = small_picture() if name == "small" else getattr(figures, name)()
    assert not covering(figure)
    assert not cut_off(figure)


@pytest.mark.parametrize("name", ["robot_picture", "revolution_picture"])
def test_lengths_are_as_long_in_every_direction(figures, name):
    assert {axes.get_aspect() for axes in getattr(figures, name)().axes} == {1.0}


def test_a_name_that_covers_another_is_seen():
    figure = Figure()
    FigureCanvasAgg(figure)
    for x in (0.5, 0.505, 0.99):
        figure.text(x, 0.5, f"name at {x}")
    assert covering(figure) == [("name at 0.5", "name at 0.505")]
    assert cut_off(figure) == ["name at 0.99"]


def test_what_is_drawn_is_an_arm_whose_distances_are_those_it_names():
    drawing = RobotDrawing(Figure().add_subplot(), 10.0, whole=True)
    p1, p2, p3, p4 = drawing._joints
    p5 = drawing._effector(np.radians(128.0))
    robot = drawing._arm.robot
    for start, end, length in ((p1, p2, robot.d12), (p3, p4, robot.d34), (p3, p5, 0.42), (p4, p5, 0.45)):
        assert np.linalg.norm(end - start) == pytest.approx(length)
    assert np.linalg.norm(drawing._link[-1] - p3) == pytest.approx(robot.tip_offset)


def test_a_slice_of_the_workspace_is_as_wide_all_round(revolution):
    arm = revolution.bent_arm()
    theta2 = np.linspace(0.0, 2.0 * np.pi, 361)
    swept = arm.forward_kinematics(np.linspace(0.0, 6.0, 7)[:, None], theta2)
    rho = np.hypot(swept[..., 0], swept[..., 1])
    assert np.ptp(rho, axis=0).max() < 1e-12
    assert revolution.slice_radii(arm, revolution.HEIGHT).max() <= rho.max()


@pytest.mark.parametrize("name", ["two-crates", "out-of-reach", "moved-base"])
def test_the_picture_of_a_task_names_its_targets_and_holds_them(name, monkeypatch):
    monkeypatch.syspath_prepend(str(DOCS))
    made = importlib.import_module("figure_of_task")
    task = load_task(DOCS.parent / "problems" / name / "task.yaml")
    solution = solve(task, alternatives=0)
    figure = made.task_picture(solution)
    axes = figure.axes[0]
    assert {text.get_text() for text in axes.texts} == {target.name for target in task.targets}
    assert [text.get_text() for text in figure.texts] == ["squares of 200 mm"]
    x, y, _ = proj_transform(*(1e3 * task.table.positions).T, axes.get_proj())
    places = figure.transFigure.inverted().transform(axes.transData.transform(np.column_stack([x, y])))
    assert ((places > 0.04) & (places < 0.94)).all()
    missed = [line for line in axes.lines if line.get_marker() == "X"]
    assert len(missed) == sum(not target.within_tolerance for target in solution.targets)


def test_the_workspace_in_the_picture_is_where_the_arm_gets(monkeypatch):
    monkeypatch.syspath_prepend(str(DOCS))
    made = importlib.import_module("figure_of_task")
    solution = solve(load_task(DOCS.parent / "problems" / "moved-base" / "task.yaml"), alternatives=0)
    axes = Figure().add_subplot(projection="3d")
    points = made.draw_workspace(axes, solution.robot) / 1e3
    assert solution.robot.closest_joints(points[::97])[1].max() < 1e-9
