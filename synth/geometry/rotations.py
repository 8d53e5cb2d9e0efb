"""Rotations by roll, pitch and yaw about the fixed axes x, y, z, in this order (ROS)."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from synth.arrays import FloatArray


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
    """Return the angles about the fixed axes x, y, z, in this order, rad: R = Rz(yaw) Ry(pitch) Rx(roll).

    Where the pitch is a quarter turn, yaw and roll turn about one axis; the yaw is then what the matrix
    says of it, and the roll the rest, so that the product is right to rounding all the same.

    Args:
        rotation: The rotation matrix, shape (3, 3).
    """
    r = rotation
    pitch = math.atan2(-r[2, 0], math.hypot(r[0, 0], r[1, 0]))
    yaw = math.atan2(r[1, 0], r[0, 0])
    c, s = math.cos(yaw), math.sin(yaw)
    roll = math.atan2(s * r[0, 2] - c * r[1, 2], c * r[1, 1] - s * r[0, 1])
    return roll, pitch, yaw
