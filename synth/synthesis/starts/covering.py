"""A shape that covers as much of a surface as is asked for, where a part of it may be left.

Concentration steps (see `trimming`) end where a few outliers that lie near the surface are among what is
covered best, and draw the shape aside. Steps on the better half alone leave them behind.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from synth.synthesis.check import verify_targets
from synth.synthesis.starts.trimming import most_covered
from synth.synthesis.starts.turned_arms import refined_for_all

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.robot import Arm
    from synth.task import Task
    from synth.watch import Watch

_CHOSEN_ANEW = 8  # times that what is covered best of a surface is chosen
_SHARES = (0.5, 0.5, 0.5, 0.6, 0.75, 0.9)  # of what is covered best: two outliers of 480 hold an arm else
_REWEIGHTED = 6  # times that outliers near the surface are left out
_USUAL = 3.5  # times the median miss: of normal noise two in a hundred are missed more
_ROUNDING = 1e-8  # m


def best_covering(task: Task, arm: Arm, watch: Watch) -> Arm:
    """Return an arm after steps on what it covers best, freed of the few outliers that may hold it.

    Args:
        task: The task, a part of whose surfaces may be left uncovered.
        arm: The robot in a shape.
        watch: When it is up, no more steps are taken.
    """
    check = verify_targets(task, arm)
    in_the_way = ~np.array(check.within_tolerance) & (check.misses <= task.tolerances)
    arm, covered = _settled(task, arm, in_the_way, watch)
    if np.any(_misses(covered, arm) > covered.tolerances):
        freed = arm
        for share in _SHARES:
            misses = _misses(covered, freed)
            best = np.flatnonzero(misses <= np.quantile(misses, share))
            freed = refined_for_all(replace(covered, targets=covered.table.take(best)), freed, watch)
        freed, others = _settled(task, freed, in_the_way, watch)
        if np.sum(_misses(others, freed) ** 2) < np.sum(_misses(covered, arm) ** 2):
            arm, covered = freed, others
    return _without_outliers(covered, arm, watch)


def _settled(task: Task, arm: Arm, in_the_way: NDArray[np.bool_], watch: Watch) -> tuple[Arm, Task]:
    """Return an arm after steps on what it covers best, which is chosen anew until it stays the same."""
    covered = most_covered(task, arm, in_the_way)
    for _ in range(_CHOSEN_ANEW):
        if watch.is_up():
            break
        arm, before = refined_for_all(covered, arm, watch), covered
        covered = most_covered(task, arm, in_the_way)
        if covered.table.names == before.table.names:
            break
    return arm, covered


def _misses(task: Task, arm: Arm) -> FloatArray:
    return arm.closest_joints(task.table.positions)[1]


def _without_outliers(task: Task, arm: Arm, watch: Watch) -> Arm:
    """Return an arm after steps on what it misses no more than others, if all is within tolerance still.

    Outliers that happen to lie near the surface are of what is covered best, and draw it aside a little.
    """
    better = arm
    for _ in range(_REWEIGHTED):
        misses = _misses(task, better)
        if watch.is_up() or np.any(misses > task.tolerances):
            break
        arm = better
        usual = np.flatnonzero(misses <= _USUAL * float(np.median(misses)) + _ROUNDING)
        better = refined_for_all(replace(task, targets=task.table.take(usual)), arm, watch)
    return arm
