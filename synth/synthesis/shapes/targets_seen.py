"""Targets as joint 1 sees them, from one base or from each of many."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen_value

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.robot import BasePose, JointLimits
    from synth.synthesis.shapes.shapes import Shapes
    from synth.task import Task


@frozen_value
class TargetsSeen:
    """Targets as joint 1 sees them, and the limits of the joints.

    Attributes:
        positions: Targets in the base frame, shape (n, 3), m; or in those of N bases, shape (N, n, 3).
        limits: Limits of both joints.
        approaches: Directions of arrival in the base frame and their tolerances, rad, shape (n, 4) or
            (N, n, 4), NaN where there is none; None if all are.
    """

    positions: FloatArray
    limits: JointLimits
    approaches: FloatArray | None = None

    @classmethod
    def by(cls, task: Task, shapes: Shapes) -> TargetsSeen:
        """Return the targets of a task as shapes see them, each from its own base if that is free."""
        if shapes.places is None:
            return cls.of(task)
        rows = task.table.approaches
        if rows is not None:
            seen = np.broadcast_to(rows[:, 3:], (len(shapes.length), len(rows), 1))
            rows = np.concatenate([rows[:, :3] @ shapes.bases.rotation, seen], axis=-1)
        return cls(shapes.bases.seen(task.table.positions), task.robot.joint_limits, rows)

    @classmethod
    def of(cls, task: Task) -> TargetsSeen:
        """Return the targets of a task from its base."""
        return cls(task.positions_in_base, task.robot.joint_limits, task.approaches_in_base)

    @classmethod
    def from_base(
        cls, task: Task, base: BasePose, some: NDArray[np.intp] | slice = slice(None)
    ) -> TargetsSeen:
        """Return some targets of a task from a base that may be its own or another."""
        rows = task.table.approaches
        if rows is not None:
            rows = np.column_stack([rows[some, :3] @ base.rotation, rows[some, 3]])
        return cls(base.to_base(task.table.positions[some]), task.robot.joint_limits, rows)

    @cached_property
    def twice(self) -> TargetsSeen:
        """The same with each target twice, all of them one after the other."""
        rows = None if self.approaches is None else np.concatenate([self.approaches] * 2, axis=-2)
        return TargetsSeen(np.concatenate([self.positions] * 2, axis=-2), self.limits, rows)

    @cached_property
    def radial(self) -> FloatArray:
        """Distances from axis 1, shape (n,) or (N, n), m."""
        return np.hypot(self.positions[..., 0], self.positions[..., 1])

    @cached_property
    def azimuth(self) -> FloatArray:
        """Angles about axis 1, shape (n,) or (N, n), rad."""
        return np.arctan2(self.positions[..., 1], self.positions[..., 0])
