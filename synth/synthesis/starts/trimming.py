"""What of a surface to cover, where a part of it may be left: found with the shape, not before it.

Least squares over outliers, or over what joint limits make impossible, lead to a shape that covers nothing
well. So each shape is judged, and led, by the share of the samples that it misses least (least trimmed
squares, Rousseeuw 1984; that it chooses these anew after each step is the concentration step of Rousseeuw
and Van Driessen 2006). What is covered best by the best shape is then a task of its own.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from synth.synthesis.check import counted, verify_targets
from synth.synthesis.starts.exact_arms import met_by_one
from synth.synthesis.starts.random_shapes import shapes_for
from synth.synthesis.starts.refined import Trimmed
from synth.synthesis.starts.refinement import refine
from synth.synthesis.starts.screening import estimated_misses
from synth.synthesis.starts.turned_arms import SAMPLE, as_it_is_and_turned, random_part
from synth.task import Objective

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.robot import Arm
    from synth.synthesis.shapes import Shapes
    from synth.synthesis.starts.refined import Refined
    from synth.task import Task
    from synth.watch import Watch

# Samples that shapes are led to at first, and then; shapes that are led, half of them the best, half drawn
# from so many of the best; of these so many go on, and so many are led to the larger part.
_FEW, _MORE = 60, 300
_LED, _GOOD = 200, 4_000
_GO_ON, _BEST = 24, 4
_STEPS, _STEPS_ON = 16, 10
_FAR = 0.3  # m; misses are compared up to here
_ANEW = 3  # rounds, until what is covered best stays the same


def covered_part(task: Task, seed: int, watch: Watch) -> Task | None:
    """Return a task of what some shape covers best of each surface; None if no random shape respects limits.

    Args:
        task: The task, a part of whose surfaces may be left uncovered.
        seed: Seed of the random shapes and samples.
        watch: When it is up every step ends with what there is.
    """
    task = _above_floor(replace(task, objective=Objective.LEAST_SQUARES))
    many = random_part(task, SAMPLE, seed)
    met = met_by_one(many)
    if _is_enough(many, met):  # outliers are near no arm, or far fewer are
        return many.asking_for(many.table.take(np.flatnonzero(met)))
    few = random_part(task, _FEW, seed)
    shapes = _promising(few, seed)
    if not len(shapes.length):
        return None
    refined = refine(few, shapes, iterations=_STEPS, is_up=watch.is_up).best(_GO_ON)
    more = random_part(task, _MORE, seed)
    refined = _led_on(more, refined, watch).best(_BEST)
    refined = _led_on(many, refined, watch)
    best = refined.best(1)
    arm = best.shapes.arm(0, task.base)
    candidates = as_it_is_and_turned(most_covered(many, arm), arm, watch) if task.places is None else [arm]
    return most_covered(task, min(candidates, key=lambda one: trimmed_cost(many, one)))


def _above_floor(task: Task) -> Task:
    """Return the task without samples below the floor that may be left; more of the others is asked for."""
    of, partial = task.surface_of_targets, [surface.coverage < 1.0 for surface in task.surfaces]
    height = task.floor_height
    if height is None or task.places is not None:
        return task
    sunk = (of >= 0) & np.array(partial)[of] & (task.table.positions[:, 2] < height - task.tolerances)
    left = [np.count_nonzero((of == n) & ~sunk) / np.count_nonzero(of == n) for n in range(len(partial))]
    if not sunk.any() or any(
        share < surface.coverage for share, surface in zip(left, task.surfaces, strict=True)
    ):
        return task
    surfaces = tuple(
        replace(surface, coverage=min(surface.coverage / share, 1.0))
        for surface, share in zip(task.surfaces, left, strict=True)
    )
    return replace(task, targets=task.table.take(np.flatnonzero(~sunk)), surfaces=surfaces)


def _is_enough(task: Task, met: NDArray[np.bool_]) -> bool:
    """Whether those targets are met that must be, and of each surface as large a share as is asked for."""
    of = task.surface_of_targets
    return bool(met[of < 0].all()) and all(
        np.count_nonzero(met & (of == number)) >= surface.coverage * np.count_nonzero(of == number)
        for number, surface in enumerate(task.surfaces)
    )


def _promising(task: Task, seed: int) -> Shapes:
    """Return random shapes that come near enough of the samples."""
    random = shapes_for(task, seed)
    shapes = random.shapes
    if not len(shapes.length):
        return shapes
    rng = np.random.default_rng([seed, 11])
    squared = np.minimum(estimated_misses(task, random), _FAR).T ** 2
    order = np.argsort(Trimmed(task).mean(squared), kind="stable")
    half = _LED // 2
    drawn = rng.choice(order[:_GOOD], min(half, len(order)), replace=False)
    return shapes.take(np.union1d(order[:half], drawn))


def _led_on(task: Task, refined: Refined, watch: Watch) -> Refined:
    return refine(task, refined.shapes, iterations=_STEPS_ON, near=True, is_up=watch.is_up)


def most_covered(task: Task, arm: Arm, in_the_way: NDArray[np.bool_] | None = None) -> Task:
    """Return a task of what an arm covers best of each surface, as much as is asked for, in targets alone.

    Args:
        task: The task.
        arm: The robot in a shape.
        in_the_way: At which targets it cannot stand, shape (n,); by default that is looked at.
    """
    if in_the_way is None:
        check = verify_targets(task, arm)
        misses, in_the_way = check.misses, ~np.array(check.within_tolerance)
    else:
        misses = arm.closest_joints(task.table.positions)[1]
    chosen = np.flatnonzero(counted(task, np.where(in_the_way, misses + task.tolerances, misses)))
    return task.asking_for(task.table.take(chosen))


def trimmed_cost(task: Task, arm: Arm) -> float:
    """Return the mean squared miss of what an arm covers best, m^2."""
    misses = arm.closest_joints(task.table.positions)[1]
    return float(np.mean(misses[counted(task, misses)] ** 2))
