"""Arms from algebra: those through all targets, where these fix finitely many, and those near all of many."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from synth.geometry import Invariants, arms_near, arms_through_five, arms_through_four, is_generic
from synth.synthesis.starts.refined import relative_weights

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.task import Task

_SETS = 10  # of as few targets as fix an arm, among whose arms is one through all targets, if there is one
_SHARPLY = 0.1  # of a tolerance: so near is a target that an arm passes through, but for rounding and scans
_THROUGH = 6  # of these arms, at most: so many may pass through as few targets
_SETS_OF_MANY, _NEAR = 60, 40  # sets where no arm passes through all; arms near all that are looked at


def exact_arms(task: Task) -> tuple[Invariants, ...] | None:
    """Return all arms whose workspace passes exactly through the targets, whatever the link can do.

    Args:
        task: The task.

    Returns:
        The designs, none if there is no real one; None where the question has no finite answer: it takes
        four targets with the rigid link given, or five with a free one, in general position.
    """
    positions, needed, radius = task.positions_in_base, *_minimal(task)
    if len(positions) != needed or not is_generic(positions) or radius == 0.0:
        return None
    return (arms_through_five(positions) if radius is None else arms_through_four(positions, radius)).of()


def arms_through_all(task: Task) -> FloatArray:
    """Return arms that pass through all targets within their tolerances, shape (k, 5), as `Invariants`.

    None where the targets are too few to fix finitely many, or the base is free.
    """
    near = _arms_near(task, _SETS, 0)
    if near is None:
        return np.empty((0, 5))
    values, costs = near
    return values[:_THROUGH][costs[:_THROUGH] <= float(task.tolerances.min()) ** 2]


def arms_near_all(task: Task) -> FloatArray:
    """Return arms that pass near all targets, nearest first, shape (k, 5), as `Invariants`; none as above."""
    near = _arms_near(task, _SETS_OF_MANY, 15)
    return np.empty((0, 5)) if near is None else near[0][:_NEAR]


def met_by_one(task: Task) -> NDArray[np.bool_]:
    """Return which targets the arm that is near most of them is near, shape (n,); none where there is none.

    Near is well within the tolerance, where noise does not blur what is an outlier; the arms are those
    through sets of as few targets as fix one.
    """
    near = _arms_near(task, _SETS_OF_MANY, 0)
    if near is None or not len(near[0]):
        return np.zeros(len(task.targets), dtype=np.bool_)
    positions = task.positions_in_base
    misses = np.array([Invariants(*row).circle().distance(positions) for row in near[0].tolist()])
    met = misses <= _SHARPLY * task.tolerances
    return np.asarray(met[np.argmax(met.sum(axis=1))])


def _minimal(task: Task) -> tuple[int, float | None]:
    """Return how many targets fix an arm, and the radius of P5's circle if the rigid link is given, m."""
    rigid = task.robot.rigid_link
    if not rigid.is_fixed:
        return 5, None
    return 4, float(task.robot.end_effector_circle(rigid.d35.lower, rigid.d45.lower)[1])


def _arms_near(task: Task, sets: int, steps: int) -> tuple[FloatArray, FloatArray] | None:
    needed, radius = _minimal(task)
    if task.places is not None or len(task.targets) < needed or radius == 0.0:
        return None
    weights = relative_weights(task)
    return arms_near(task.positions_in_base, radius, weights=weights / weights.sum(), sets=sets, steps=steps)
