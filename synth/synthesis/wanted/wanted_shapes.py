"""Shapes that a person would want, once it is known that the targets can be reached.

The search for a first shape asks for the misses alone, so its answers lean on the limits, and joints swing
where they please. Here many random shapes of a robot whose limits are drawn in by the margins are led to the
targets, all at once; what lies within the tolerances has margins. By their figures, which are as cheap, the
best are chosen, bent a little at random, led back to the targets, and chosen again.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from synth.robot import Interval
from synth.synthesis.shapes import Postures, Shapes, TargetsSeen
from synth.synthesis.starts import (
    EXACT,
    RandomShapes,
    Refined,
    arms_through_all,
    estimated_misses,
    refine,
    relative_weights,
)
from synth.synthesis.wanted.margins import drawn_in
from synth.synthesis.wanted.pool import Pool, swings_of
from synth.synthesis.wanted.ranking import CALM, STEPS
from synth.task import Objective
from synth.watch import never

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from synth.arrays import FloatArray
    from synth.robot import Arm, Robot
    from synth.task import Task

_SHAPES = 5_000  # at random
_LED = 60  # of these, led to the targets: half the best, half the calmest of some of the good ones
_GOOD = 500  # best ones, from which those are drawn
_ASKED = 200  # of the good ones, whose calm is looked at
# Where joint 2 is kept in a part of its range as wide as a calm swing:
_LED_CALMER = 300  # shapes that are led there
_ITERATIONS_CALMER = 30
_PARTS = (0.25, 0.75, 0.5, 0.0, 1.0)  # where it lies, 0 at the beginning of the range, 1 at its end
_FEW_TARGETS = 8  # that are moved to one after the other
_FROM_KNOWN = 20  # bent ones of those that are known
_PER_ARM = 3  # shapes looked at near each form of an arm through all targets, where there are any
_FAR = 0.3  # m; misses are compared up to here
_ITERATIONS = 12  # of random shapes
_ITERATIONS_AGAIN = 6  # of bent ones, which are near already
_ROUNDS = 24  # of bending, at most
_BENT = 10  # shapes that are bent, the best
_VARIED = 50  # shapes that come of them
_SIZES = (0.03, 0.1, 0.3, 0.6)  # of the bends, in units of the largest curvature
_LENGTHS = 0.05  # m for a bend of that size, by which lengths change
_PATIENCE = 3  # rounds that gain next to nothing, after which there is no other
_COUNTS = 5  # first columns of `preferences`, in which that is asked
_BESIDE = 0.7  # of the tolerances, by which bent shapes are led beside the targets: else these were of no use
_TIGHT = 1e-3  # m; targets of smaller tolerances are met exactly: nothing is gained by using those up
_WELL_WITHIN, _MOST = 0.1, 0.7  # of the tolerances, in the mean; share of the shapes
_EXACTLY = 0.02  # of its tolerance a miss may take where targets are met exactly


def wished(
    task: Task, known: Sequence[Arm], seed: int, stop: Callable[[], bool] = never
) -> Iterator[tuple[Arm, FloatArray]]:
    """Yield distinct shapes off their limits that come within the tolerances, the most wanted first.

    Nothing here is certain: each is to be verified. If the tolerances leave no room for all margins, those of
    the joints are looked for, and then those of the link.

    Args:
        task: The task.
        known: Shapes of equal arcs that reach the targets already.
        seed: Seed of the random shapes.
        stop: Polled after each step; return True to end the search.

    Yields:
        The robot in the shape, and the joint angles at each target, shape (n, 2), rad.
    """
    for joints, link in ((True, True), (True, False), (False, True)):
        narrow = drawn_in(replace(task, objective=Objective.LEAST_SQUARES), joints=joints, link=link)
        pool = _searched(task, narrow, known, np.random.default_rng([seed, 5]), stop)
        if stop():
            return
        for index in pool.distinct():
            yield replace(pool.shapes.arm(index, task.base), robot=task.robot), pool.joints[index]
        if len(pool.table):
            return


def _searched(
    task: Task, narrow: Task, known: Sequence[Arm], rng: np.random.Generator, stop: Callable[[], bool]
) -> Pool:
    """Return the shapes that are wanted most, with limits drawn in.

    While all shapes leave ways, margins or calm to wish for, all is begun anew with joint 2 kept in a part of
    its range, where no swing can be large: calm shapes are too rare to be met by chance. Where joint 1 has to
    swing in all shapes seen, none can be calm.
    """
    pool = _bred(task, narrow, known, _LED, _ITERATIONS, rng, stop)
    for calmer in _calmer(narrow):
        if stop() or not len(pool.table) or pool.is_content or pool.must_swing:
            break
        pool = pool.joined(_bred(task, calmer, (), _LED_CALMER, _ITERATIONS_CALMER, rng, stop))
    if _is_tight(task) and len(pool.table):
        chosen = pool.shapes.take(pool.distinct()[:_BENT])
        led = refine(narrow, chosen, iterations=_ITERATIONS_AGAIN, is_up=stop)
        pool = Pool.of(task, narrow, led.shapes, stop, _EXACTLY)
    return pool


def _is_tight(task: Task) -> bool:
    """Whether nothing is gained by using up the tolerances, so that targets are met exactly."""
    return float(task.tolerances.min()) < _TIGHT


def _calmer(task: Task) -> Iterator[Task]:
    """Yield the same with joint 2 kept in one part of its range after another, and twice as it is.

    None where the nearest to the present shape is wanted, where targets are met exactly, nor for many of
    them: a scan has no order.
    """
    if task.current is not None or _is_tight(task) or len(task.targets) > _FEW_TARGETS:
        return
    limits = task.robot.joint_limits
    spare = max(limits.second.upper - limits.second.lower - CALM, 0.0)
    for part in _PARTS:
        lower = limits.second.lower + part * spare
        second = Interval(lower, min(lower + CALM, limits.second.upper))
        yield replace(task, robot=replace(task.robot, joint_limits=replace(limits, second=second)))
    yield from (task, task)


def _bred(
    task: Task,
    narrow: Task,
    known: Sequence[Arm],
    led: int,
    iterations: int,
    rng: np.random.Generator,
    stop: Callable[[], bool],
) -> Pool:
    """Return the shapes that are wanted most of some random ones and of what bending makes of them."""
    arms = arms_through_all(narrow)
    beginnings = _promising(narrow, arms, led, rng)
    if known:
        shapes = Shapes(narrow.robot, Shapes.joined([Shapes.of(arm) for arm in known]).unknowns)
        beginnings = Shapes.joined([beginnings, _varied(shapes, _FROM_KNOWN, rng)])
    # Where targets need not be met exactly, nothing is gained by steps once most shapes are well within.
    met = EXACT if _is_tight(task) else (_WELL_WITHIN * float(task.tolerances.min())) ** 2

    def led_on(task: Task, shapes: Shapes, iterations: int) -> Refined:
        most = int(_MOST * len(shapes.length))
        return refine(task, shapes, iterations=iterations, enough=most, met=met, is_up=stop)

    refined = led_on(narrow, beginnings, iterations)
    pool = Pool.of(task, narrow, refined.shapes, stop)
    # Where targets are met exactly and fix finitely many surfaces, bending changes nothing that counts more
    # than the bend itself.
    finite = _is_tight(task) and len(arms) > 0
    gained = [np.full(_COUNTS, np.inf)]
    for _ in range(0 if finite else _ROUNDS):
        if stop() or not len(pool.table):
            break
        gained.append(pool.table[0, :_COUNTS])
        if len(gained) > _PATIENCE and (gained[-1] > gained[-1 - _PATIENCE] - 0.2 * STEPS[:_COUNTS]).all():
            break
        bent = _varied(pool.shapes.take(pool.distinct()[:_BENT]), _VARIED, rng)
        refined = led_on(_beside(narrow, rng), bent, _ITERATIONS_AGAIN)
        pool = pool.joined(Pool.of(task, narrow, refined.shapes, stop))
    return pool


def _promising(task: Task, arms: FloatArray, led: int, rng: np.random.Generator) -> Shapes:
    """Return random shapes that pass the targets nearly, and some near arms through all of them."""
    random = _random_shapes(task.robot)
    shapes, misses = random.shapes, np.minimum(estimated_misses(task, random), _FAR)
    order = np.argsort(relative_weights(task) @ misses**2, kind="stable")
    good = rng.permutation(order[:_GOOD])[:_ASKED]
    postures = Postures.nearest(TargetsSeen.of(task), shapes.take(good).kinematics)
    calm = good[np.argsort(swings_of(postures.joints).max(axis=1, initial=0.0), kind="stable")]
    chosen = np.union1d(order[: led - _LED // 2], calm[: _LED // 2])
    return shapes.take(np.union1d(chosen, random.nearest_to_arms(arms, _PER_ARM)))


@lru_cache(maxsize=4)
def _random_shapes(robot: Robot) -> RandomShapes:
    """Return random shapes of a robot, the same for all of its tasks."""
    return RandomShapes(Shapes.sample(robot, _SHAPES, np.random.default_rng(0)))


def _varied(parents: Shapes, count: int, rng: np.random.Generator) -> Shapes:
    """Return so many shapes bent at random by a little or more, some from each of the parents."""
    return parents.take(np.resize(np.arange(len(parents.length)), count)).varied(_SIZES, _LENGTHS, rng)


def _beside(task: Task, rng: np.random.Generator) -> Task:
    """Return a task with its targets moved by a part of their tolerances, at random."""
    ways = rng.normal(size=(len(task.targets), 3))
    room = np.where(task.tolerances < _TIGHT, 0.0, _BESIDE * rng.uniform() * task.tolerances)
    ways *= (room / np.linalg.norm(ways, axis=1))[:, None]
    return replace(task, targets=replace(task.table, positions=task.table.positions + ways))
