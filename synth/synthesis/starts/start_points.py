"""Start points: many random shapes that the link can take, ranked by how near they pass the targets.

A local solver from a random shape finds the best one rarely; from the best of many random shapes it
finds it nearly always, and looking at a shape is ten thousand times cheaper than polishing it.
"""

from __future__ import annotations

import math
from collections import Counter
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import frozen_value
from synth.synthesis.starts.exact_arms import arms_near_all, arms_through_all
from synth.synthesis.starts.random_shapes import shapes_for
from synth.synthesis.starts.refined import meets_all, relative_weights, weighed
from synth.synthesis.starts.refinement import refine, refine_the_best
from synth.synthesis.starts.screening import screened
from synth.synthesis.starts.thinning import thinned
from synth.synthesis.starts.turned_arms import as_it_is_and_turned
from synth.synthesis.starts.valleys import Valleys
from synth.task import Objective
from synth.watch import Watch

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.robot import Arm
    from synth.synthesis.shapes import Shapes
    from synth.synthesis.starts.random_shapes import RandomShapes
    from synth.synthesis.starts.refined import Refined
    from synth.task import Task


_MOST = 40  # targets that are searched with
# At first few shapes, the best, are led to the targets, until some meet all: mostly that is the answer.
_LOOKED_AT, _LOOKS, _FEW = 40, 16, 3
_MORE_LOOKS = 6  # steps, where none of them does
_LED, _GO_ON = (8, 12), 2  # steps of shapes near arms that pass near all targets; the better half goes on
_REFINED = 200  # shapes: half of them the best, half at random from the good ones
_GOOD = 4_000  # the best of the screening, which knows nothing of the valleys
_FRESH = 10_000  # the best, from which fresh ones are drawn
_PER_ARM = 3  # shapes looked at near each form of an arm from algebra, where there are any
# Misses below this, m, are as good as none for a start: the refinement sees to them.
_NEAR = 3e-3
_GENTLER = 1e-12  # m^2 for each 1/m of bending energy: no more than to tell equals apart
# Starts whose link ends are nearer than this, m, count as one, an axis 1 rad apart for ARM_LENGTH.
_DISTINCT = 0.03
_BETTER = 0.01  # part by which the later of such must be better to count all the same
_ALIKE = 2e-3  # part by which the mean squared misses of starts differ that are of a kind
_OF_A_KIND = {Objective.LEAST_SQUARES: 2, Objective.MINIMAX: 6}  # so many of these are enough
# Misses below both of these are all as good: then the gentler bend goes first.
_SETTLED = 1e-5  # m
_SETTLED_PART = 0.02  # of the tightest tolerance
# Of each step; where the worst miss counts, the cost says less of what the nonlinear program will reach.
_MOST_STARTS = {Objective.LEAST_SQUARES: 12, Objective.MINIMAX: 24}


@frozen_value
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

    def relative_miss(self, task: Task) -> float:
        """Return what it misses in the mean, in units of the tightest tolerance."""
        return math.sqrt(self.cost) / float(task.tolerances.min())

    def misses(self, task: Task) -> FloatArray:
        """Return the misses of the targets at its joint angles, shape (n,), m."""
        reached = self.arm.forward_kinematics(self.joints[:, 0], self.joints[:, 1])
        return np.asarray(np.linalg.norm(reached - task.table.positions, axis=1))


def start_points(
    task: Task, seed: int, *, quick: bool = False, watch: Watch | None = None
) -> Iterator[Start]:
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
    for start in _starts(thinned(task, _MOST, rng), seed, rng, watch, quick=quick):
        if len(start.joints) == len(task.targets):
            yield start
            continue
        for arm in as_it_is_and_turned(task, start.arm, watch):
            joints, misses = arm.closest_joints(task.table.positions)
            yield Start(arm, joints, cost=float(relative_weights(task) @ misses**2))


