"""Turns about axis 1, and angles modulo a turn."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from synth.arrays import FloatArray


def turned(theta1: ArrayLike, point: FloatArray) -> FloatArray:
    """Return points, shape (..., 3), turned about z by theta1, shape (...), rad."""
    x, y, z = point[..., 0], point[..., 1], point[..., 2]
    cos, sin = np.cos(theta1), np.sin(theta1)
    result = np.empty((*np.broadcast_shapes(cos.shape, z.shape), 3))
    result[..., 0], result[..., 1], result[..., 2] = cos * x - sin * y, sin * x + cos * y, z
    return result


def into_turn(angle: FloatArray, middle: float) -> FloatArray:
    """Return angles moved by whole turns to within half a turn of `middle`, rad."""
    return np.asarray(middle + np.remainder(angle - middle + np.pi, 2.0 * np.pi) - np.pi)
