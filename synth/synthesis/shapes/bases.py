"""Where the bases of many shapes stand, where the task leaves that free."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from synth.arrays import FloatArray, frozen_value
from synth.geometry import rotation_of
from synth.synthesis.shapes.columns import BASE_NUMBERS


@frozen_value
class Bases:
    """Poses of bases in the task frame; leading axes "..." are free.

    Attributes:
        rows: x, y, z, m, and roll, pitch and yaw, rad, shape (..., 6).
    """

    rows: FloatArray

    @cached_property
    def rotation(self) -> FloatArray:
        """Rotations from the base frames to the task frame, shape (..., 3, 3)."""
        return rotation_of(*np.moveaxis(self.rows[..., 3:], -1, 0))

    def seen(self, points: FloatArray) -> FloatArray:
        """Return points of the task frame, shape (n, 3), m, in each base's own frame, shape (..., n, 3)."""
        return np.asarray((points - self.rows[..., None, :3]) @ self.rotation)

    def in_task(self, points: FloatArray) -> FloatArray:
        """Return points of N base frames, shape (N, ..., 3), m, in the task frame."""
        flat = points.reshape(len(points), -1, 3) @ np.swapaxes(self.rotation, -1, -2)
        return np.asarray((flat + self.rows[:, None, :3]).reshape(points.shape))

    def motion_beside(self, of_arm: FloatArray) -> FloatArray:
        """Return the motion of arms, shape (N, k, unknowns), and behind it that of their bases."""
        count, rows, columns = of_arm.shape
        whole = np.zeros((count, rows + BASE_NUMBERS, columns + BASE_NUMBERS))
        whole[:, :rows, :columns], whole[:, rows:, columns:] = of_arm, self.motion
        return whole

    @property
    def motion(self) -> FloatArray:
        """How the bases shift and turn in their own frames by their six numbers, shape (N, 6, 6)."""
        _, pitch, yaw = np.moveaxis(self.rows[:, 3:], -1, 0)
        zero, back = np.zeros_like(yaw), np.swapaxes(self.rotation, -1, -2)
        about = [
            rotation_of(zero, pitch, yaw)[..., 0],
            rotation_of(zero, zero, yaw)[..., 1],
            np.broadcast_to([0.0, 0.0, 1.0], (len(yaw), 3)),
        ]
        motion = np.zeros((len(yaw), 6, 6))
        motion[:, :3, :3] = back
        motion[:, 3:, 3:] = back @ np.stack(about, axis=-1)
        return motion
