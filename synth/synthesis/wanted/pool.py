"""Shapes within the tolerances, the most wanted first: many at once, by samples."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import frozen_value, unlike_all_before
from synth.synthesis.shapes import Postures, Shapes, TargetsSeen, overlaps
from synth.synthesis.wanted.forgiveness import misses_after_a_hand
from synth.synthesis.wanted.margins import Margins
from synth.synthesis.wanted.ranking import CALM, is_content, preferences, preferred
from synth.synthesis.wanted.ways import MOST_MOTIONS

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.task import Task

# What a miss may take of its tolerance: the rest is for rounding.
_PART_OF_TOLERANCE = 0.9
_ERRORS = 32  # of a hand, for each shape: a quarter of those by which the best are judged
_DISTINCT = 0.03  # m, between link ends with axes of ARM_LENGTH


@frozen_value
class Pool:
    """Shapes within the tolerances, the most wanted first.

    Attributes:
        shapes: The shapes, of shape (N,).
        table: Rows of `preferences`, shape (N, 7).
        joints: Joint angles at the targets, shape (N, n, 2), rad.
    """

    shapes: Shapes
    table: FloatArray
    joints: FloatArray

    @classmethod
    def of(
        cls,
        task: Task,
        narrow: Task,
        shapes: Shapes,
        stop: Callable[[], bool],
        part: float = _PART_OF_TOLERANCE,
    ) -> Pool:
        """Return those of some shapes that meet a task, as far as samples tell.

        Args:
            task: The task.
            narrow: The same with limits drawn in.
            shapes: The shapes.
            stop: When it says yes the obstacles are left out: nobody asks for these shapes any more.
            part: Of each tolerance, that a miss may take.
        """
        aims = TargetsSeen.of(narrow)
        postures = Postures.nearest(aims, shapes.kinematics)
        within = (np.sqrt(postures.squared) <= part * task.tolerances).all(axis=1)
        joints = postures.joints
        within &= _over_floor(task, shapes, joints)
        shapes, joints = shapes.take(within), joints[within]
        depth = overlaps(narrow, shapes, joints, is_up=stop).max(axis=1, initial=0.0)
        clearance = Margins.wanted(task.robot).clearance
        clear = depth <= clearance
        shapes, joints, depth = shapes.take(clear), joints[clear], depth[clear]
        swings = swings_of(joints)
        expected, _ = misses_after_a_hand(
            aims, task.tolerances, shapes.kinematics, shapes.end[1], joints[..., 1], _ERRORS
        )
        table = preferences(
            np.zeros(len(depth)),
            depth / clearance,
            swings.max(axis=1, initial=0.0),
            expected,
            swings.sum(axis=1),
            shapes.bending,
        )
        return cls(shapes, table, joints).sorted()

    def sorted(self) -> Pool:
        """Return the same, the most wanted first."""
        chosen = preferred(self.table)
        return Pool(self.shapes.take(chosen), self.table[chosen], self.joints[chosen])

    def joined(self, other: Pool) -> Pool:
        """Return the shapes of both."""
        return Pool(
            Shapes.joined([self.shapes, other.shapes]),
            np.concatenate([self.table, other.table]),
            np.concatenate([self.joints, other.joints]),
        ).sorted()

    @property
    def is_content(self) -> bool:
        """Whether one of the shapes leaves nothing to wish for in ways, margins and swings."""
        return any(map(is_content, self.table))

    @property
    def must_swing(self) -> bool:
        """Whether joint 1 swings far between the same two targets in all of the shapes."""
        steps = np.abs(np.diff(self.joints[..., 0], axis=1))
        return bool((steps.min(axis=0, initial=np.inf) > CALM).any())

    def distinct(self) -> NDArray[np.intp]:
        """Return which shapes differ from all that are wanted more."""
        poses = self.shapes.poses
        return unlike_all_before(np.linalg.norm(poses[:, None] - poses, axis=-1) >= _DISTINCT)


def swings_of(joints: FloatArray) -> FloatArray:
    """Return the turns from each target to the next of the joint that turns more, rad, shape (N, n - 1).

    None where there are so many targets that nobody asks for ways between them.

    Args:
        joints: Joint angles, shape (N, n, 2), rad.
    """
    if joints.shape[1] > MOST_MOTIONS:
        joints = joints[:, :1]
    return np.asarray(np.abs(np.diff(joints, axis=1)).max(axis=2))


def _over_floor(task: Task, shapes: Shapes, joints: FloatArray) -> NDArray[np.bool_]:
    """Return which shapes stay over the floor, link, joint 2 and end effector, at samples of the link."""
    if task.floor_in_base is None:
        return np.ones(len(joints), dtype=np.bool_)
    robot, (frame, end) = task.robot, shapes.end
    link = shapes.centreline[:, :, 2].min(axis=1) - 0.5 * robot.link.diameter
    along = np.array([-robot.tip_offset, robot.d34 - robot.tip_offset])
    axis = (end[:, 2, None] + along * frame[:, 2, 0, None]).min(axis=1)
    tip = shapes.kinematics.each_target().forward(0.0, joints[..., 1])[..., 2].min(axis=1)
    lowest = np.minimum(np.minimum(link, axis), tip - 0.5 * robot.rigid_link.diameter)
    return np.asarray(lowest >= task.floor_in_base)
