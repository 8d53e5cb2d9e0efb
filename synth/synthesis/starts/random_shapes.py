"""Random shapes that the link can take, and what every task asks of them anew."""

from __future__ import annotations

from functools import cached_property, lru_cache
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import frozen_value
from synth.robot import BaseRange
from synth.synthesis.shapes import Shapes, circles_of_designs, circles_of_shapes
from synth.task import Floor

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from scipy.spatial import cKDTree  # type: ignore[import-untyped]

    from synth.arrays import FloatArray
    from synth.robot import Robot
    from synth.task import Task

_SHAPES = 20_000


@frozen_value
class RandomShapes:
    """Random shapes of a robot. What is computed of them is kept: the next task need not ask again.

    Attributes:
        shapes: The shapes, of shape (N,).
    """

    shapes: Shapes

    @cached_property
    def bending(self) -> FloatArray:
        """Bending energies, shape (N,), 1/m."""
        return self.shapes.bending

    @cached_property
    def ellipses(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """The workspaces in the plane of height z and squared distance n = |P5|^2, where they are ellipses.

        (z, n) = (cz, |c|^2 + R^2) + M (cos theta2, sin theta2): the centres, shape (2, N), the matrices M,
        shape (2, 2, N), and their determinants, shape (N,).
        """
        centre, radius = self.shapes.kinematics.centre, self.shapes.kinematics.radius
        _, v, t = np.moveaxis(self.shapes.end[0], -1, 0)
        along_t, along_v = (2.0 * radius * np.einsum("ni,ni->n", centre, each) for each in (t, v))
        matrix = np.array([[-radius * t[:, 2], radius * v[:, 2]], [-along_t, along_v]])
        squared = np.einsum("ni,ni->n", centre, centre) + radius**2
        determinant = matrix[0, 0] * matrix[1, 1] - matrix[0, 1] * matrix[1, 0]
        return np.stack([centre[:, 2], squared]), matrix, determinant

    def nearest_to_arms(self, designs: FloatArray, count: int) -> NDArray[np.intp]:
        """Return which shapes are nearest to designs, `count` for each of the four forms that one may have.

        Args:
            designs: The designs, shape (k, 5), as `Invariants`.
            count: How many shapes for each.
        """
        most = min(count, len(self.shapes.length))
        if not (len(designs) and most):
            return np.empty(0, dtype=np.intp)
        return np.unique(self._circles.query(circles_of_designs(designs), k=range(1, most + 1))[1])

    @cached_property
    def _circles(self) -> cKDTree:
        from scipy.spatial import cKDTree  # noqa: PLC0415 - on use

        return cKDTree(circles_of_shapes(self.shapes.kinematics))


@lru_cache(maxsize=4)
def shapes_at_random(robot: Robot, floor: float | None, seed: int) -> RandomShapes:
    """Return random shapes whose links end above the floor, the same for all tasks of a seed."""
    shapes = Shapes.sample(robot, _SHAPES, np.random.default_rng([seed, 0]))
    return RandomShapes(shapes if floor is None else shapes.take(shapes.end[1][:, 2] > floor))


def shapes_for(task: Task, seed: int) -> RandomShapes:
    """Return random shapes for a task, each at a random place of the base where that is free."""
    if isinstance(task.places, BaseRange):
        return RandomShapes(_shapes_at_places(task, task.places, seed))
    return shapes_at_random(task.robot, task.floor_in_base, seed)


def _shapes_at_places(task: Task, places: BaseRange, seed: int) -> Shapes:
    """Return random shapes, each with its base at a random place, the link's end above the floor there."""
    rng = np.random.default_rng([seed, 2])
    upright = not places.bounds[:, 3:5].any()
    lowest = 0.0 if upright and isinstance(task.floor, Floor) else None
    shapes = shapes_at_random(task.robot, lowest, seed).shapes.at_places(places, rng)
    if not isinstance(task.floor, float):
        return shapes
    return shapes.take(shapes.bases.in_task(shapes.end[1])[:, 2] > task.floor)
