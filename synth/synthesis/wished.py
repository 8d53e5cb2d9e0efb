"""Shapes that a person would want, once it is known that the targets can be reached.

The search for a first shape asks for the misses alone, so its answers lean on the limits, and joints swing
where they please. Here many random shapes of a robot whose limits are drawn in by the margins are led to the
targets, all at once; what lies within the tolerances has margins. By their figures, which are as cheap, the
best are chosen, bent a little at random, led back to the targets, and chosen again.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, compared_by_value
from synth.robot import Interval
from synth.synthesis.exact_starts import exact_designs, nearest_to_designs
from synth.synthesis.forgiveness import misses_after_a_hand
from synth.synthesis.margins import Margins, drawn_in
from synth.synthesis.motion import MOST_MOTIONS
from synth.synthesis.population import ARCS, ARM_LENGTH, Population, into_limits
from synth.synthesis.postures import Aims, Postures
from synth.synthesis.ranking import CALM, STEPS, is_content, preferences, preferred
from synth.synthesis.refinement import refine, relative_weights
from synth.synthesis.screening import estimated_misses
from synth.synthesis.separation import overlaps
from synth.task import Objective

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from numpy.typing import NDArray

    from synth.robot import Arm, Robot
    from synth.task import Task

# Random shapes; so many of them are led to the targets, half of them the best, half the calmest of some that
# are drawn from the good ones.
_SHAPES, _LED, _GOOD, _ASKED = 5_000, 60, 500, 200
# Where joint 2 is kept in a part of its range as wide as a calm swing: shapes led, iterations, and where the
# parts lie, 0 at the beginning of the range, 1 at its end.
_LED_CALMER, _ITERATIONS_CALMER = 300, 30
_PARTS = (0.25, 0.75, 0.5, 0.0, 1.0)
_FROM_KNOWN = 20  # bent ones of those that are known
_PER_DESIGN = 3  # shapes looked at near each exact design, where there are any
_FAR = 0.3  # m; misses are compared up to here
_ITERATIONS, _ITERATIONS_AGAIN = 12, 6
# Rounds of bending; shapes that are bent, and how many come of them; sizes of the bends in units of the
# largest curvature; lengths change by a twentieth of that, m.
_ROUNDS, _BENT, _VARIED, _SIZES, _LENGTHS = 24, 10, 50, (0.03, 0.1, 0.3, 0.6), 0.05
# So many rounds that gain next to nothing in the first columns of `preferences` are the last.
_PATIENCE, _COUNTS = 3, 4
# Bent shapes are led beside the targets, by up to this part of the tolerances: else these were of no use. Of
# tolerances below this, m, there is nothing to be had: such targets are met exactly.
_BESIDE, _TIGHT = 0.7, 1e-3
# What a miss may take of its tolerance: the rest is for rounding; and where targets are met exactly.
_PART_OF_TOLERANCE, _EXACTLY = 0.9, 0.02
_DISTINCT = 0.03  # m, between link ends with axes of ARM_LENGTH


def wished(
    task: Task, known: Sequence[Arm], seed: int, stop: Callable[[], bool] = lambda: False
) -> Iterator[tuple[Arm, FloatArray]]:
    """Yield distinct shapes off their limits that come within the tolerances, the most wanted first.

    Nothing here is certain: each is to be verified. If the tolerances leave no room for all margins, those of
    the joints are looked for, and then those of the link.

    Args:
        task: The task.
        known: Shapes of equal arcs that reach the targets already.
        seed: Seed of the random shapes.
        stop: Asked after each step; when it says yes, the search ends.

    Yields:
        The robot in the shape, and the joint angles at each target, shape (n, 2), rad.
    """
    for joints, link in ((True, True), (True, False), (False, True)):
        narrow = drawn_in(replace(task, objective=Objective.LEAST_SQUARES), joints=joints, link=link)
        pool = _searched(task, narrow, known, np.random.default_rng([seed, 5]), stop)
        if stop():
            return
        for index in pool.distinct():
            arm = pool.population.arm(index, task.base)
            angles, _ = arm.closest_joints(task.table.positions)
            yield replace(arm, robot=task.robot), angles
        if len(pool.table):
            return


def _searched(
    task: Task, narrow: Task, known: Sequence[Arm], rng: np.random.Generator, stop: Callable[[], bool]
) -> _Pool:
    """Return the shapes that are wanted most, with limits drawn in.

    While the best leaves ways, margins or calm to wish for, all is begun anew with joint 2 kept in a part of
    its range, where no swing can be large: calm shapes are too rare to be met by chance.
    """
    pool = _bred(task, narrow, known, _LED, rng, stop)
    for calmer in _calmer(narrow) if task.current is None else ():  # else the nearest to it is wanted
        if stop() or not len(pool.table) or is_content(pool.table[0]):
            break
        pool = pool.joined(_bred(task, calmer, (), _LED_CALMER, rng, stop))
    if float(task.tolerances.min()) < _TIGHT and len(pool.table):
        chosen = pool.population.take(pool.distinct()[:_BENT])
        led = refine(narrow, chosen, iterations=_ITERATIONS_AGAIN, is_up=stop)
        pool = _Pool.of(task, narrow, led.population, stop, _EXACTLY)
    return pool


def _calmer(task: Task) -> Iterator[Task]:
    """Yield the same with joint 2 kept in one part of its range after another, and twice as it is."""
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
    rng: np.random.Generator,
    stop: Callable[[], bool],
) -> _Pool:
    """Return the shapes that are wanted most of some random ones and of what bending makes of them."""
    beginnings = _promising(narrow, led, rng).unknowns
    if known:
        varied = _varied(narrow.robot, [Population.of(arm) for arm in known], _FROM_KNOWN, rng)
        beginnings = np.concatenate([beginnings, varied])
    iterations = _ITERATIONS if known else _ITERATIONS_CALMER
    refined = refine(narrow, Population(narrow.robot, beginnings), iterations=iterations, is_up=stop)
    pool = _Pool.of(task, narrow, refined.population, stop)
    # Where targets are met exactly and fix finitely many surfaces, bending changes nothing that counts more
    # than the bend itself.
    finite = float(task.tolerances.min()) < _TIGHT and exact_designs(narrow) is not None
    gained = [np.full(_COUNTS, np.inf)]
    for _ in range(0 if finite else _ROUNDS):
        if stop() or not len(pool.table):
            break
        gained.append(pool.table[0, :_COUNTS])
        if len(gained) > _PATIENCE and (gained[-1] > gained[-1 - _PATIENCE] - 0.2 * STEPS[:_COUNTS]).all():
            break
        unknowns = _varied(narrow.robot, [pool.population.take(pool.distinct()[:_BENT])], _VARIED, rng)
        bent = Population(narrow.robot, unknowns)
        refined = refine(_beside(narrow, rng), bent, iterations=_ITERATIONS_AGAIN, is_up=stop)
        pool = pool.joined(_Pool.of(task, narrow, refined.population, stop))
    return pool


def _promising(task: Task, led: int, rng: np.random.Generator) -> Population:
    """Return random shapes that pass the targets nearly, and some near exact designs."""
    shapes = _random_shapes(task.robot)
    misses = np.minimum(estimated_misses(task, shapes), _FAR)
    order = np.argsort(relative_weights(task) @ misses**2, kind="stable")
    good = rng.permutation(order[:_GOOD])[:_ASKED]
    postures = Postures.nearest(Aims(task.positions, task.robot.joint_limits), shapes.take(good).kinematics)
    calm = good[np.argsort(_swings(postures.joints).max(axis=1, initial=0.0), kind="stable")]
    chosen = np.union1d(order[: led - _LED // 2], calm[: _LED // 2])
    if designs := exact_designs(task):
        chosen = np.union1d(chosen, nearest_to_designs(shapes, designs, _PER_DESIGN))
    return shapes.take(chosen)


@lru_cache(maxsize=4)
def _random_shapes(robot: Robot) -> Population:
    """Return random shapes of a robot, the same for all of its tasks."""
    return Population.sample(robot, _SHAPES, np.random.default_rng(0))


def _varied(robot: Robot, parents: Sequence[Population], count: int, rng: np.random.Generator) -> FloatArray:
    """Return unknowns of so many shapes bent at random by a little or more, some from each of the parents."""
    unknowns = np.concatenate([each.unknowns for each in parents])
    unknowns = np.resize(unknowns, (count, unknowns.shape[1]))
    size = rng.choice(_SIZES, (count, 1)) * np.ones(unknowns.shape)
    size[:, 2 * ARCS :] *= _LENGTHS
    return into_limits(robot, unknowns + size * rng.normal(size=unknowns.shape))


def _beside(task: Task, rng: np.random.Generator) -> Task:
    """Return a task with its targets moved by a part of their tolerances, at random."""
    ways = rng.normal(size=(len(task.targets), 3))
    room = np.where(task.tolerances < _TIGHT, 0.0, _BESIDE * rng.uniform() * task.tolerances)
    ways *= (room / np.linalg.norm(ways, axis=1))[:, None]
    return replace(task, targets=replace(task.table, positions=task.table.positions + ways))


@compared_by_value
@dataclass(frozen=True, eq=False)
class _Pool:
    """Shapes within the tolerances, the most wanted first.

    Attributes:
        population: The shapes, of shape (N,).
        table: Rows of `preferences`, shape (N, 6).
    """

    population: Population
    table: FloatArray

    @classmethod
    def of(
        cls,
        task: Task,
        narrow: Task,
        population: Population,
        stop: Callable[[], bool],
        part: float = _PART_OF_TOLERANCE,
    ) -> _Pool:
        """Return those of some shapes that meet a task, as far as samples tell.

        Args:
            task: The task.
            narrow: The same with limits drawn in.
            population: The shapes.
            stop: When it says yes the obstacles are left out: nobody asks for these shapes any more.
            part: Of each tolerance, that a miss may take.
        """
        aims = Aims(task.positions, narrow.robot.joint_limits)
        postures = Postures.nearest(aims, population.kinematics)
        within = (np.sqrt(postures.squared) <= part * task.tolerances).all(axis=1)
        joints = postures.joints
        within &= _over_floor(task, population, joints)
        population, joints = population.take(within), joints[within]
        depth = overlaps(narrow, population, joints, is_up=stop).max(axis=1, initial=0.0)
        clearance = Margins.wanted(task.robot).clearance
        clear = depth <= clearance
        population, joints, depth = population.take(clear), joints[clear], depth[clear]
        swings = _swings(joints)
        expected, _ = misses_after_a_hand(
            aims, task.tolerances, population.kinematics, population.end[1], joints[..., 1]
        )
        table = preferences(
            np.zeros(len(depth)),
            depth / clearance,
            swings.max(axis=1, initial=0.0),
            expected,
            swings.sum(axis=1),
            population.bending,
        )
        return cls(population, table).sorted()

    def sorted(self) -> _Pool:
        """Return the same, the most wanted first."""
        chosen = preferred(self.table)
        return _Pool(self.population.take(chosen), self.table[chosen])

    def joined(self, other: _Pool) -> _Pool:
        """Return the shapes of both."""
        unknowns = np.concatenate([self.population.unknowns, other.population.unknowns])
        return _Pool(
            Population(self.population.robot, unknowns), np.concatenate([self.table, other.table])
        ).sorted()

    def distinct(self) -> NDArray[np.intp]:
        """Return which shapes differ from all that are wanted more."""
        frame, position = self.population.end
        poses = np.hstack([position, ARM_LENGTH * frame[:, :, 0]])
        apart = np.linalg.norm(poses[:, None] - poses, axis=-1) >= _DISTINCT
        kept: list[int] = []
        for index in range(len(poses)):
            if apart[index, kept].all():
                kept.append(index)
        return np.array(kept, dtype=np.intp)


def _swings(joints: FloatArray) -> FloatArray:
    """Return the turns from each target to the next of the joint that turns more, rad, shape (N, n - 1).

    None where there are so many targets that nobody asks for ways between them.

    Args:
        joints: Joint angles, shape (N, n, 2), rad.
    """
    if joints.shape[1] > MOST_MOTIONS:
        joints = joints[:, :1]
    return np.asarray(np.abs(np.diff(joints, axis=1)).max(axis=2))


def _over_floor(task: Task, population: Population, joints: FloatArray) -> NDArray[np.bool_]:
    """Return which shapes stay over the floor, link, joint 2 and end effector, at samples of the link."""
    if task.floor is None:
        return np.ones(len(joints), dtype=np.bool_)
    robot, (frame, end) = task.robot, population.end
    link = population.centreline[:, :, 2].min(axis=1) - 0.5 * robot.link.diameter
    along = np.array([-robot.tip_offset, robot.d34 - robot.tip_offset])
    axis = (end[:, 2, None] + along * frame[:, 2, 0, None]).min(axis=1)
    tip = population.kinematics.each_target().forward(0.0, joints[..., 1])[..., 2].min(axis=1)
    lowest = np.minimum(np.minimum(link, axis), tip - 0.5 * robot.rigid_link.diameter)
    return np.asarray(lowest >= task.floor)
