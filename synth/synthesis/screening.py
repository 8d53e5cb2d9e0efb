"""Start points: many random shapes that the link can take, ranked by how near they pass the targets.

A local solver from a random shape finds the best one rarely; from the best of many random shapes it
finds it nearly always, and looking at a shape is ten thousand times cheaper than polishing it.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, compared_by_value
from synth.synthesis.category_offsets import category_offsets
from synth.synthesis.exact_starts import exact_designs, nearest_to_designs
from synth.synthesis.many_targets import as_it_is_and_turned
from synth.synthesis.population import ARM_LENGTH, Population
from synth.synthesis.refinement import relative_weights
from synth.synthesis.thinning import thinned
from synth.synthesis.valleys import Valleys
from synth.synthesis.watch import Watch
from synth.task import Objective

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from synth.robot import Arm, Robot
    from synth.synthesis.refinement import Refined
    from synth.task import Task

_MOST_TARGETS = 40
# Shapes drawn that are looked at; of these the ones refined, half of them the best, half at random from so
# many of the best; and from how many of the best fresh ones are drawn.
_SHAPES, _REFINED, _GOOD, _FRESH = 20_000, 200, 4_000, 10_000
_PER_DESIGN = 6  # shapes looked at near each exact design, where there are any
# Misses are only compared up to here, m: beyond, a shape is far off and by how much says little.
_FAR = 0.3
# Misses below this, m, are as good as none for a start: the refinement sees to them.
_NEAR = 3e-3
# Starts whose link ends are nearer than this, m, count as one, an axis 1 rad apart for ARM_LENGTH, unless
# the later one is better by more than this part.
_DISTINCT, _BETTER = 0.03, 0.01
# Starts whose mean squared misses differ by less than this part are of a kind: so many are enough.
_ALIKE, _OF_A_KIND = 2e-3, {Objective.LEAST_SQUARES: 2, Objective.MINIMAX: 6}
# Misses below this, m, and below this part of the tightest tolerance are all as good: then the gentler bend
# goes first.
_SETTLED, _SETTLED_PART = 1e-5, 0.02
# Of each step; where the worst miss counts, the cost says less of what the nonlinear program will reach.
_MOST_STARTS = {Objective.LEAST_SQUARES: 12, Objective.MINIMAX: 24}


@compared_by_value
@dataclass(frozen=True, eq=False)
class Start:
    """A shape to polish.

    Attributes:
        arm: The robot in it.
        joints: The joint angles that come closest to the targets, shape (n, 2), rad.
        cost: As of a `Refined` shape, with its depths in obstacles and in itself, m^2: about the least in its
            valley, whatever the floor asks for.
    """

    arm: Arm
    joints: FloatArray
    cost: float = 0.0


def starts(task: Task, seed: int, *, quick: bool = False, watch: Watch | None = None) -> Iterator[Start]:
    """Yield distinct start points, the most promising first.

    Args:
        task: The task.
        seed: Seed of the random shapes.
        quick: Whether to end with what the first, small step finds.
        watch: When it is up, no more is searched for.

    Yields:
        Start points; none where no random shape respects the limits and the floor.
    """
    rng, watch = np.random.default_rng([seed, 1]), watch or Watch()
    for start in _starts(thinned(task, _MOST_TARGETS, rng), seed, rng, watch, quick=quick):
        if len(start.joints) == len(task.targets):
            yield start
            continue
        for arm in as_it_is_and_turned(task, start.arm, watch):
            joints, misses = arm.closest_joints(task.table.positions)
            yield Start(arm, joints, cost=float(relative_weights(task) @ misses**2))


@lru_cache(maxsize=4)
def _shapes(robot: Robot, floor: float | None, seed: int) -> Population:
    """Return random shapes whose links end above the floor, the same for all tasks of a seed.

    They keep where they end, which takes a few megabytes; the next task need not ask again.
    """
    population = Population.sample(robot, _SHAPES, np.random.default_rng([seed, 0]))
    return population if floor is None else population.take(population.end[1][:, 2] > floor)


def _starts(task: Task, seed: int, rng: np.random.Generator, watch: Watch, *, quick: bool) -> Iterator[Start]:
    """Yield start points for a task of few targets, each step with more effort than the one before."""
    shapes = _shapes(task.robot, task.floor, seed)
    if not len(shapes.length):
        return
    cost = _costs(task, estimated_misses(task, shapes)) + _category_cost(task, shapes)
    # Among near misses the gentle bends come first: the refinement sees to the rest.
    order = np.lexsort([shapes.bending, np.maximum(cost, _NEAR**2)])

    def drawn(count: int, most: int) -> NDArray[np.intp]:
        return rng.choice(order[:most], min(count, most, len(order)), replace=False)

    first = np.union1d(order[: _REFINED // 2], drawn(_REFINED // 2, _GOOD))
    if designs := exact_designs(task):
        first = np.union1d(first, nearest_to_designs(shapes, designs, _PER_DESIGN))
    valleys, distinct = Valleys.of(task, shapes.take(first), watch), _Distinct(task)
    if not (quick or valleys.agreed):
        yield from distinct.of(valleys.within_tolerance)
        valleys = valleys.explored(lambda: shapes.take(drawn(_REFINED, _FRESH)), rng)
    yield from distinct.of(valleys.promising)


class _Distinct:
    """Start points that differ from those before.

    Args:
        task: The task.
    """

    def __init__(self, task: Task) -> None:
        self._task = task
        self._poses, self._costs = np.empty((0, 6)), np.empty(0)
        self._kinds = Counter[float]()

    def of(self, refined: Refined) -> Iterator[Start]:
        """Yield starts in the order of their costs, m^2, those aside that are nearly one yielded before."""
        population, base, yielded = refined.population, self._task.base, 0
        frame, position = population.end
        poses = np.hstack([position, ARM_LENGTH * frame[:, :, 0]])
        as_good = min(_SETTLED, _SETTLED_PART * float(self._task.tolerances.min())) ** 2
        cost = np.maximum(refined.cost, as_good)
        # Shapes that miss alike are mostly one surface, bent in several ways.
        kinds = np.round(np.log(cost) / _ALIKE)
        for index in np.lexsort([population.bending, cost]):
            kind, settled = float(kinds[index]), cost[index] <= as_good
            near = np.linalg.norm(self._poses - poses[index], axis=1) < _DISTINCT
            no_better = cost[index] >= (1.0 - _BETTER) * self._costs
            if np.any(near & no_better) or (
                not settled and self._kinds[kind] >= _OF_A_KIND[self._task.objective]
            ):
                continue
            self._kinds[kind] += 1
            self._poses = np.vstack([self._poses, poses[index]])
            self._costs = np.append(self._costs, cost[index])
            yield Start(population.arm(index, base), refined.joints[index], float(refined.cost[index]))
            yielded += 1
            if yielded == _MOST_STARTS[self._task.objective]:
                return


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


def _costs(task: Task, misses: FloatArray) -> FloatArray:
    """Return the mean squared misses, weighted, m^2, for misses of shape (n, N)."""
    return np.asarray(relative_weights(task) @ np.minimum(misses, _FAR) ** 2)


def _category_cost(task: Task, population: Population) -> FloatArray:
    """Return the squared distance from the category that the task asks for, m^2."""
    return np.asarray(np.sum(category_offsets(task, population) ** 2, axis=-1))
