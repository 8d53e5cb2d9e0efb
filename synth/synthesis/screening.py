"""Start points: many random shapes that the link can take, ranked by how near they pass the targets.

A local solver from a random shape finds the best one rarely; from the best of many random shapes it
finds it nearly always, and looking at a shape is ten thousand times cheaper than polishing it.
"""

from __future__ import annotations

import itertools
from collections import Counter
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from synth.robot import Arm, into_turn
from synth.synthesis.exact_starts import exact_designs, nearest_to_designs
from synth.synthesis.hopping import hopped
from synth.synthesis.population import Population, into_limits
from synth.synthesis.refinement import Refined, category_offsets, refine, relative_weights, with_theta1
from synth.synthesis.separation import overlaps

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.geometry import Invariants
    from synth.robot import Robot
    from synth.task import Task

_MOST_TARGETS = 40
# How many shapes are drawn, looked at with the joint limits, and refined: most tasks are found in the
# first step, which takes a tenth of the second one's time.
_STEPS = ((20_000, 1_000, 200), (200_000, 4_000, 400))
_STARTS_PER_STEP, _STARTS_AFTER_HOPS = 12, 6
_PER_DESIGN = 6  # shapes looked at near each exact design, where there are any
# Misses are only compared up to here, m: beyond, a shape is far off and by how much says little.
_FAR = 0.3
# Misses below this, m, are as good as none for a start: the refinement sees to them.
_NEAR = 3e-3
# Starts whose link ends are nearer than this, m, count as one, an axis 1 rad apart for _ARM_LENGTH.
_DISTINCT = 0.03
_ARM_LENGTH = 0.5
_ALIKE, _OF_A_KIND = 2e-3, 2  # starts whose mean squared misses differ by less than this part
# Mean squared misses below this, m^2, are all as good: then the gentler bend goes first.
_SETTLED = 1e-8
# The search over branches: rounds, shapes kept, children of each, and how many targets a child swaps on
# average. It ends where the mean squared miss is below _EXACT, m^2.
_SWAP_ROUNDS, _PARENTS, _CHILDREN = 12, 10, 20
_SWAPPED_TARGETS = (1, 2, 4, np.inf)
_EXACT = 1e-14
# The search around obstacles: rounds, children of each shape, how far they are bent at most (in the unknowns'
# own units), and how many clear shapes end it.
_WANDER_ROUNDS, _WANDER_CHILDREN, _WANDER, _CLEAR_ENOUGH = 12, 5, 0.3, 12
_SHEET = 0.04  # a branch that misses by more than this, m, is no other sheet of the same surface


@dataclass(frozen=True)
class Start:
    """A shape to polish: the robot in it, and the joint angles that come closest to the targets."""

    arm: Arm
    joints: FloatArray


def starts(task: Task, seed: int, *, quick: bool = False) -> Iterator[Start]:
    """Yield distinct start points, the most promising first.

    Args:
        task: The task.
        seed: Seed of the random shapes.
        quick: Whether to end with what the first, small step finds.

    Yields:
        Start points; none where no random shape respects the limits and the floor.
    """
    rng = np.random.default_rng([seed, 1])
    for start in _starts(_fewer_targets(task, rng), seed, rng, quick=quick):
        joints = start.joints
        if len(joints) < len(task.targets):
            joints, _ = start.arm.closest_joints(task.table.positions)
        yield Start(start.arm, joints)


def _fewer_targets(task: Task, rng: np.random.Generator) -> Task:
    """Return the task with a random part of its targets: forty tell where to look as well as more."""
    if len(task.targets) <= _MOST_TARGETS:
        return task
    chosen = np.sort(rng.choice(len(task.targets), _MOST_TARGETS, replace=False))
    return replace(task, targets=task.table.take(chosen))


@lru_cache(maxsize=4)
def _small_population(robot: Robot, floor: float | None, seed: int) -> Population:
    """Return the shapes of the first step, the same for all tasks of a robot, a floor and a seed.

    They keep where they end, which takes a few megabytes; the next task need not ask again.
    """
    return _population(robot, floor, _STEPS[0][0], np.random.default_rng([seed, 0]))


def _population(robot: Robot, floor: float | None, size: int, rng: np.random.Generator) -> Population:
    """Return random shapes whose links end above the floor."""
    population = Population.sample(robot, size, rng)
    return population if floor is None else population.take(population.end[1][:, 2] > floor)


