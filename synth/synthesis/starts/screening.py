"""Screening: many random shapes that the link can take, and about how far each passes by the targets."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from synth.robot import BaseRange
from synth.synthesis.shapes import Shapes, category_offsets
from synth.synthesis.starts.refined import relative_weights
from synth.task import Floor

if TYPE_CHECKING:
    from synth.arrays import FloatArray
    from synth.robot import Robot
    from synth.task import Task

_SHAPES = 20_000
# Misses are only compared up to here, m: beyond, a shape is far off, and the amount says little.
_FAR = 0.3


@lru_cache(maxsize=4)
def shapes_at_random(robot: Robot, floor: float | None, seed: int) -> Shapes:
    """Return random shapes whose links end above the floor, the same for all tasks of a seed.

    They keep where they end, which takes a few megabytes; the next task need not ask again.
    """
    shapes = Shapes.sample(robot, _SHAPES, np.random.default_rng([seed, 0]))
    return shapes if floor is None else shapes.take(shapes.end[1][:, 2] > floor)


def shapes_for(task: Task, seed: int) -> Shapes:
    """Return random shapes for a task, each at a random place of the base where that is free."""
    if isinstance(task.places, BaseRange):
        return shapes_at_places(task, task.places, seed)
    return shapes_at_random(task.robot, task.floor_in_base, seed)


def shapes_at_places(task: Task, places: BaseRange, seed: int) -> Shapes:
    """Return random shapes, each with its base at a random place, the link's end above the floor there."""
    rng = np.random.default_rng([seed, 2])
    upright = not places.bounds[:, 3:5].any()
    lowest = 0.0 if upright and isinstance(task.floor, Floor) else None
    shapes = shapes_at_random(task.robot, lowest, seed).at_places(places, rng)
    if not isinstance(task.floor, float):
        return shapes
    return shapes.take(shapes.bases.in_task(shapes.end[1])[:, 2] > task.floor)


def estimated_misses(task: Task, shapes: Shapes) -> FloatArray:
    """Return about how far the workspace of each shape passes by each target; no joint limits.

    In the plane of height z and squared distance N = |P5|^2 a workspace is an ellipse,
    (z, N) = (cz, |c|^2 + R^2) + M (cos theta2, sin theta2). For d = (z, N) of the target less the
    centre, |adj(M) d| - |det M| vanishes on it; divided by the length of its gradient it is the
    distance to first order, and, unlike Gamma, it is so for perfect squares too.

    Args:
        task: The task.
        shapes: The shapes.

    Returns:
        Estimated misses, shape (n, N), m.
    """
    centre, radius = shapes.kinematics.centre, shapes.kinematics.radius
    _, v, t = np.moveaxis(shapes.end[0], -1, 0)
    m00, m01 = -radius * t[:, 2], radius * v[:, 2]
    m10 = -2.0 * radius * np.einsum("ij,ij->i", centre, t)
    m11 = 2.0 * radius * np.einsum("ij,ij->i", centre, v)
    determinant = np.abs(m00 * m11 - m01 * m10)
    squared = np.einsum("ij,ij->i", centre, centre) + radius**2
    misses = np.empty((len(task.targets), len(radius)))
    positions = task.positions_in_base if shapes.places is None else shapes.bases.seen(task.table.positions)
    for row, (x, y, z) in enumerate(np.moveaxis(positions, (-2, -1), (0, 1))):
        height = z - centre[:, 2]
        beyond = x * x + y * y + z * z - squared
        a = m11 * height - m01 * beyond
        b = m00 * beyond - m10 * height
        norm = np.hypot(a, b) + 1e-15
        by_squared = (m00 * b - m01 * a) / norm
        by_height = (m11 * a - m10 * b) / norm + 2.0 * z * by_squared
        by_radius = 2.0 * np.hypot(x, y) * by_squared
        misses[row] = np.abs(norm - determinant) / (np.hypot(by_height, by_radius) + 1e-12)
    return misses


def screened(task: Task, shapes: Shapes) -> FloatArray:
    """Return what shapes cost at first sight, shape (N,), m^2.

    The mean squared misses, estimated and weighted, and the squared distance from the category that the task
    asks for.

    Args:
        task: The task.
        shapes: The shapes, of shape (N,).
    """
    misses = np.minimum(estimated_misses(task, shapes), _FAR)
    offsets = category_offsets(task, shapes)
    return np.asarray(relative_weights(task) @ misses**2 + np.sum(offsets**2, axis=-1))
