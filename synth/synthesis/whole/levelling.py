"""From the least sum of squares of all targets to less of the worst miss."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from synth.synthesis.shapes import Shapes
from synth.synthesis.starts import SAMPLE, Refined, level, random_part, relative_misses

if TYPE_CHECKING:
    from synth.robot import Arm
    from synth.task import Task
    from synth.watch import Watch

_LEVELLINGS = 3
_ON_THE_WAY = (0.25, 0.5, 0.75, 1.0)  # from the least sum of squares to the least worst miss


def least_worst(task: Task, arm: Arm, watch: Watch) -> Arm:
    """Return an arm whose worst miss over all targets is less.

    Those missed most of all, up to the size of the larger part, stand for all; once the arm has moved others
    may be among them, so they are taken anew.

    Args:
        task: The task with all its targets.
        arm: The robot in a shape near the best, of equal arcs.
        watch: When it is up, no more steps are taken.
    """
    began = watch.elapsed
    relative_misses(random_part(task, SAMPLE, 0), arm)
    look = (watch.elapsed - began) * len(task.targets) / SAMPLE  # s, at all targets, with room
    if watch.remaining < 3.0 * look:
        return arm
    least = relative_misses(task, arm)
    for _ in range(_LEVELLINGS):
        # Each time, and for their verification, all targets are looked at.
        if watch.is_up() or watch.remaining < 3.0 * look:
            break
        watch.tell(phase="levelling the misses")
        worst = task.table.take(np.sort(np.argsort(-least, kind="stable")[:SAMPLE]))
        joints, _misses = arm.closest_joints(worst.positions)
        some = replace(task, targets=worst)
        start = Refined(Shapes.of(arm), joints[None], np.zeros(1))
        lower = level(some, start, watch.is_up).shapes.arm(0, task.base)
        misses = relative_misses(task, lower)
        if misses.max() >= least.max():
            break
        arm, least = lower, misses
    return arm


def within_tolerances(task: Task, arm: Arm, before: Arm, watch: Watch) -> Arm:
    """Return an arm nearby that misses no target by more than its tolerance, or else the arm itself.

    Args:
        task: The task with all its targets.
        arm: The robot in the shape of the least sum of squares, of equal arcs.
        before: The same as it was found for a part of the targets: maybe in another valley of the worst miss.
        watch: As for `least_worst`.
    """
    by_worst, squares = task.by_worst_miss, Shapes.of(arm)
    for start in (arm, before):
        worst = Shapes.of(least_worst(by_worst, start, watch))
        for share in _ON_THE_WAY:
            unknowns = squares.unknowns + share * (worst.unknowns - squares.unknowns)
            between = replace(squares, unknowns=unknowns).arm(0, task.base)
            if relative_misses(by_worst, between).max() <= 1.0:
                return between
            if watch.is_up():
                return arm
    return arm
