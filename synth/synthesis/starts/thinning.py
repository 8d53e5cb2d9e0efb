"""A part of many targets that tells where to look as well as all of them."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.task import Task


_LOOKED_AT = 200_000


def thinned(task: Task, count: int, rng: np.random.Generator) -> Task:
    """Return a task with a part of its targets, or the task itself if they are few.

    Half of the part is spread as far apart as possible, because only outlying targets show where joint 1 must
    not have its dead zone; the other half is random, because the outlying ones of a scan are its outliers.

    Args:
        task: The task.
        count: How many targets to keep.
        rng: Source of randomness.
    """
    if count >= len(task.targets):
        return task
    if len(task.targets) > _LOOKED_AT:  # of a million, as many as tell where their ends are
        some = np.sort(rng.choice(len(task.targets), _LOOKED_AT, replace=False))
        task = replace(task, targets=task.table.take(some))
    spread = _spread(task.positions_in_base, count // 2, int(rng.integers(len(task.targets))))
    others = np.setdiff1d(np.arange(len(task.targets)), spread)
    chosen = np.union1d(spread, rng.choice(others, count - len(spread), replace=False))
    return replace(task, targets=task.table.take(chosen))


def _spread(points: FloatArray, count: int, first: int) -> NDArray[np.intp]:
    """Return indices of points, shape (n, 3), each as far as can be from those before."""
    chosen = [first]
    nearest = np.full(len(points), np.inf)
    for _ in range(count - 1):
        nearest = np.minimum(nearest, np.sum((points - points[chosen[-1]]) ** 2, axis=1))
        chosen.append(int(np.argmax(nearest)))
    return np.unique(chosen)
