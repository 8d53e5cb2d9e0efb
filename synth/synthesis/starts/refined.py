"""Shapes at the bottoms of their valleys."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import frozen_value
from synth.synthesis.shapes import Shapes

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.task import Task


@frozen_value
class Refined:
    """Shapes at the bottoms of their valleys, or nearly.

    Attributes:
        shapes: The shapes, of shape (N,).
        joints: Their joint angles for each target, shape (N, n, 2), rad.
        cost: Their mean squared misses, weighted with `relative_weights`, shape (N,), m^2; where the worst
            miss counts, nearly that one squared, and not above it where the valley ends.
    """

    shapes: Shapes
    joints: FloatArray
    cost: FloatArray

    @classmethod
    def joined(cls, parts: list[Refined]) -> Refined:
        """Return the shapes of all parts, in order."""
        joints = np.concatenate([part.joints for part in parts])
        cost = np.concatenate([part.cost for part in parts])
        return cls(Shapes.joined([part.shapes for part in parts]), joints, cost)

    def take(self, chosen: NDArray[np.intp]) -> Refined:
        """Return some of the shapes."""
        return Refined(self.shapes.take(chosen), self.joints[chosen], self.cost[chosen])

    def best(self, count: int) -> Refined:
        """Return the best shapes in order, `count` at most."""
        return self.take(np.argsort(self.cost, kind="stable")[:count])


def relative_weights(task: Task) -> FloatArray:
    """Return each target's factor of its squared miss, shape (n,); the tightest has about 1 / n."""
    weights = task.weights * (task.tolerances.min() / task.tolerances) ** 2
    return np.asarray(weights / len(weights))
