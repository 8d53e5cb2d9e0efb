"""Rotations by roll, pitch and yaw about the fixed axes x, y, z, in this order (ROS)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from synth.arrays import FloatArray

_GIMBAL_LOCK = 1.0 - 1e-12  # of |sin pitch|: there roll and yaw are about one axis


def rotation_of(roll: ArrayLike, pitch: ArrayLike, yaw: ArrayLike) -> FloatArray:
    """Return Rz(yaw) Ry(pitch) Rx(roll) for angles of shape (...), rad; of shape (..., 3, 3)."""
    (a, b, c), (p, q, r) = (
        [of(np.asarray(angle, dtype=np.float64)) for angle in (roll, pitch, yaw)] for of in (np.cos, np.sin)
    )
    rows = [
        [c * b, c * q * p - r * a, c * q * a + r * p],
        [r * b, r * q * p + c * a, r * q * a - c * p],
        [-q, b * p, b * a],
    ]
    return np.stack([np.stack(np.broadcast_arrays(*row), axis=-1) for row in rows], axis=-2)


def roll_pitch_yaw(rotation: FloatArray) -> tuple[float, float, float]:
    """Return roll, pitch and yaw of a rotation matrix, shape (3, 3), rad; roll is 0 in gimbal lock."""
    sine = float(np.clip(-rotation[2, 0], -1.0, 1.0))
    pitch = float(np.arctan2(sine, np.hypot(rotation[2, 1], rotation[2, 2])))
    if abs(sine) > _GIMBAL_LOCK:
        return 0.0, pitch, float(np.arctan2(-rotation[0, 1], rotation[1, 1]))
    roll = float(np.arctan2(rotation[2, 1], rotation[2, 2]))
    return roll, pitch, float(np.arctan2(rotation[1, 0], rotation[0, 0]))
