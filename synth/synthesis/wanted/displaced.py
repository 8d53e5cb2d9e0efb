"""Arms whose link does not end where it should, joint angles computed anew for where it does."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen, frozen_value
from synth.robot import Kinematics
from synth.synthesis.shapes import Postures, TargetsSeen

if TYPE_CHECKING:
    from synth.robot import Arm


@frozen_value
class Displacements:
    """How far the ends of links are from where they should be.

    Attributes:
        shifts: Of the end, in the base frame at joint 1 = 0, shape (k, 3), m.
        turns: Of its frame about itself, likewise, shape (k, 3, 3).
    """

    shifts: FloatArray
    turns: FloatArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "shifts", frozen(self.shifts))
        object.__setattr__(self, "turns", frozen(self.turns))

    def on(self, kinematics: Kinematics, ends: FloatArray) -> Kinematics:
        """Return the joints of shapes after each displacement, shape (N * k,), shape by shape.

        Args:
            kinematics: The joints of the shapes, of shape (N,).
            ends: Where their links end, shape (N, 3), m: what the frame turns about.
        """
        frame = self.turns @ kinematics.frame[:, None]
        lever = (self.turns @ (kinematics.centre - ends)[:, None, :, None])[..., 0]
        centre = ends[:, None] + self.shifts + lever
        radius = np.repeat(kinematics.radius, len(self.shifts))
        return Kinematics(frame.reshape(-1, 3, 3), centre.reshape(-1, 3), radius)


def displaced(arm: Arm, aims: TargetsSeen, displacements: Displacements) -> Postures:
    """Return the postures of arms whose link ends elsewhere, joints at their best within their limits.

    Args:
        arm: The robot in the shape aimed at.
        aims: The targets, n of them.
        displacements: How far the link's end is off, k times.

    Returns:
        The postures nearest to the targets, of k shapes at n targets.
    """
    frame, end = arm.end_frame
    aimed = Kinematics(frame[None], arm.circle.centre[None], np.array([arm.circle.radius]))
    return Postures.nearest(aims, displacements.on(aimed, end[None]), never_away=True)


def rotations(vectors: FloatArray) -> FloatArray:
    """Return the rotation matrices of rotation vectors, shape (k, 3), rad; shape (k, 3, 3)."""
    angle = np.linalg.norm(vectors, axis=1)[:, None, None]
    cross = np.cross(np.eye(3), -vectors[:, None] / np.maximum(angle, 1e-300))
    return np.asarray(np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross)
