"""Branch and bound over all shapes: a certificate of how little any of them can miss."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from synth.rounding import Unit, at_least, rounded_up
from synth.synthesis.bound.boxes import Boxes
from synth.synthesis.bound.impossibility import longest_rigid_link
from synth.synthesis.bound.limits import SLACK
from synth.synthesis.bound.misses import MissBounds
from synth.synthesis.bound.promising import Promising
from synth.task import Topology

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.synthesis.bound.ends import LinkEnd
    from synth.task import Task
    from synth.watch import Watch

# Taken off every bound, m for each metre of the robot's size: see "Rounding" in docs/bound.md.
_ROUNDING = 1e-9
_BATCH = 512
_WHOLE_TURN = 2.0 * math.pi - 1e-9  # rad
_BOXES_AT_MOST = 2_000_000  # open at a time, some 200 bytes each
# Bounds from this many of the targets hold for all of them.
_TARGETS = 12
_TOLD = 1e-6  # m; a smaller bound is no news
_CLOSED = 2e-4  # m; of a larger gap it is told what it may be due to


@dataclass(frozen=True)
class Bound:
    """What is proven of the worst miss over all shapes that the hardware allows.

    With w the tightest tolerance over that of each target (1 for all if they are equal), the worst weighted
    miss of a shape is the largest w * miss over the targets. No shape has a smaller one than `lower_bound`.

    Attributes:
        lower_bound: Lower bound of the worst weighted miss, m.
        best_found: The least worst weighted miss of all shapes that were found, m; infinite if none was.
        tightest_tolerance: The tightest tolerance of the targets, m.
        boxes: How many boxes of shapes were looked at.
        left_out: What the task limits and the proof does not know, in words: the gap may be due to it.
        weighted: Whether the tolerances differ, so that weighted misses are no plain ones.
    """

    lower_bound: float
    best_found: float
    tightest_tolerance: float
    boxes: int
    left_out: tuple[str, ...] = ()
    weighted: bool = False

    @classmethod
    def least_of(cls, bounds: Sequence[Bound]) -> Bound:
        """Return what is proven of all shapes, where each is bounded by one of several bounds of a task.

        Args:
            bounds: Bounds of one task, one at least.
        """
        return replace(
            bounds[0],
            lower_bound=min(bound.lower_bound for bound in bounds),
            best_found=min(bound.best_found for bound in bounds),
            boxes=sum(bound.boxes for bound in bounds),
            left_out=tuple(dict.fromkeys(word for bound in bounds for word in bound.left_out)),
        )

    @property
    def gap(self) -> float:
        """By how much the best shape found may be worse than the best there is, m."""
        return self.best_found - self.lower_bound

    @property
    def excludes(self) -> bool:
        """Whether it proves that no shape has all targets within their tolerances."""
        return self.lower_bound > self.tightest_tolerance

    @property
    def sentence(self) -> str:
        """The same for the user."""
        return self._told("the least worst miss found", self.best_found)

    def sentence_of_shape(self, worst: float) -> str:
        """Return the same of one shape, which need not be that of the least worst miss.

        Args:
            worst: The worst weighted miss of that shape, m.
        """
        return self._told("the worst miss of this shape", worst)

    def _told(self, whose: str, worst: float) -> str:
        # Bounds rounded down, gaps up: the sentence is to be as true as the numbers.
        proven = []
        if self.lower_bound >= _TOLD:
            proven.append(f"every shape misses some target by {at_least(self.lower_bound, digits=3)}")
        gap = max(worst - self.lower_bound, 0.0)
        if math.isfinite(gap):
            whose += ", each weighed by the tightest tolerance over its own," if self.weighted else ""
            proven.append(f"{whose} is within {rounded_up(gap, digits=3)} mm of the least there is")
        sentence = f"proven: {'; '.join(proven) or 'nothing yet'}"
        if self.left_out and _CLOSED < gap < math.inf:
            may = "they may" if len(self.left_out) > 1 else "it may"
            sentence += f". The proof leaves out {' and '.join(self.left_out)}; {may} be all that the gap is"
        return sentence


def prove(
    task: Task,
    best_found: float,
    misses: FloatArray,
    *,
    tightest: float,
    gap: float = 1e-4,
    watch: Watch,
    improve: Callable[[LinkEnd], float] | None = None,
) -> Bound | None:
    """Bound the worst weighted miss over all shapes that the hardware allows from below.

    The bound leaves out what it cannot use: obstacles, the arm itself, the category asked for, the limits
    of joint 1. So it holds with them, too.

    Args:
        task: The task.
        best_found: The least worst weighted miss that is known to be possible, m.
        misses: The misses of that shape, shape (n,), m: they tell which targets are hard.
        tightest: The tightest tolerance: a miss counts by it over its target's tolerance, m.
        gap: The proof ends when the bound is as near as this to `best_found`, m.
        watch: Told the bound so far, many times a second; when it is up, that one is returned.
        improve: Looks for a shape whose link ends about so, which promises less than the best found, and
            returns the worst weighted miss of the best shape now, m.

    Returns:
        The bound; None if the rigid link is not fixed.
    """
    if not task.robot.rigid_link.is_fixed:
        return None
    factors = tightest / task.tolerances
    weighted = bool(np.any(factors != factors[0]))
    size = (
        task.robot.link.length.upper
        + longest_rigid_link(task.robot)
        + float(np.abs(task.positions_in_base).max())
    )
    rounding = _ROUNDING * size
    wanted = gap - rounding
    enough = best_found - wanted
    if not enough > 0.0:
        return Bound(0.0, best_found, tightest, 0, _left_out(task), weighted)
    if math.isinf(enough):  # nothing was found: then to know that it is impossible is all
        enough = 1.1 * tightest + gap
    chosen = _hardest(task.positions_in_base, factors * misses)
    bounds = MissBounds(task, chosen, factors[chosen])
    link, d12 = bounds.limits.link, task.robot.d12
    lowest = d12 - link.length.upper
    lowest = max(lowest, bounds.limits.lowest_end - SLACK)
    boxes = Boxes.cover(link.length.upper, (min(lowest, d12), d12 + link.length.upper))
    promising = Promising(bounds)
    count, lower = 0, 0.0
    while len(boxes) and len(boxes) < _BOXES_AT_MOST and not watch.is_up():
        batch = min(_BATCH, len(boxes))
        first = np.zeros(len(boxes), dtype=bool)
        first[np.argpartition(boxes.bound, batch - 1)[:batch]] = True
        halves = boxes.take(first)
        halves = halves.halved(np.argmax(bounds.sides(halves), axis=1))
        left = bounds.evaluate(halves, enough)
        boxes = Boxes.joined([boxes.take(~first), left])
        count += len(halves)
        end = promising.end(left, enough) if improve is not None else None
        if end is not None and improve is not None:
            best_found = min(best_found, improve(end))
            enough = min(enough, best_found - wanted)
            boxes = boxes.take(boxes.bound < enough)
        lower = min(float(boxes.bound.min(initial=enough)), enough)
        watch.tell(worst_miss=math.inf if weighted else best_found, lower_bound=lower, phase="proving")
    return Bound(max(lower - rounding, 0.0), best_found, tightest, count, _left_out(task), weighted)


def _left_out(task: Task) -> tuple[str, ...]:
    """Return what the task limits and the proof does not know, in words."""
    base = task.robot.joint_limits.base
    turn = base.upper - base.lower
    words = []
    if turn < _WHOLE_TURN:
        words.append(f"that joint 1 turns by {rounded_up(turn, Unit.DEG, 0)} deg only")
    if task.solids:
        words.append("the obstacles")
    if task.topology is not Topology.ANY:
        words.append(f"that the shape must be {task.topology.value}")
    return tuple(words)


def _hardest(positions: FloatArray, misses: FloatArray) -> NDArray[np.intp]:
    """Return which targets to look at: half of them by their misses, the others far apart."""
    if len(misses) <= _TARGETS:
        return np.arange(len(misses))
    chosen = list(np.argsort(-misses, kind="stable")[: _TARGETS // 2])
    apart = np.linalg.norm(positions[:, None] - positions[chosen], axis=-1).min(axis=1)
    while len(chosen) < _TARGETS:
        chosen.append(int(np.argmax(apart)))
        apart = np.minimum(apart, np.linalg.norm(positions - positions[chosen[-1]], axis=-1))
    return np.array(chosen)
