"""What arms miss whose link does not end where it should, joint angles computed anew for where it does."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from synth.robot import Kinematics
from synth.synthesis.starts import Postures, TargetsSeen

if TYPE_CHECKING:
    from synth.arrays import FloatArray
    from synth.robot import Arm


def misses_displaced(arm: Arm, positions: FloatArray, shifts: FloatArray, turns: FloatArray) -> FloatArray:
    """Return the misses of arms whose link ends elsewhere, joints at their best within their limits.

    Args:
        arm: The robot in the shape aimed at.
        positions: Targets in the base frame, shape (n, 3), m.
        shifts: By how much the link's end is off, in the base frame at joint 1 = 0, shape (k, 3), m.
        turns: By which rotation about itself, likewise, shape (k, 3, 3).

    Returns:
        Distances of P5 from the targets, shape (k, n), m.
    """
    rotation, end = arm.end_frame
    centres = end + shifts + turns @ (arm.circle.centre - end)
    displaced = Kinematics(turns @ rotation, centres, np.full(len(turns), arm.circle.radius))
    return np.sqrt(Postures.nearest(TargetsSeen(positions, arm.robot.joint_limits), displaced).squared)


def rotations(vectors: FloatArray) -> FloatArray:
    """Return the rotation matrices of rotation vectors, shape (k, 3), rad; shape (k, 3, 3)."""
    angle = np.linalg.norm(vectors, axis=1)[:, None, None]
    cross = np.cross(np.eye(3), -vectors[:, None] / np.maximum(angle, 1e-300))
    return np.asarray(np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross)
