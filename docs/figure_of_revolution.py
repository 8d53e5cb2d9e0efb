"""The picture that says why a workspace is round about axis 1, and what follows for a dome to be followed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from colours import BLUE, INK, ORANGE, PALE
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from synth import PRESETS, Arm, Interval, JointLimits, LinkShape, Robot

if TYPE_CHECKING:
    from matplotlib.axes import Axes

AZIMUTH, ELEVATION = np.radians(25.0), np.radians(24.0)
HEIGHT = 0.50  # m, of the slice in the right-hand drawings


def bent_arm() -> Arm:
    """Return the published robot with a link that is bent outwards, and joints that turn all round."""
    preset = PRESETS["malleable-2dof"]
    limits = JointLimits(Interval(-np.pi, np.pi), Interval(0.0, 2.0 * np.pi))
    robot = Robot("round", preset.d12, preset.link, preset.d34, preset.tip_offset, preset.rigid_link, limits)
    shape = LinkShape([[0.0, 0.4], [1.4, 3.0], [0.9, 1.0]], [0.15, 0.25, 0.2])
    return Arm(robot, shape, d35=robot.rigid_link.d35.middle, d45=robot.rigid_link.d45.middle)


def seen(points: np.ndarray) -> np.ndarray:
    """Return points as they are seen: to the right and upwards."""
    sin, cos, low, high = np.sin(AZIMUTH), np.cos(AZIMUTH), np.sin(ELEVATION), np.cos(ELEVATION)
    return np.asarray(points) @ np.array([[-sin, -low * cos], [cos, -low * sin], [0.0, high]])


def turned(points: np.ndarray, angle: float) -> np.ndarray:
    """Return points turned about axis 1."""
    cos, sin = np.cos(angle), np.sin(angle)
    return points @ np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]])


def panel(figure: Figure, index: int, title: str) -> Axes:
    """Return bare axes with equal scales and a title."""
    left = (0.005, 0.285, 0.655)[index]
    axes = figure.add_axes((left, 0.02, (0.275, 0.36, 0.34)[index], 0.87))
    axes.set_axis_off()
    axes.set_aspect("equal")
    figure.text(left + 0.01, 0.93, title, fontsize=11, color=INK)
    return axes


def draw_arm(axes: Axes, arm: Arm, theta1: float, theta2: float) -> None:
    """Draw the arm at joint angles, with axis 1."""
    link = seen(turned(arm.shape.centreline(0.01) + arm.base_joint[1], theta1))
    effector = seen(arm.forward_kinematics(theta1, theta2))
    axes.plot([0, 0], seen([[0, 0, -0.08], [0, 0, 1.16]])[:, 1], color=ORANGE, linestyle="-.", linewidth=1.3)
    axes.plot(*link.T, color=BLUE, linewidth=9.0, solid_capstyle="butt", zorder=4)
    axes.plot(*link.T, color=PALE, linewidth=7.6, solid_capstyle="butt", zorder=4)
    axes.plot(*np.array([link[-1], effector]).T, color="#777777", linewidth=3.5, zorder=5)
    axes.plot(*effector, "o", color="black", markersize=6, zorder=6)
    axes.annotate("P5", effector, (9, -7), textcoords="offset points", weight="bold", fontsize=9, zorder=9)


def draw_sweep(axes: Axes, arm: Arm, count: int) -> None:
    """Draw the circle of P5 at angles of joint 1, the one of the arm last."""
    theta2 = np.linspace(0.0, 2.0 * np.pi, 181)
    for theta1 in np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)[1:]:
        axes.plot(*seen(arm.forward_kinematics(theta1, theta2)).T, color=BLUE, linewidth=0.5, alpha=0.45)
    axes.plot(*seen(arm.forward_kinematics(0.0, theta2)).T, color=BLUE, linewidth=1.8, zorder=3)


def arrow(axes: Axes, points: np.ndarray, colour: str = INK) -> None:
    """Draw a curved arrow along points that are already on paper."""
    axes.plot(*points[:-1].T, color=colour, linewidth=1.4, zorder=7)
    style = {"arrowstyle": "-|>", "color": colour, "mutation_scale": 12, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", points[-1], points[-3], arrowprops=style, zorder=7)


def slice_radii(arm: Arm, height: float) -> np.ndarray:
    """Return the distances from axis 1 at which the workspace has a height, m."""
    points = arm.forward_kinematics(0.0, np.linspace(0.0, 2.0 * np.pi, 7201))
    crossing = np.flatnonzero(np.diff(np.sign(points[:, 2] - height)))
    return np.hypot(points[crossing, 0], points[crossing, 1])


def draw_domes(axes: Axes, radius: float) -> None:
    """Draw, from above, a dome about axis 1 and one beside it, at the height where both are as wide."""
    angle = np.linspace(0.0, 2.0 * np.pi, 361)
    circle = radius * np.column_stack([np.cos(angle), np.sin(angle)])
    shift = np.array([0.62 * radius, 0.0])
    for low, centre, word in (
        (0.0, np.zeros(2), "A dome about axis 1\nis followed all round."),
        (-2.5 * radius, shift, "A dome beside axis 1\nis met in two points:\nmove the base."),
    ):
        origin = np.array([0.0, low])
        axes.plot(*(circle + origin).T, color=BLUE, linewidth=4.5, alpha=0.35)
        axes.plot(*(circle + origin + centre).T, color=INK, linewidth=1.2, linestyle="--")
        axes.plot(*origin, "o", color=ORANGE, markersize=6)
        axes.text(1.8 * radius, low, word, fontsize=10, color=INK, va="center")
        if centre.any():
            height = radius * np.sqrt(1.0 - (0.31) ** 2)
            met = origin + 0.5 * centre + np.array([[0.0, height], [0.0, -height]])
            axes.plot(*met.T, "o", color="black", markersize=5)
            axes.annotate("", origin + centre, origin, arrowprops={"arrowstyle": "-|>", "color": ORANGE})
            axes.text(
                *(origin + 0.5 * centre - [0.0, 0.3 * radius]),
                "move",
                color=ORANGE,
                fontsize=9.5,
                ha="center",
            )
        else:
            axes.text(*(origin - [0.0, 0.3 * radius]), "axis 1", color=ORANGE, fontsize=9.5, ha="center")
    axes.set(xlim=(-1.1 * radius, 4.1 * radius), ylim=(-3.6 * radius, 1.1 * radius))


def revolution_picture() -> Figure:
    """Draw the two turns that make a workspace, and two domes seen from above."""
    arm, figure = bent_arm(), Figure(figsize=(10.5, 4.0))
    FigureCanvasAgg(figure)
    first = panel(figure, 0, "1  Joint 2 turns: P5 draws a circle")
    second = panel(figure, 1, "2  Joint 1 turns: that sweeps the workspace")
    third = panel(figure, 2, "3  From above: what can be followed")
    for axes, count in ((first, 1), (second, 40)):
        draw_sweep(axes, arm, count)
        draw_arm(axes, arm, 0.0, 2.3)
        axes.set(xlim=(-0.76, 0.76) if count > 1 else (-0.3, 0.62), ylim=(-0.16, 1.12))
        axes.text(0.03, seen([0, 0, 1.1])[1], "axis 1", color=ORANGE, fontsize=9.5)
    ring = seen([[0.16 * np.cos(a), 0.16 * np.sin(a), 1.03] for a in np.linspace(-2.4, 2.0, 60)])
    arrow(second, ring)
    draw_domes(third, float(slice_radii(arm, HEIGHT).max()))
    return figure
