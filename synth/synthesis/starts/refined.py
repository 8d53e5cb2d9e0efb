"""Shapes at the bottoms of their valleys."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import frozen_value
from synth.synthesis.shapes import Shapes, overlaps

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.task import Task
    from synth.watch import Watch

_EXACT = 2e-3  # of the tightest tolerance: a miss below meets a target


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

    def take(self, chosen: NDArray[np.intp] | NDArray[np.bool_]) -> Refined:
        """Return some of the shapes."""
        return Refined(self.shapes.take(chosen), self.joints[chosen], self.cost[chosen])

    def best(self, count: int) -> Refined:
        """Return the best shapes in order, `count` at most."""
        return self.take(np.argsort(self.cost, kind="stable")[:count])


def relative_weights(task: Task) -> FloatArray:
    """Return each target's factor of its squared miss, shape (n,); the tightest has about 1 / n."""
    weights = task.weights * (task.tolerances.min() / task.tolerances) ** 2
    return np.asarray(weights / len(weights))


def meets_all(task: Task, refined: Refined) -> NDArray[np.bool_]:
    """Return which shapes meet all targets, as exactly as anybody asks for, shape (N,)."""
    return refined.cost < (_EXACT * float(task.tolerances.min())) ** 2


def weighed(task: Task, refined: Refined, watch: Watch) -> Refined:
    """Return shapes whose costs say, too, how deep they are inside obstacles or themselves, m^2."""
    depth = overlaps(task, refined.shapes, refined.joints, is_up=watch.is_up)
    return replace(refined, cost=refined.cost + np.mean(depth**2, axis=-1))


class Trimmed:
    """Means over the targets that count: of a surface of which a part may be left, those missed least.

    Args:
        task: The task.
    """

    def __init__(self, task: Task) -> None:
        self._weights = relative_weights(task)
        of = task.surface_of_targets
        parts = [
            (np.flatnonzero(of == number), surface.coverage)
            for number, surface in enumerate(task.surfaces)
            if surface.coverage < 1.0
        ]
        self._parts = [(chosen, max(1, int(share * len(chosen)))) for chosen, share in parts if len(chosen)]

    def weights(self, squared: FloatArray) -> FloatArray:
        """Return the factors of squared misses, shape (N, n), of the targets that count; 0 of the others."""
        weights = np.broadcast_to(self._weights, squared.shape)
        if not self._parts:
            return weights
        weights = weights.copy()
        for chosen, count in self._parts:
            of_it = squared[:, chosen]
            left = of_it > np.partition(of_it, count - 1, axis=1)[:, count - 1 : count]
            weights[:, chosen] = np.where(left, 0.0, weights[:, chosen])
        return weights

    def shares(self, squared: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the means, shape (N,), and the factors of the squared misses, shape (N, n)."""
        weights = self.weights(squared)
        if not self._parts:
            return squared @ self._weights, weights
        return np.asarray(np.einsum("Nn,Nn->N", squared, weights)), weights

    def mean(self, squared: FloatArray) -> FloatArray:
        """Return the weighted means of squared misses, shape (N, n), over what counts, shape (N,)."""
        return self.shares(squared)[0]
