"""Turns about axis 1, and angles modulo a turn."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from synth.arrays import FloatArray


def turned(points: FloatArray, theta1: ArrayLike) -> FloatArray:
    """Return points turned about axis 1.

    Args:
        points: Points or directions, shape (..., 3); or the first two coordinates of each, (..., 2).
        theta1: Angles that broadcast with the leading axes of the points, rad.
    """
    x, y, cos, sin = points[..., 0], points[..., 1], np.cos(theta1), np.sin(theta1)
    result = np.empty((*np.broadcast_shapes(cos.shape, x.shape), points.shape[-1]))
    result[..., 0], result[..., 1] = cos * x - sin * y, sin * x + cos * y
    result[..., 2:] = points[..., 2:]
    return result


def into_turn(angle: FloatArray, middle: float) -> FloatArray:
    """Return angles moved by whole turns to within half a turn of `middle`, rad."""
    return np.asarray(middle + np.remainder(angle - middle + np.pi, 2.0 * np.pi) - np.pi)
