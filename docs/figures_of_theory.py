"""The pictures of the pages on theory: the five points, the four categories, cognates, the boxes of the bound."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from colours import BLUE, GREY, INK, ORANGE
from figure_of_revolution import seen, turned
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from synth.geometry import Invariants, SweptCircle, cognate

if TYPE_CHECKING:
    from matplotlib.axes import Axes


D12 = 0.5  # m: the baseline on axis 1 of theory.md
FOCUS = np.linspace(0.0, 2.0 * np.pi, 241)  # angles about axis 2
FIRST = 1.5  # rad: joint 1 of the circle that is drawn boldly
CATEGORIES = {  # the circles of theory.md
    "general": (Invariants(0.2, 1.1, 0.15, 0.3, 0.45).circle(), "a quartic"),
    "spherical": (SweptCircle([0.18, 0.0, 0.24], [0.6, 0.0, 0.8], 0.45), "a sphere about P1"),
    "PUMA-like": (SweptCircle([0.18, 0.0, 0.74], [0.6, 0.0, 0.8], 0.45), "a sphere about P2"),
    "SCARA": (SweptCircle([0.3, 0.1, 0.35], [0.0, 0.0, 1.0], 0.45), "a plane"),
}
# Between which points, how the line is drawn and where along it its name stands.
DISTANCES = {
    "d12": (0, 1, "hardware", 0.5),
    "d34": (2, 3, "hardware", 0.5),
    "d35": (2, 4, "hardware", 0.62),
    "d45": (3, 4, "hardware", 0.5),
    "d13": (0, 2, "link", 0.55),
    "d14": (0, 3, "link", 0.6),
    "d23": (1, 2, "link", 0.45),
    "d24": (1, 3, "link", 0.5),
    "d15": (0, 4, "target", 0.5),
    "d25": (1, 4, "target", 0.58),
}
STYLES = {
    "hardware": (BLUE, "-", 2.2, "fixed: two joints and the rigid link"),
    "link": (ORANGE, "--", 1.8, "changed by bending the malleable link"),
    "target": (INK, ":", 1.6, "given by where P5 is"),
}


def five_points_picture() -> Figure:
    """Draw P1 to P5 with their ten distances: which the hardware, the link and the target fix."""
    p1, p2 = np.zeros(3), np.array([0.0, 0.0, D12])
    points = seen([p1, p2, [0.0, 0.38, 0.94], [0.05, 0.70, 0.72], [0.12, 0.86, 0.10]])
    figure = Figure(figsize=(5.6, 6.6))
    FigureCanvasAgg(figure)
    axes = bare(figure, (0.02, 0.02, 0.96, 0.96))
    labelled = set()
    for name, (start, end, kind, share) in DISTANCES.items():
        colour, line, width, words = STYLES[kind]
        label = None if kind in labelled else words
        labelled.add(kind)
        ends = points[[start, end]]
        axes.plot(*ends.T, color=colour, linestyle=line, linewidth=width, label=label)
        place, paper = (
            ends[0] + share * (ends[1] - ends[0]),
            {"facecolor": "white", "edgecolor": "none", "pad": 1.0},
        )
        axes.text(*place, name, color=colour, fontsize=10, ha="center", va="center", bbox=paper)
    for (start, end), words in (((0, 1), "axis 1"), ((2, 3), "axis 2")):
        along = points[end] - points[start]
        line = np.array([points[start] - 0.35 * along, points[end] + 0.5 * along])
        axes.plot(*line.T, color=GREY, linestyle="-.", linewidth=1.0, zorder=0)
        axes.annotate(words, line[1], (5, -2), textcoords="offset points", color=INK, fontsize=10)
    for number, point in enumerate(points, 1):
        axes.plot(*point, "o", color=INK, markersize=7, zorder=5)
        shift = {1: (-21, -4), 2: (-21, -4), 3: (8, 3), 4: (8, 3), 5: (9, -4)}[number]
        axes.annotate(f"P{number}", point, shift, textcoords="offset points", weight="bold", fontsize=11)
    axes.set(xlim=(-0.2, 1.0), ylim=(-0.47, 1.04))
    axes.legend(loc="lower left", fontsize=9.5, framealpha=1.0)
    return figure


def categories_picture() -> Figure:
    """Draw the workspace of an arm of each category, swept, and its section in the half-plane of axis 1."""
    figure = Figure(figsize=(10.5, 6.2))
    FigureCanvasAgg(figure)
    for column, (name, (circle, words)) in enumerate(CATEGORIES.items()):
        left = 0.015 + 0.247 * column
        above = bare(figure, (left, 0.51, 0.235, 0.41))
        figure.text(left + 0.1175, 0.945, f"{name}: {words}", fontsize=11, color=INK, ha="center")
        draw_swept(above, circle, 36)
        draw_axis_2(above, circle)
        draw_axis_1(above)
        above.set(xlim=(-0.84, 0.84), ylim=(-0.42, 1.24))
        below = figure.add_axes((left + 0.05, 0.085, 0.18, 0.41))
        draw_section(below, circle)
        below.set(xlim=(-60, 860), ylim=(-260, 1160), xlabel="distance from axis 1, ρ, mm")
        below.set_ylabel("height, z, mm" if column == 0 else "", labelpad=0)
    return figure


def cognates_picture() -> Figure:
    """Draw two arms that have one workspace, and that workspace."""
    one = Invariants(a=0.20, alpha=0.6, z0=0.15, h=0.10, R=0.4545)
    figure = Figure(figsize=(8.4, 4.6))
    FigureCanvasAgg(figure)
    axes = bare(figure, (0.01, 0.02, 0.52, 0.96))
    section = figure.add_axes((0.6, 0.11, 0.38, 0.85))
    draw_swept(axes, one.circle(), 48, own=False)
    draw_axis_1(axes)
    for index, (arm, colour, line, marker) in enumerate(
        ((one, BLUE, "-", "o"), (cognate(one), ORANGE, "--", "^"))
    ):
        circle = arm.circle()
        name = ("an arm", "its cognate")[index]
        axes.plot(*seen(turn_of(circle, index)).T, color=colour, linestyle=line, linewidth=2.2, label=name)
        draw_axis_2(axes, circle, colour, index)
        points = circle.points(np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False) + 0.13 * index)
        rho, z = np.hypot(points[:, 0], points[:, 1]), points[:, 2]
        label = f"{name}: a = {1e3 * arm.a:.0f} mm, R = {1e3 * arm.R:.0f} mm"
        section.plot(1e3 * rho, 1e3 * z, marker, color=colour, markersize=6, linestyle="none", label=label)
    curve = one.circle().points(FOCUS)
    section.plot(
        1e3 * np.hypot(curve[:, 0], curve[:, 1]), 1e3 * curve[:, 2], color=INK, linewidth=1.0, zorder=0
    )
    section.axvline(0.0, color=GREY, linestyle="-.", linewidth=1.0)
    section.set(
        xlim=(-40, 860), ylim=(-260, 760), xlabel="distance from axis 1, ρ, mm", ylabel="height, z, mm"
    )
    section.set_aspect("equal")
    section.legend(loc="upper right", fontsize=9, framealpha=1.0)
    axes.set(xlim=(-0.85, 0.85), ylim=(-0.5, 1.24))
    axes.legend(loc="lower left", fontsize=9.5, framealpha=1.0)
    return figure


def bare(figure: Figure, where: tuple[float, float, float, float]) -> Axes:
    """Return axes without a frame and with equal scales."""
    axes = figure.add_axes(where)
    axes.set_axis_off()
    axes.set_aspect("equal")
    return axes


def turn_of(circle: SweptCircle, index: int) -> np.ndarray:
    """Return the circle of P5, turned about axis 1 so that two of them are seen apart."""
    return turned(circle.points(FOCUS), FIRST - 3.5 * index)


def draw_swept(axes: Axes, circle: SweptCircle, count: int, *, own: bool = True) -> None:
    """Draw a circle at angles of joint 1, faintly, and where it is at zero."""
    points = circle.points(FOCUS)
    for theta1 in np.linspace(0.0, 2.0 * np.pi, count, endpoint=False):
        axes.plot(*seen(turned(points, theta1)).T, color=BLUE, linewidth=0.5, alpha=0.45)
    if own:
        axes.plot(*seen(turned(points, FIRST)).T, color=BLUE, linewidth=2.2, zorder=3)


def draw_axis_1(axes: Axes) -> None:
    """Draw axis 1 with P1 and P2."""
    line = seen([[0.0, 0.0, -0.3], [0.0, 0.0, 1.25]])
    axes.plot(*line.T, color=INK, linestyle="-.", linewidth=1.0, zorder=4)
    axes.annotate("axis 1", line[1], (4, -4), textcoords="offset points", fontsize=9, color=INK)
    for name, height in (("P1", 0.0), ("P2", D12)):
        point = seen([[0.0, 0.0, height]])[0]
        axes.plot(*point, "o", color=INK, markersize=4, zorder=5)
        axes.annotate(name, point, (-17, -3), textcoords="offset points", fontsize=9, color=INK, zorder=6)


def draw_axis_2(axes: Axes, circle: SweptCircle, colour: str = ORANGE, index: int | None = None) -> None:
    """Draw axis 2 through the middle of the circle."""
    ends = circle.centre + np.array([[-0.3], [0.62 if index is None else 0.4]]) * circle.axis
    line = seen(turned(ends, FIRST if index is None else FIRST - 3.5 * index))
    axes.plot(*line.T, color=colour, linestyle="-.", linewidth=1.6, zorder=4)
    axes.annotate("axis 2", line[1], (3, 3), textcoords="offset points", fontsize=9, color=colour, zorder=6)


def draw_section(axes: Axes, circle: SweptCircle) -> None:
    """Draw where the workspace cuts the half-plane of axis 1, in mm."""
    points = 1e3 * circle.points(FOCUS)
    axes.plot(np.hypot(points[:, 0], points[:, 1]), points[:, 2], color=BLUE, linewidth=2.2)
    axes.axvline(0.0, color=INK, linestyle="-.", linewidth=1.0)
    axes.plot([0, 0], [0, 1e3 * D12], "o", color=INK, markersize=4, zorder=5)
    for name, height in (("P1", 0.0), ("P2", 1e3 * D12)):
        axes.annotate(name, (0, height), (5, -4), textcoords="offset points", fontsize=9, color=INK)
    axes.set_aspect("equal")
    axes.grid(color="#e8e8e8", linewidth=0.5)
    axes.set_axisbelow(True)
