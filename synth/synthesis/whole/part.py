"""What of very many targets is searched with, and what must be reached of all.

A surface has five numbers, so forty targets determine it nearly as well as a hundred thousand: the
search runs on a part, at the same cost for any number of targets. What it finds is improved by steps that
see every target, each a system of nine or eleven equations however many targets there are, and verified
with every target.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from synth.synthesis.starts import covered_part, thinned
from synth.task import Objective
from synth.watch import Watch

if TYPE_CHECKING:
    from synth.task import Task

# That the nonlinear program knows all at once.
_MOST_TARGETS = {Objective.LEAST_SQUARES: 100, Objective.MINIMAX: 40}
PART = 40  # of more targets, those that it knows at first


def part_of(task: Task, seed: int, watch: Watch | None = None) -> Task:
    """Return the task with a random part of its targets, or the task itself if they are few.

    Where a part of a surface may be left uncovered, the targets are of what can be covered best.

    Args:
        task: The task.
        seed: The same part for the same seed.
        watch: When it is up, what can be covered best is known only as far as the search for it came.
    """
    if task.is_partial:
        covered = covered_part(task, seed, watch or Watch())
        task = covered or task.asking_for(task.table)
    if len(task.targets) <= _MOST_TARGETS[task.objective]:
        return task
    # The worst miss of a part says little of the worst of all, and takes the program ten times as long.
    part = thinned(task, PART, np.random.default_rng([seed, PART]))
    return replace(part, objective=Objective.LEAST_SQUARES)


def without_partial(task: Task) -> Task | None:
    """Return a task of the targets that each must be reached: of no surface that may be left in part."""
    if not task.is_partial:
        return task
    partial = [number for number, surface in enumerate(task.surfaces) if surface.coverage < 1.0]
    must = np.flatnonzero(~np.isin(task.surface_of_targets, partial))
    if not len(must):
        return None
    return task.asking_for(task.table.take(must))
