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

from synth.synthesis.search import Search
from synth.synthesis.shapes import Shapes
from synth.synthesis.starts import (
    SAMPLE,
    Refined,
    as_it_is_and_turned,
    covered_part,
    level,
    most_covered,
    random_part,
    relative_misses,
    thinned,
)
from synth.synthesis.wanted import best_of
from synth.task import Objective, PointTarget, TargetTable
from synth.watch import Watch

if TYPE_CHECKING:
    from collections.abc import Sequence

    from synth.arrays import FloatArray
    from synth.robot import Arm
    from synth.synthesis.wanted import Design
    from synth.task import Task

# That the nonlinear program knows all at once.
_MOST_TARGETS = {Objective.LEAST_SQUARES: 100, Objective.MINIMAX: 40}
_PART = 40  # of more targets, those that it knows at first
_LEVELLINGS = 3
_ON_THE_WAY = (0.25, 0.5, 0.75, 1.0)  # from the least sum of squares to the least worst miss
_BETWEEN, _STARTS_BETWEEN = 20, 6  # points that join the targets of a search; starts polished then


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
    part = thinned(task, _PART, np.random.default_rng([seed, _PART]))
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


def ranked(task: Task, arms: Sequence[Arm], seed: int, watch: Watch) -> list[Arm]:
    """Return arms that were found for a part of the targets, best for a larger part first.

    A part may say nothing of where the dead zone of joint 1 should be. So where an arm misses targets, one
    that is turned about axis 1 stands beside it.

    Args:
        task: The task with all its targets.
        arms: The arms in shapes of equal arcs, the best for the part first.
        seed: The same larger part for the same seed.
        watch: When it is up, the other arms are left out.
    """
    some = random_part(task, SAMPLE, seed)
    missing: list[tuple[float, Arm]] = []
    reaching: list[Arm] = []
    for arm in arms:
        if (reaching or missing) and watch.is_up():
            break
        watch.tell(phase="looking at more targets")
        seen = most_covered(some, arm) if some.is_partial else some
        for candidate in as_it_is_and_turned(seen, arm, watch):
            relative = relative_misses(seen, candidate)
            if np.all(relative <= np.sqrt(seen.weights)):
                reaching.append(candidate)
            else:
                missing.append((float(np.mean(relative**2)), candidate))
    return [*reaching, *(arm for _, arm in sorted(missing, key=lambda pair: pair[0]))]


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
    if np.mean(relative_misses(task, arm) ** 2) > np.mean(task.weights):  # as for `may_be_met`
        return arm
    by_worst = task.by_worst_miss
    if relative_misses(by_worst, arm).max() <= 1.0:
        return arm
    squares = Shapes.of(arm)
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


def led_to(
    part: Task, designs: Sequence[Design], points: FloatArray, seed: int, watch: Watch
) -> tuple[Task, list[Design]]:
    """Return the part with points that shapes miss, or of which nothing is proven, and shapes led there, too.

    Mostly a shape that covers all samples ends short of a surface's edge: there joint 1 has its dead zone.
    Without points other shapes are looked for.

    Args:
        part: The task of few targets that the shapes were found for.
        designs: The shapes.
        points: The points in the task frame, shape (k, 3), m: of very many, some.
        seed: Seed of the random shapes.
        watch: Its time.
    """
    if not len(points):
        search = Search(part, seed + 1, watch, lambda: False)
        search.run(_STARTS_BETWEEN)
        return part, list(best_of(part, search.polishing.designs, watch.is_up))
    some = points[np.random.default_rng([seed, 15]).permutation(len(points))[:_BETWEEN]]
    first = len(part.targets)
    more = [
        PointTarget(f"between the samples {first + number}", point, float(part.tolerances.min()))
        for number, point in enumerate(some, start=1)
    ]
    task = part.asking_for(part.table.followed_by(TargetTable.of(more)))
    search = Search(task, seed, watch, lambda: False, alternatives=0)
    if not search.follow(designs):
        search.run(_STARTS_BETWEEN)
    return task, list(best_of(task, search.polishing.designs, watch.is_up))
