"""The picture of a solved task: the arm at its first target, its workspace cut open, targets, obstacles."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from colours import BLUE, GREY, ORANGE, RED, WALL
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection
from mpl_toolkits.mplot3d.proj3d import proj_transform

from synth import Box, Capsule, Sphere

if TYPE_CHECKING:
    from mpl_toolkits.mplot3d import Axes3D

    from synth import Arm, Solution

ELEVATION, TOWARDS = 22.0, -62.0  # of who looks, deg
CUT = 105.0  # deg of the workspace that are left out, so that the arm inside can be seen
MOST_NAMED = 6  # targets; of more only the numbers are written
FEW = 500  # samples, of which each has a dot that is seen on its own
NAME_SIZE = 11.0


def turned(points: np.ndarray, angle: float) -> np.ndarray:
    """Return points of the base frame turned about axis 1."""
    cos, sin = np.cos(angle), np.sin(angle)
    return points @ np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]])


def in_task(arm: Arm, points: np.ndarray) -> np.ndarray:
    """Return points of the base frame in the task frame, mm."""
    return 1e3 * arm.base.to_task(points)


def draw_workspace(axes: Axes3D, arm: Arm) -> np.ndarray:
    """Draw where P5 gets within the joint limits, without the part in front; return its points, mm."""
    limits = arm.robot.joint_limits
    middle = np.radians(TOWARDS) - arm.base.yaw  # of the part in front, as joint 1 of P5 has it
    reach = np.arctan2(*arm.base.to_base(arm.forward_kinematics(0.0, np.pi))[[1, 0]])
    half = np.radians(CUT) / 2.0
    theta1 = np.linspace(middle + half, middle + 2.0 * np.pi - half, 121) - reach
    back = np.remainder(theta1 - limits.base.middle + np.pi, 2.0 * np.pi) + limits.base.middle - np.pi
    within = (back >= limits.base.lower) & (back <= limits.base.upper)
    theta2 = np.linspace(limits.second.lower, limits.second.upper, 61)
    surface = 1e3 * arm.forward_kinematics(theta1[:, None], theta2)
    surface[~within] = np.nan
    x, y, z = np.moveaxis(surface, -1, 0)
    axes.plot_surface(x, y, z, color=BLUE, alpha=0.10, linewidth=0, rcount=121, ccount=61, zorder=1)
    axes.plot_wireframe(x, y, z, color=BLUE, alpha=0.22, linewidth=0.4, rcount=25, ccount=12, zorder=1)
    return surface[within].reshape(-1, 3)


def draw_arm(axes: Axes3D, arm: Arm, joints: np.ndarray, reached: np.ndarray) -> np.ndarray:
    """Draw the arm at joint angles; return the points of its link, mm."""
    link = in_task(arm, turned(arm.shape.centreline(0.01) + arm.base_joint[1], joints[0]))
    p3, p4 = in_task(arm, turned(arm.axis_points[2:], joints[0]))
    upright = in_task(arm, np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 2.0 * arm.robot.d12]]))
    axes.plot(*upright.T, color=ORANGE, linewidth=3, zorder=4)
    axes.plot(*link.T, color=GREY, linewidth=7, solid_capstyle="round", zorder=5)
    axes.plot(*np.array([2.2 * p3 - 1.2 * p4, 2.2 * p4 - 1.2 * p3]).T, color=ORANGE, linewidth=3, zorder=6)
    axes.plot(*np.array([link[-1], 1e3 * reached]).T, color=GREY, linewidth=4, zorder=6)
    return link


def draw_targets(axes: Axes3D, solution: Solution, *, named: bool) -> np.ndarray:
    """Draw the targets, those missed as crosses with the way that is missing; return their points, mm."""
    for path in solution.task.paths:
        line = 1e3 * path.at(path.parameters(400))
        axes.plot(*line.T, color="black", linewidth=2.5, zorder=8)
        if named:
            axes.text(*(line[len(line) // 2] + [22.0, 0.0, 28.0]), path.name, fontsize=NAME_SIZE, zorder=9)
    task, within = solution.task, np.array(solution.best.verification.within_tolerance)
    for number, surface in enumerate(task.surfaces):
        of_it = task.surface_of_targets == number
        for some, colour in ((of_it & within, "black"), (of_it & ~within, RED)):
            points = 1e3 * task.table.positions[some]
            size = 4.0 if len(of_it) < FEW else 1.8
            axes.plot(*points.T, ".", color=colour, markersize=size, markeredgewidth=0.0, zorder=8)
        if named:
            top = 1e3 * max(task.table.positions[of_it], key=lambda point: float(point[2]))
            axes.text(*(top + [22.0, 0.0, 28.0]), surface.name, fontsize=NAME_SIZE, zorder=9)
    for index, target in enumerate(solution.targets, start=1):
        if not task.is_of_its_own[index - 1]:
            continue
        position, reached = 1e3 * target.position, 1e3 * target.reached
        marker, colour = ("o", "black") if target.within_tolerance else ("X", RED)
        axes.plot(*position[:, None], marker, color=colour, markersize=7, zorder=8)
        if not target.within_tolerance:
            axes.plot(*np.array([position, reached]).T, color=RED, linewidth=1.2, linestyle=":", zorder=8)
        name = target.name if len(solution.targets) <= MOST_NAMED else str(index)
        if not named:
            continue
        axes.text(*(position + [22.0, 0.0, 28.0]), name, fontsize=NAME_SIZE, zorder=9)
    return 1e3 * solution.task.table.positions


def faces_of(solid: Box | Capsule | Sphere) -> list[np.ndarray]:
    """Return what is drawn of a solid: the faces of a box, circles of anything round, mm."""
    if isinstance(solid, Box):
        cos, sin = np.cos(solid.yaw), np.sin(solid.yaw)
        square = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * 0.5
        low, high = (np.column_stack([square, np.full(4, height)]) * solid.size for height in (-0.5, 0.5))
        turn = np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]])
        sides = [np.array([low[i], low[(i + 1) % 4], high[(i + 1) % 4], high[i]]) for i in range(4)]
        return [1e3 * (solid.centre + face @ turn) for face in (low, high, *sides)]
    ends = solid.ends if isinstance(solid, Capsule) else [solid.centre]
    angle = np.linspace(0.0, 2.0 * np.pi, 37)
    ring = solid.radius * np.column_stack([np.cos(angle), np.sin(angle), np.zeros(37)])
    return [1e3 * (end + ring[:, order]) for end in ends for order in ([0, 1, 2], [0, 2, 1], [2, 0, 1])]


def draw_floor(axes: Axes3D, points: np.ndarray, height: float) -> None:
    """Draw the floor below points as squares of 200 mm."""
    low = 200.0 * np.floor(points.min(axis=0)[:2] / 200.0)
    high = 200.0 * np.ceil(points.max(axis=0)[:2] / 200.0)
    x, y = (np.arange(low[i], high[i] + 1.0, 200.0) for i in (0, 1))
    lines = [[(at, low[1], height), (at, high[1], height)] for at in x]
    lines += [[(low[0], at, height), (high[0], at, height)] for at in y]
    axes.add_collection3d(Line3DCollection(lines, colors="#bbbbbb", linewidths=0.5, zorder=0))


def fit(axes: Axes3D, points: np.ndarray) -> None:
    """Move and scale the axes until points, shape (k, 3), fill the figure but for a margin."""
    figure = axes.figure
    figure.draw_without_rendering()
    x, y, _ = proj_transform(*points.T, axes.get_proj())
    seen = figure.transFigure.inverted().transform(axes.transData.transform(np.column_stack([x, y])))
    low, high = seen.min(axis=0), seen.max(axis=0)
    room_low, room_high = np.array([0.05, 0.05]), np.array([0.93, 0.93])
    scale = float(((room_high - room_low) / (high - low)).min())
    box = axes.get_position(original=True)
    corner = 0.5 * (room_low + room_high) + scale * (np.array([box.x0, box.y0]) - 0.5 * (low + high))
    axes.set_position((*corner, scale * box.width, scale * box.height))


def task_picture(solution: Solution, *, width: float = 7.5, named: bool = True) -> Figure:
    """Draw a solved task.

    Args:
        solution: What was found; it must have a shape.
        width: Width of the picture, inches.
        named: Whether targets have their names, and the floor its measure.
    """
    figure = Figure(figsize=(width, 0.72 * width))
    FigureCanvasAgg(figure)
    axes = figure.add_axes((-0.16, -0.3, 1.32, 1.62), projection="3d", computed_zorder=False)
    arm, first, task = solution.robot, solution.targets[0], solution.task
    seen = [draw_workspace(axes, arm), draw_arm(axes, arm, first.joints, first.reached)]
    seen.append(draw_targets(axes, solution, named=named))
    points = np.vstack(seen)
    for obstacle in task.obstacles:
        axes.add_collection3d(
            Poly3DCollection(faces_of(obstacle.solid), facecolor=WALL, edgecolor=WALL, alpha=0.13, zorder=2)
        )
    if task.floor_height is not None:
        height = 1e3 * task.floor_height
        draw_floor(axes, points, height)
        points = np.vstack([points, [*points[0, :2], height]])
        if named:
            figure.text(0.99, 0.015, "squares of 200 mm", ha="right", fontsize=8.5, color=GREY)
    low, high = points.min(axis=0), points.max(axis=0)
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axes.set_aspect("equal")
    axes.set_proj_type("ortho")
    axes.view_init(elev=ELEVATION, azim=TOWARDS)
    axes.set_axis_off()
    fit(axes, points)
    return figure