def _starts(task: Task, seed: int, rng: np.random.Generator, *, quick: bool) -> Iterator[Start]:
    """Yield start points for a task of few targets, each step with more effort than the one before."""
    designs, after_hops = exact_designs(task) or (), None
    for size, shortlist, count in _STEPS:
        if size == _STEPS[0][0]:
            population = _small_population(task.robot, task.floor, seed)
        else:
            population = _population(task.robot, task.floor, size, rng)
        if not len(population.length):
            return
        cost = _costs(task, estimated_misses(task, population)) + _category_cost(task, population)
        population = population.take(_promising(population, cost, shortlist, designs))
        theta2, misses = limited_misses(task, population)
        cost = _costs(task, misses) + _category_cost(task, population)
        if task.obstacles:
            cost += _overlap_cost(task, population, with_theta1(task, population, theta2.T))
        best = _promising(population, cost, count, designs)
        refined = refine(task, population.take(best), theta2[:, best].T)
        if task.obstacles:
            refined = _wandered_clear(task, refined, rng)
        yield from itertools.islice(_distinct(task, refined), _STARTS_PER_STEP)
        if quick:
            return
        # The second step does not begin anew: what was hopped to from the first one goes into its hops.
        after_hops = hopped(task, refined if after_hops is None else refined.improved_by(after_hops), rng)
        yield from itertools.islice(_distinct(task, after_hops), _STARTS_AFTER_HOPS)
    if after_hops is not None:
        yield from _distinct(task, _with_branches_swapped(task, after_hops, rng))


def _promising(
    population: Population, cost: FloatArray, count: int, designs: Sequence[Invariants]
) -> NDArray[np.intp]:
    """Return which shapes to look at closer: `count` by their misses, and those nearest to exact designs.

    Among near misses the gentle bends come first: the refinement sees to the rest.
    """
    best = np.lexsort([population.bending, np.maximum(cost, _NEAR**2)])[:count]
    return np.union1d(best, nearest_to_designs(population, designs, _PER_DESIGN)) if designs else best


def _distinct(task: Task, refined: Refined) -> Iterator[Start]:
    """Yield starts in the order of their misses, those aside that are nearly one yielded before."""
    population = refined.population
    frame, position = population.end
    cost = np.maximum(refined.cost, _SETTLED)
    if task.obstacles:
        cost = cost + _overlap_cost(task, population, refined.joints)
    # Shapes that miss alike are mostly one surface, bent in several ways.
    kinds, often = np.round(np.log(cost) / _ALIKE), Counter[float]()
    poses = np.hstack([position, _ARM_LENGTH * frame[:, :, 0]])
    taken = np.empty((0, poses.shape[1]))
    for index in np.lexsort([population.bending, cost]):
        kind, settled = float(kinds[index]), cost[index] <= _SETTLED
        if (settled or often[kind] < _OF_A_KIND) and np.all(
            np.linalg.norm(taken - poses[index], axis=1) > _DISTINCT
        ):
            often[kind] += 1
            taken = np.vstack([taken, poses[index]])
            yield Start(population.arm(index, task.base), refined.joints[index])


