"""Screening: about how far each of many random shapes passes by the targets."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from synth.synthesis.shapes import category_offsets
from synth.synthesis.starts.refined import relative_weights

if TYPE_CHECKING:
    from synth.arrays import FloatArray
    from synth.synthesis.starts.random_shapes import RandomShapes
    from synth.task import Task

# Misses are only compared up to here, m: beyond, a shape is far off, and the amount says little.
_FAR = 0.3


def estimated_misses(task: Task, drawn: RandomShapes) -> FloatArray:
    """Return about how far the workspace of each shape passes by each target; no joint limits.

    In the plane of height z and squared distance N = |P5|^2 a workspace is an ellipse,
    (z, N) = (cz, |c|^2 + R^2) + M (cos theta2, sin theta2). For d = (z, N) of the target less the
    centre, |adj(M) d| - |det M| vanishes on it; divided by the length of its gradient it is the
    distance to first order, and, unlike Gamma, it is so for perfect squares too.

    Args:
        task: The task.
        drawn: The shapes.

    Returns:
        Estimated misses, shape (n, N), m.
    """
    (lifted, squared), ((m00, m01), (m10, m11)), determinant = drawn.ellipses
    shapes = drawn.shapes
    determinant = np.abs(determinant)
    misses = np.empty((len(task.targets), len(squared)))
    positions = task.positions_in_base if shapes.places is None else shapes.bases.seen(task.table.positions)
    for row, (x, y, z) in enumerate(np.moveaxis(positions, (-2, -1), (0, 1))):
        height = z - lifted
        beyond = x * x + y * y + z * z - squared
        a = m11 * height - m01 * beyond
        b = m00 * beyond - m10 * height
        norm = np.sqrt(a * a + b * b) + 1e-15
        # By N and by z, times the norm: a hypotenuse is slower than the root of the squares.
        by_squared = m00 * b - m01 * a
        by_height = m11 * a - m10 * b + 2.0 * z * by_squared
        steepness = np.sqrt(by_height * by_height + 4.0 * (x * x + y * y) * by_squared * by_squared)
        misses[row] = np.abs(norm - determinant) * norm / (steepness + 1e-12 * norm)
    return misses


def screened(task: Task, drawn: RandomShapes) -> FloatArray:
    """Return what shapes cost at first sight, shape (N,), m^2.

    The mean squared misses, estimated and weighted, and the squared distance from the category that the task
    asks for.

    Args:
        task: The task.
        drawn: The shapes, of shape (N,).
    """
    misses = np.minimum(estimated_misses(task, drawn), _FAR)
    offsets = category_offsets(task, drawn.shapes)
    return np.asarray(relative_weights(task) @ misses**2 + np.sum(offsets**2, axis=-1))