def _starts(task: Task, seed: int, rng: np.random.Generator, watch: Watch, *, quick: bool) -> Iterator[Start]:
    """Yield start points for a task of few targets, each step with more effort than the one before."""
    random, distinct = _Ranked(task, shapes_for(task, seed), rng, watch), _Distinct(task)
    if not random.count:
        return
    if quick:
        yield from distinct.of(Valleys.of(task, random.many(but=0), None, watch).promising)
        return
    looked_at = random.few()
    exact = weighed(task, looked_at.take(meets_all(task, looked_at)), watch)
    yield from distinct.of(exact.take(meets_all(task, exact)))
    few = looked_at.take(np.arange(min(_LOOKED_AT, random.count)))
    few = refine(task, few.shapes, iterations=_MORE_LOOKS, near=True, is_up=watch.is_up)
    valleys = Valleys.of(task, few, random.near_arms(), watch)
    if not valleys.agreed:
        valleys = valleys.joined(random.many(but=_LOOKED_AT))
    if not valleys.agreed:
        yield from distinct.of(valleys.within_tolerance)
        valleys = valleys.explored(lambda: random.drawn(_FRESH), rng)
    yield from distinct.of(valleys.promising)


class _Ranked:
    """Random shapes, those first that pass the targets nearest: some of them, led to the targets."""

    def __init__(self, task: Task, random: RandomShapes, rng: np.random.Generator, watch: Watch) -> None:
        self._task, self._random, self._rng, self._watch = task, random, rng, watch
        # Among near misses the gentle bends come first: the refinement sees to the rest.
        cost = np.maximum(screened(task, random), _NEAR**2) + _GENTLER * random.bending
        self._order = np.argsort(cost, kind="stable")
        self.count = len(cost)

    def few(self) -> Refined:
        """Return the best, and shapes near arms through all targets with them, until some meet all."""
        near = self._random.nearest_to_arms(arms_through_all(self._task), _PER_ARM)
        chosen = self._random.shapes.take(np.concatenate([self._order[:_LOOKED_AT], near]))
        return refine(self._task, chosen, iterations=_LOOKS, enough=_FEW, is_up=self._watch.is_up)

    def many(self, *, but: int) -> Refined:
        """Return the best but for some, and as many at random of the good ones."""
        best, good = self._order[but : _REFINED // 2], self._any(_REFINED // 2, _GOOD)
        chosen = self._random.shapes.take(np.union1d(best, good))
        return refine(self._task, chosen, is_up=self._watch.is_up)

    def near_arms(self) -> Refined | None:
        """Return shapes near arms that pass near all targets, if there are any."""
        near = self._random.nearest_to_arms(arms_near_all(self._task), 1)
        if not len(near):
            return None
        shapes = self._random.shapes.take(near)
        return refine_the_best(self._task, shapes, _LED, _GO_ON, self._watch.is_up)

    def drawn(self, most: int) -> Shapes:
        """Return fresh shapes, at random of so many of the best."""
        return self._random.shapes.take(self._any(_REFINED, most))

    def _any(self, count: int, most: int) -> NDArray[np.intp]:
        return self._rng.choice(self._order[:most], min(count, most, self.count), replace=False)


class _Distinct:
    """Start points that differ from those before.

    Args:
        task: The task.
    """

    def __init__(self, task: Task) -> None:
        self._task = task
        self._poses: list[FloatArray] = []
        self._costs: list[float] = []
        self._kinds = Counter[float]()

    def of(self, refined: Refined) -> Iterator[Start]:
        """Yield starts in the order of their costs, m^2, except those that are nearly one yielded before."""
        shapes, base, yielded = refined.shapes, self._task.base, 0
        poses = shapes.poses if shapes.places is None else np.hstack([shapes.poses, shapes.bases.rows])
        as_good = min(_SETTLED, _SETTLED_PART * float(self._task.tolerances.min())) ** 2
        cost = np.maximum(refined.cost, as_good)
        # Shapes that miss alike are mostly one surface, bent in several ways.
        kinds = np.round(np.log(cost) / _ALIKE)
        for index in np.lexsort([shapes.bending, cost]):
            kind, settled = float(kinds[index]), cost[index] <= as_good
            is_near_a_better_one = any(
                np.linalg.norm(pose - poses[index]) < _DISTINCT and cost[index] >= (1.0 - _BETTER) * before
                for pose, before in zip(self._poses, self._costs, strict=True)
            )
            if is_near_a_better_one or (
                not settled and self._kinds[kind] >= _OF_A_KIND[self._task.objective]
            ):
                continue
            self._kinds[kind] += 1
            self._poses.append(poses[index])
            self._costs.append(float(cost[index]))
            yield Start(shapes.arm(index, base), refined.joints[index], float(refined.cost[index]))
            yielded += 1
            if yielded == _MOST_STARTS[self._task.objective]:
                return