def _wandered_clear(task: Task, refined: Refined, rng: np.random.Generator) -> Refined:
    """Return shapes after a search for links that reach around the obstacles.

    Many bends of the link give one surface. So the best shapes are bent a little at random and led back to
    the targets, the best of both again, and so on; the nonlinear program knows which way obstacles lie,
    but only this finds the other side of one.
    """
    total = refined.cost + _overlap_cost(task, refined.population, refined.joints)
    for _ in range(_WANDER_ROUNDS):
        if np.count_nonzero(total < _SETTLED) >= _CLEAR_ENOUGH:
            break
        order = np.argsort(total, kind="stable")
        parents = np.resize(order[: len(order) // _WANDER_CHILDREN], len(order))
        x = refined.population.unknowns[parents]
        x = into_limits(task.robot, x + rng.uniform(0.0, _WANDER) * rng.normal(size=x.shape))
        children = refine(task, Population(task.robot, x), refined.joints[parents, :, 1])
        child_total = children.cost + _overlap_cost(task, children.population, children.joints)
        best = np.argsort(np.concatenate([total, child_total]), kind="stable")[: len(total)]
        refined = refined.chosen_with(children, best)
        total = np.concatenate([total, child_total])[best]
    return refined


def _with_branches_swapped(task: Task, refined: Refined, rng: np.random.Generator) -> Refined:
    """Return the best shapes after a search over which target takes which branch of joint 2.

    Where the axes nearly meet or are nearly parallel, the workspace has two sheets a few millimetres
    apart, and no local step moves a target from one to the other. So the best shapes are tried with some
    targets on their other branch, the best of these again, and so on.

    Args:
        task: The task.
        refined: Shapes at the bottoms of their valleys.
        rng: Source of randomness.
    """
    for _ in range(_SWAP_ROUNDS):
        swapped = _swapped_once(task, refined, rng)
        if swapped is None or refined.cost.min() < _EXACT:
            break
        refined = refined.improved_by(refine(task, *swapped))
    return refined


def _swapped_once(
    task: Task, refined: Refined, rng: np.random.Generator
) -> tuple[Population, FloatArray] | None:
    """Return the best shapes many times over, some targets moved to their other branch.

    Returns:
        Shapes, of shape (N,), and the angles of joint 2 to refine them from, shape (N, n), rad; None if
        no target has another branch nearby.
    """
    # Shapes that miss alike are mostly one surface, bent in several ways: two of a kind are enough.
    order = np.argsort(refined.cost, kind="stable")
    kinds = np.round(np.log(refined.cost[order] + _EXACT), 2)
    best = order[[np.sum(kinds[:place] == kind) < 2 for place, kind in enumerate(kinds)]][:_PARENTS]
    population, theta2 = refined.population.take(best), refined.joints[best, :, 1]
    limits, kinematics = task.robot.joint_limits, population.kinematics.each_target()
    both = into_turn(kinematics.branches(task.positions)[..., 1], limits.second.middle)
    other = np.argmax(np.abs(both - theta2[..., None]), axis=-1)
    swapped = np.take_along_axis(both, other[..., None], axis=-1)[..., 0]
    swapped = np.clip(swapped, limits.second.lower, limits.second.upper)
    near = kinematics.miss(swapped, task.positions, limits.base) < _SHEET
    if not near.any():
        return None
    copies = np.repeat(np.arange(len(best)), _CHILDREN)
    chance = np.minimum(rng.choice(_SWAPPED_TARGETS, len(copies)) / len(task.targets), 1.0)
    swap = near[copies] & (rng.uniform(size=(len(copies), len(task.targets))) < chance[:, None])
    return population.take(copies), np.where(swap, swapped[copies], theta2[copies])


def estimated_misses(task: Task, population: Population) -> FloatArray:
    """Return about how far the workspace of each shape passes by each target; no joint limits.

    In the plane of height z and squared distance N = |P5|^2 a workspace is an ellipse,
    (z, N) = (cz, |c|^2 + R^2) + M (cos theta2, sin theta2). For d = (z, N) of the target less the
    centre, |adj(M) d| - |det M| vanishes on it; divided by the length of its gradient it is the
    distance to first order, and, unlike Gamma, it is so for perfect squares too.

    Args:
        task: The task.
        population: The shapes.

    Returns:
        Estimated misses, shape (n, N), m.
    """
    centre, radius = population.kinematics.centre, population.kinematics.radius
    _, v, t = np.moveaxis(population.end[0], -1, 0)
    m00, m01 = -radius * t[:, 2], radius * v[:, 2]
    m10 = -2.0 * radius * np.einsum("ij,ij->i", centre, t)
    m11 = 2.0 * radius * np.einsum("ij,ij->i", centre, v)
    determinant = np.abs(m00 * m11 - m01 * m10)
    squared = np.einsum("ij,ij->i", centre, centre) + radius**2
    misses = np.empty((len(task.targets), len(radius)))
    for row, (x, y, z) in enumerate(task.positions):
        height = z - centre[:, 2]
        beyond = x * x + y * y + z * z - squared
        a = m11 * height - m01 * beyond
        b = m00 * beyond - m10 * height
        norm = np.hypot(a, b) + 1e-15
        by_squared = (m00 * b - m01 * a) / norm
        by_height = (m11 * a - m10 * b) / norm + 2.0 * z * by_squared
        by_radius = 2.0 * np.hypot(x, y) * by_squared
        misses[row] = np.abs(norm - determinant) / (np.hypot(by_height, by_radius) + 1e-12)
    return misses


def limited_misses(task: Task, population: Population) -> tuple[FloatArray, FloatArray]:
    """Return about how far P5 stays from each target within the joint limits; for a short list.

    Args:
        task: The task.
        population: The shapes.

    Returns:
        The better of both branches of joint 2, moved into its limits, and its miss, each of shape
        (n, N), rad and m.
    """
    limits = task.robot.joint_limits
    kinematics = population.kinematics
    branches = kinematics.each_target()
    angles, misses = [], []
    for position in task.positions:
        theta2 = into_turn(kinematics.branches(position)[..., 1], limits.second.middle)
        theta2 = np.clip(theta2, limits.second.lower, limits.second.upper)
        miss = branches.miss(theta2, position, limits.base)
        better = np.argmin(miss, axis=-1)[:, None]
        angles.append(np.take_along_axis(theta2, better, axis=-1)[:, 0])
        misses.append(np.take_along_axis(miss, better, axis=-1)[:, 0])
    return np.array(angles), np.array(misses)


def _costs(task: Task, misses: FloatArray) -> FloatArray:
    """Return the mean squared misses, weighted, m^2, for misses of shape (n, N)."""
    return np.asarray(relative_weights(task) @ np.minimum(misses, _FAR) ** 2)


def _category_cost(task: Task, population: Population) -> FloatArray:
    """Return the squared distance from the category that the task asks for, m^2."""
    return np.asarray(np.sum(category_offsets(task, *population.end) ** 2, axis=-1))


def _overlap_cost(task: Task, population: Population, joints: FloatArray) -> FloatArray:
    """Return the mean squared depth in obstacles, m^2, for joint angles of shape (N, n, 2)."""
    return np.asarray(np.mean(overlaps(task, population, joints) ** 2, axis=-1))
