"""The drawings of the sheet: three views of the robot and the section of its workspace surface."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import compared_by_value
from synth.export.sheet.labels import Labels
from synth.export.sheet.obstacle_outlines import draw_obstacle, ends_of
from synth.guide import MARKERS
from synth.robot import BasePose

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.geometry import Solid
    from synth.guide import Guide, Placement
    from synth.synthesis import Design, Solution

# Colours of Okabe and Ito, told apart with any colour vision; line styles tell them apart in grey.
LINK, AXIS, TARGET, GHOST = "#0072B2", "#D55E00", "#000000", "#8C8C8C"
# Which coordinates a view shows to the right and upwards: a third-angle projection.
TOP, FRONT, SIDE = (0, 1), (0, 2), (1, 2)
_POINTS_PER_MM = 72.0 / 25.4
MOST_DRAWN = 1000  # targets, beside those that have a label: more cover each other
_MOST_NAMED = 30  # obstacles: names of more would hide the drawing, and take seconds to place
_MOST_OF_LINK = 1000  # points of a very long link
_AROUND = 120.0  # mm, how far obstacles are shown beyond the arm and its targets
_FAR, _NEAR_SIDE = 250.0, 60.0  # mm; what begins farther off is not drawn, and of what does not this much
_AXIS_LENGTH = 9.0  # mm of paper to either side of the markers, drawn of an axis


@compared_by_value
@dataclass(frozen=True, eq=False)
class Scene:
    """What all views show, in the task frame and in mm.

    Attributes:
        targets: Positions of the targets, shape (n, 3).
        reached: Whether each of them is within its tolerance.
        labels: A label for each target, or "" for those that have none.
        base: P1 and P2, shape (2, 3).
        floor: Height of the floor, or None.
        obstacles: Name and solid of each obstacle that is near, in the task frame and in m.
        far_obstacles: Names of those that are too far off to be drawn.
        hold: The points at the hold angle of joint 1, or None without a shape to bend the link to.
        link: Centreline at that angle, shape (k, 3).
        diameter: Outer diameter of the link.
        ghost: Centreline with joint 1 as at the first target, shape (k, 3).
        rigid: From the link's end to P5 there, shape (2, 3).
    """

    targets: FloatArray
    reached: Sequence[bool]
    labels: Sequence[str]
    base: FloatArray
    floor: float | None
    obstacles: Sequence[tuple[str, Solid]]
    far_obstacles: Sequence[str]
    hold: Placement | None
    link: FloatArray
    diameter: float
    ghost: FloatArray
    rigid: FloatArray

    @classmethod
    def of(cls, solution: Solution, guide: Guide | None, labels: Sequence[str]) -> Scene:
        """Return the scene of a solution, with labels for its targets."""
        task, nothing = solution.task, np.zeros((0, 3))
        base, hold = task.base, None
        reached: Sequence[bool] = [False] * len(task.targets)
        link = ghost = rigid = nothing
        if guide is not None:
            arm, check = solution.robot, solution.best.verification
            base, reached = arm.base, check.within_tolerance
            spacing = max(0.01, arm.shape.length / _MOST_OF_LINK)
            centreline = arm.shape.centreline(spacing) + arm.base_joint[1]
            ghost = 1e3 * base.to_task(BasePose(yaw=float(check.joints[0, 0])).to_task(centreline))
            rigid = np.stack([ghost[-1], 1e3 * check.reached[0]])
            if guide.met:
                hold = guide.hold
                link = 1e3 * base.to_task(BasePose(yaw=hold.joint1).to_task(centreline))
        scene = cls(
            targets=1e3 * task.table.positions,
            reached=reached,
            labels=labels,
            base=1e3 * base.to_task([[0.0, 0.0, 0.0], [0.0, 0.0, task.robot.d12]]),
            floor=None if task.floor_height is None else 1e3 * task.floor_height,
            obstacles=[],
            far_obstacles=[],
            hold=hold,
            link=link,
            diameter=1e3 * task.robot.link.diameter,
            ghost=ghost,
            rigid=rigid,
        )
        near = [scene.is_near(obstacle.solid) for obstacle in task.obstacles]
        named = [(obstacle.name, obstacle.solid) for obstacle in task.obstacles]
        return replace(
            scene,
            obstacles=list(itertools.compress(named, near)),
            far_obstacles=[name for (name, _), drawn in zip(named, near, strict=True) if not drawn],
        )

    @property
    def drawn(self) -> NDArray[np.bool_]:
        """Which targets are drawn, shape (n,): those with a label, and of many others an even choice."""
        chosen = np.array([bool(label) for label in self.labels])
        step = -(-len(chosen) // MOST_DRAWN)
        chosen[::step] = True
        return chosen

    @property
    def bounds(self) -> FloatArray:
        """Lowest and highest coordinates of all that is shown, shape (2, 3), with a margin."""
        lowest, highest = self._of_the_arm
        # Obstacles are shown as far as they are near, or their near side: a wall may be long.
        low, high = self._of_the_arm + np.array([[-_AROUND], [_AROUND]])
        for _, solid in self.obstacles:
            ends = ends_of(solid)
            lowest = np.minimum(lowest, np.maximum(ends[0], np.minimum(low, ends[1] - _NEAR_SIDE)))
            highest = np.maximum(highest, np.minimum(ends[1], np.maximum(high, ends[0] + _NEAR_SIDE)))
        return np.array([lowest, highest])

    def is_near(self, solid: Solid) -> bool:
        """Whether an obstacle is near enough to the arm and its targets to be drawn."""
        ends, farthest = ends_of(solid), self._of_the_arm + np.array([[-_FAR], [_FAR]])
        return bool(np.all(ends[0] <= farthest[1]) and np.all(ends[1] >= farthest[0]))

    @property
    def _of_the_arm(self) -> FloatArray:
        """The bounds of all but the obstacles."""
        points = np.vstack([self.targets, self.base, self.link, self.ghost, self.rigid])
        if self.floor is not None:
            points = np.vstack([points, [*points[0, :2], self.floor]])
        margin = 0.5 * self.diameter + 0.05 * float(np.ptp(points, axis=0).max())
        return np.array([points.min(axis=0) - margin, points.max(axis=0) + margin])


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
    if scene.floor is not None:
        _draw_floor(axes, scene.floor)
    axes.plot(*whole.T, color=LINK, linewidth=0.8, linestyle="--", zorder=3)
    axes.plot(*within.T, color=LINK, linewidth=1.8, zorder=4)
    labels.avoid_line(whole[::8])
    axes.axvline(0.0, color=AXIS, linewidth=0.8, linestyle="-.", zorder=2)
    if limits.upper - limits.lower < 2.0 * math.pi - 1e-9:
        for angle, end in ((limits.lower, within[0]), (limits.upper, within[-1])):
            axes.plot(*end, "|", color=LINK, markersize=7.0, markeredgewidth=1.4, zorder=5)
            labels.add(f"{math.degrees(angle):.0f}°", end)
    rho = 1e3 * np.hypot(*arm.base.to_base(scene.targets / 1e3)[:, :2].T)
    _draw_targets(axes, np.column_stack([rho, scene.targets[:, 2]]), scene, labels)
    labels.place()


def section(design: Design, theta2: FloatArray) -> FloatArray:
    """Return P5 as distance from axis 1 and height in the task frame, shape (k, 2), mm."""
    arm = design.arm
    points = arm.base.to_base(arm.forward_kinematics(0.0, theta2))
    return 1e3 * np.column_stack([np.hypot(points[:, 0], points[:, 1]), points[:, 2] + arm.base.position[2]])


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
