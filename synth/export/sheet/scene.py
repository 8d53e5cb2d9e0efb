"""What the drawings of the sheet show, in the task frame and in mm."""

from __future__ import annotations

import itertools
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import frozen_value
from synth.export.sheet.obstacle_outlines import ends_of
from synth.robot import BasePose

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.geometry import Solid
    from synth.guide import Guide, Placement
    from synth.synthesis import Solution

MOST_DRAWN = 1000  # targets, beside those that have a label: more cover each other
_MOST_OF_LINK = 1000  # points of a very long link
_AROUND = 120.0  # mm, how far obstacles are shown beyond the arm and its targets
_FAR = 250.0  # mm; obstacles that begin farther off are not drawn
_NEAR_SIDE = 60.0  # mm, of those that do not: so much is shown


@frozen_value
class Scene:
    """What all views show, in the task frame and in mm.

    Attributes:
        targets: Positions of the targets, shape (n, 3).
        reached: Whether each of them is within its tolerance.
        labels: A label for each target, or "" for those that have none.
        path_of: Of which path each target is a sample, shape (n,); -1 for any other.
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
    path_of: NDArray[np.intp]
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
            path_of=task.path_of_targets,
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
        """Which targets have a mark, shape (n,): those with a label, and of many others an even choice.

        Of paths, which are lines, only samples that are missed have one.
        """
        chosen = np.array([bool(label) for label in self.labels])
        step = -(-len(chosen) // MOST_DRAWN)
        others = np.arange(len(chosen)) % step == 0
        return np.asarray(chosen | (others & ~((self.path_of >= 0) & np.array(self.reached, dtype=bool))))

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
