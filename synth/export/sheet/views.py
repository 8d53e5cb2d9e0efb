"""The drawings of the sheet: three views of the robot and the section of its workspace surface."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from synth.export.sheet.labels import Labels
from synth.export.sheet.obstacle_outlines import draw_obstacle
from synth.guide import MARKERS

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from synth.arrays import FloatArray
    from synth.export.sheet.scene import Scene
    from synth.robot import BasePose
    from synth.synthesis import Design

# Colours of Okabe and Ito, told apart with any colour vision; line styles tell them apart in grey.
LINK = "#0072B2"
AXIS = "#B85000"
TARGET = "#000000"
GHOST = "#8C8C8C"
# Which coordinates a view shows to the right and upwards: a third-angle projection.
TOP = (0, 1)
FRONT = (0, 2)
SIDE = (1, 2)
_POINTS_PER_MM = 72.0 / 25.4
_MOST_NAMED = 30  # obstacles: names of more would hide the drawing, and take seconds to place
_AXIS_LENGTH = 9.0  # mm of paper to either side of the markers, drawn of an axis


def draw_view(axes: Axes, scene: Scene, view: tuple[int, int], scale: float) -> None:
    """Draw one orthographic view at a scale of 1 : `scale`; the axes' limits must be set."""
    labels, pick = Labels(axes, scale), list(view)
    tube = scene.diameter / scale * _POINTS_PER_MM
    if scene.floor is not None and view != TOP:
        _draw_floor(axes, scene.floor)
    few = len(scene.obstacles) <= _MOST_NAMED
    for name, solid in scene.obstacles:
        draw_obstacle(axes, name if few else "", solid, view, labels)
    for line, width in ((scene.ghost, tube), (scene.rigid, 0.5 * tube)):
        axes.plot(*line[:, pick].T, color="#E4E4E4", linewidth=width, solid_capstyle="butt", zorder=1)
        axes.plot(*line[:, pick].T, color=GHOST, linewidth=0.8, linestyle="--", zorder=1)
        labels.avoid_line(line[:, pick])
    if len(scene.rigid):
        p5 = scene.rigid[1, pick]
        axes.plot(*p5, marker="s", color=GHOST, markersize=4.5, zorder=2)
        labels.add("P5", p5)
    # A dark stroke below a light one: the outline of the tube, on paper as wide as the link.
    for colour, width in ((LINK, tube + 1.0), ("#CFE3F1", tube)):
        axes.plot(*scene.link[:, pick].T, color=colour, linewidth=width, solid_capstyle="butt", zorder=3)
    axes.plot(*scene.link[:, pick].T, color=LINK, linewidth=0.7, zorder=4)
    labels.avoid_line(scene.link[:, pick])
    _draw_axis(axes, scene.base, pick, labels)
    if scene.hold is not None:
        markers = 1e3 * scene.hold.markers[:, pick]
        _draw_axis(axes, 1e3 * scene.hold.markers[2:], pick, labels)
        axes.plot(*markers.T, "o", color=AXIS, markerfacecolor="white", markersize=3.4, zorder=6)
        for name, marker in zip(MARKERS, markers, strict=True):
            labels.add(name, marker)
    _draw_targets(axes, scene.targets[:, pick], scene, labels)
    labels.place()


def draw_section(axes: Axes, scene: Scene, design: Design, scale: float) -> None:
    """Draw the section of the workspace surface: where P5 gets, as (rho, z) about axis 1.

    Joint 2 runs through its limits along the solid curve, and could not through the dashed rest.
    """
    labels, arm = Labels(axes, scale), design.arm
    limits = arm.robot.joint_limits.second
    whole = section(design, np.linspace(0.0, 2.0 * math.pi, 721))
    within = section(design, np.linspace(limits.lower, limits.upper, 721))
    if scene.floor is not None and arm.base.is_upright:
        _draw_floor(axes, scene.floor)
    axes.plot(*whole.T, color=LINK, linewidth=0.8, linestyle="--", zorder=3)
    axes.plot(*within.T, color=LINK, linewidth=1.8, zorder=4)
    labels.avoid_line(whole[::8])
    axes.axvline(0.0, color=AXIS, linewidth=0.8, linestyle="-.", zorder=2)
    if limits.upper - limits.lower < 2.0 * math.pi - 1e-9:
        for angle, end in ((limits.lower, within[0]), (limits.upper, within[-1])):
            axes.plot(*end, "|", color=LINK, markersize=7.0, markeredgewidth=1.4, zorder=5)
            labels.add(f"{math.degrees(angle):.0f}°", end)
    _draw_targets(axes, about_axis_1(arm.base, scene.targets / 1e3), scene, labels)
    labels.place()


def section(design: Design, theta2: FloatArray) -> FloatArray:
    """Return P5 as `about_axis_1` does, shape (k, 2), mm."""
    return about_axis_1(design.arm.base, design.arm.forward_kinematics(0.0, theta2))


def about_axis_1(base: BasePose, points: FloatArray) -> FloatArray:
    """Return points of the task frame, (k, 3), m, as distance from axis 1 and height, shape (k, 2), mm.

    The height is z of the task frame; where the base leans it is that along axis 1, from P1.
    """
    seen = base.to_base(points)
    lift = base.position[2] if base.is_upright else 0.0
    return 1e3 * np.column_stack([np.hypot(seen[:, 0], seen[:, 1]), seen[:, 2] + lift])


def _draw_floor(axes: Axes, height: float) -> None:
    bottom = axes.get_ylim()[0]
    axes.axhspan(
        bottom, height, facecolor="none", edgecolor="#C4C4C4", hatch="/////", linewidth=0.0, zorder=0
    )
    axes.axhline(height, color="black", linewidth=1.0, zorder=2)


def _draw_axis(axes: Axes, points: FloatArray, pick: list[int], labels: Labels) -> None:
    """Draw the axis of a joint through two points, shape (2, 3), and some way beyond them."""
    beyond = _AXIS_LENGTH * labels.scale / np.linalg.norm(points[1] - points[0]) * (points[1] - points[0])
    line = np.stack([points[0] - beyond, points[1] + beyond])[:, pick]
    axes.plot(*line.T, color=AXIS, linewidth=1.1, linestyle="-.", zorder=5)
    labels.avoid_line(line)


def _draw_targets(axes: Axes, points: FloatArray, scene: Scene, labels: Labels) -> None:
    """Draw the targets: a filled circle where one is reached, a cross where it is missed."""
    drawn, reached = scene.drawn, np.array(scene.reached, dtype=bool)
    for path in range(int(scene.path_of.max(initial=-1)) + 1):
        axes.plot(*points[scene.path_of == path].T, color=TARGET, linewidth=1.6, zorder=7)
    for some, marker, size in ((drawn & reached, "o", 4.5), (drawn & ~reached, "X", 6.0)):
        axes.plot(
            *points[some].T,
            linestyle="none",
            marker=marker,
            color=TARGET,
            markersize=size,
            markeredgecolor="white",
            markeredgewidth=0.6,
            zorder=8,
        )
    for index in np.flatnonzero(drawn).tolist():
        if scene.labels[index]:
            labels.add(scene.labels[index], points[index])
        else:
            labels.avoid_mark(points[index])
