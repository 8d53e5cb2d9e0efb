"""Rotations as robot descriptions write them: quaternions, and frames along a direction."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from synth.arrays import FloatArray


def quaternion(rotation: FloatArray) -> FloatArray:
    """Return a rotation matrix, shape (3, 3), as the unit quaternion (w, x, y, z), shape (4,), w >= 0."""
    r = rotation
    # Twice the products of each pair of its elements; the largest square is divided by.
    products = np.array(
        [
            [1.0 + r[0, 0] + r[1, 1] + r[2, 2], r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]],
            [r[2, 1] - r[1, 2], 1.0 + r[0, 0] - r[1, 1] - r[2, 2], r[0, 1] + r[1, 0], r[0, 2] + r[2, 0]],
            [r[0, 2] - r[2, 0], r[0, 1] + r[1, 0], 1.0 - r[0, 0] + r[1, 1] - r[2, 2], r[1, 2] + r[2, 1]],
            [r[1, 0] - r[0, 1], r[0, 2] + r[2, 0], r[1, 2] + r[2, 1], 1.0 - r[0, 0] - r[1, 1] + r[2, 2]],
        ]
    )
    row = products[int(np.argmax(np.diag(products)))]
    unit = row / np.linalg.norm(row)
    return np.asarray(-unit if unit[0] < 0.0 else unit)


def along(direction: FloatArray) -> tuple[float, float, float]:
    """Return roll, pitch, yaw, rad, of a frame whose z axis has a direction, shape (3,), of any length."""
    x, y, z = direction.tolist()
    return 0.0, math.atan2(math.hypot(x, y), z), math.atan2(y, x)
