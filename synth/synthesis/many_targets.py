"""Tasks of very many targets: a part of them tells where to look, all of them decide.

A surface has five numbers, so forty targets determine it nearly as well as a hundred thousand: the
search runs on a part, at the same cost for any number of targets. What it finds is improved by steps that
see every target, each a system of nine or eleven equations however many targets there are, and verified
with every target.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from synth.robot import into_turn
from synth.synthesis.population import Population
from synth.synthesis.refinement import refine
from synth.task import Objective

if TYPE_CHECKING:
    from synth.arrays import FloatArray
    from synth.robot import Arm
    from synth.synthesis.nlp import SynthesisNlp
    from synth.task import Task

# That the nonlinear program knows all at once; with the worst miss it takes ten times as long.
_MOST_TARGETS = {Objective.LEAST_SQUARES: 100, Objective.MINIMAX: 40}
_PART = 40  # of more targets, those that it knows
# Steps with a larger part, and then with all.
_SAMPLE, _STEPS, _STEPS_WITH_ALL = 2000, 8, 2
# For the worst miss, the worst targets are exchanged for others of the part: so many, and so often.
_EXCHANGED, _EXCHANGES = 15, 5


def part_of(task: Task, seed: int) -> Task:
    """Return the task with a random part of its targets, or the task itself if they are few.

    Args:
        task: The task.
        seed: The same part for the same seed.
    """
    few = len(task.targets) <= _MOST_TARGETS[task.objective]
    return task if few else _random_part(task, _PART, seed)


def _random_part(task: Task, count: int, seed: int) -> Task:
    if count >= len(task.targets):
        return task
    chosen = np.random.default_rng([seed, count]).choice(len(task.targets), count, replace=False)
    return replace(task, targets=task.table.take(np.sort(chosen)))


def improved(task: Task, arm: Arm) -> Arm:
    """Return an arm after Gauss-Newton steps on all targets, for the sum of their squared misses.

    The steps know the limits of the link and of the joints, but neither floor nor obstacles.

    Args:
        task: The task with all its targets.
        arm: The robot in a shape of equal arcs, near the best for a part of the targets.
    """
    for count, steps in ((_SAMPLE, _STEPS), (len(task.targets), _STEPS_WITH_ALL)):
        some = _random_part(task, count, 0)
        refined = refine(some, Population.of(arm), _nearest_theta2(some, arm)[None], iterations=steps)
        arm = refined.population.arm(0, task.base)
    return arm


def exchanged(task: Task, part: Task, nlp: SynthesisNlp, arm: Arm) -> Arm:
    """Return an arm whose worst miss over all targets is least, or nearly, by Remez' exchange.

    The program knows some of the targets. Those that its answer misses most take the places of those of
    its own that it misses least, and it is solved again.

    Args:
        task: The task with all its targets.
        part: The task with some of them.
        nlp: The program of the part.
        arm: The robot in a shape that is best for the part.
    """
    best, least = arm, np.inf
    for _ in range(_EXCHANGES):
        relative = _relative_misses(task, arm)
        if relative.max() >= least:
            break
        best, least = arm, relative.max()
        worst = np.argsort(-relative, kind="stable")[:_EXCHANGED]
        known = np.argsort(-_relative_misses(part, arm), kind="stable")[:-_EXCHANGED]
        part = replace(part, targets=task.table.take(worst).followed_by(part.table.take(known)))
        arm = nlp.solve(part, arm, arm.closest_joints(part.table.positions)[0]).arm
    return best


def _relative_misses(task: Task, arm: Arm) -> FloatArray:
    return np.asarray(np.sqrt(task.weights) * arm.closest_joints(task.table.positions)[1] / task.tolerances)


def _nearest_theta2(task: Task, arm: Arm) -> FloatArray:
    """Return the better branch of joint 2 for each target, moved into its limits, shape (n,), rad."""
    limits, kinematics = task.robot.joint_limits, arm.kinematics
    both = into_turn(kinematics.branches(task.positions)[..., 1], limits.second.middle)
    both = np.clip(both, limits.second.lower, limits.second.upper)
    misses = kinematics.each_target().miss(both, task.positions[:, None], limits.base)
    return np.asarray(np.take_along_axis(both, np.argmin(misses, axis=-1)[:, None], axis=-1)[:, 0])
