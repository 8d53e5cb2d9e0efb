"""The valleys of the objective, where no shape meets all targets: which of them is the lowest?

There is about one valley for each way in which the targets may lie on the near or the far side of the
surface. Three kinds of steps lead from those known to others, in turn:

* bending the best shapes a little at random: most valleys are beside a better one;
* giving a few targets of the best shapes another angle of joint 2: where the workspace has two sheets
  close together, no small step moves a target from one to the other;
* fresh shapes that know nothing of the others: they find what is far from all of these.

Fresh starts also tell when it is enough. If many of them end in the same best valley, there hardly is a
better one that is so narrow that all of them missed it.
"""

from __future__ import annotations

from dataclasses import field, replace
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import frozen_value
from synth.synthesis.shapes import overlaps
from synth.synthesis.starts.refined import Refined, meets_all, weighed
from synth.synthesis.starts.refinement import cleared, level, refine, refine_the_best
from synth.task import Objective

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.synthesis.shapes import Shapes
    from synth.task import Task
    from synth.watch import Watch

_ROUNDS = 10  # of the three steps
_IDLE, _GAIN = 5, 2e-4  # rounds without a gain, of the least cost, after which there is no other
_KEPT = 400  # shapes
_PARENTS = 20  # of these, which miss differently
_BEST_PARENTS = 2  # to whom half of the children go
_CHILDREN = 10  # of each
_SIZES = (0.03, 0.1, 0.3)  # of the bends, in units of the largest curvature
_LENGTHS = 0.05  # m for a bend of that size, by which lengths change
_MOST_SWAPPED = 2  # targets that get another angle of joint 2
_BENT = 10  # iterations of bent shapes
_SWAPPED = (4, 8)  # of swapped ones, at first on the branches they were given
_FRESH = (5, 15)  # of fresh ones, of which only some go on
_GO_ON = 4  # one in so many, the best
_ALIKE = 0.01  # costs that differ by less than this part are those of one valley, bent in several ways
# It is enough if so many shapes meet all targets, or if so many fresh ones, and such a share, end alike.
_ENOUGH = 5
_DRAWN, _AGREEING = 150, 0.05
# Or, of however few, if so many shapes that algebra led ended alike, and such a share of the fresh ones.
_LED, _AGREEING_TOGETHER = 2, 0.15
_SAME = 1e-3  # part of the least cost by which those differ at most
# But with a cost below this, m^2, the workspace may have two sheets so close together that most shapes end
# with some targets on the wrong one.
_SHEETS = 4e-6
_TINY = 1e-14  # m^2
_CLEARED = 24  # shapes that are moved out of obstacles
_OF_A_KIND = 4
_LEVELLED = 48  # valleys whose least worst miss is looked for


@frozen_value
class Valleys:
    """What is known of the valleys of a task.

    Attributes:
        task: The task.
        watch: When it is up every step ends with what there is.
        best: The best shapes.
        fresh: Where the best of the shapes ended that know nothing of each other: mean squared misses, m^2.
        drawn: How many of these there were.
        led: Where shapes near arms from algebra ended: mean squared misses, m^2.
    """

    task: Task
    watch: Watch = field(compare=False)
    best: Refined
    fresh: FloatArray
    drawn: int
    led: FloatArray

    @classmethod
    def of(cls, task: Task, fresh: Refined, led: Refined | None, watch: Watch) -> Valleys:
        """Return what refined shapes tell.

        Args:
            task: The task.
            fresh: Shapes that know nothing of each other.
            led: Shapes that began near arms from algebra, if there are any.
            watch: When it is up every step ends with what there is.
        """
        fresh = weighed(task, fresh, watch)
        if led is None:
            return cls(task, watch, fresh, fresh.cost, len(fresh.cost), np.empty(0))
        led = weighed(task, led, watch)
        best = Refined.joined([fresh, led])
        return cls(task, watch, best, fresh.cost, len(fresh.cost), led.cost)

    def joined(self, fresh: Refined, drawn: int | None = None) -> Valleys:
        """Return what is known with more fresh shapes, refined: all drawn, or the best of so many."""
        fresh = weighed(self.task, fresh, self.watch)
        return replace(
            self,
            best=Refined.joined([self.best, fresh]),
            fresh=np.concatenate([self.fresh, fresh.cost]),
            drawn=self.drawn + (drawn or len(fresh.cost)),
        )

    @property
    def promising(self) -> Refined:
        """The best shapes, moved out of obstacles; for minimax, with the least worst miss they can have."""
        best = self._out_of_obstacles()
        if self.task.objective is Objective.LEAST_SQUARES:
            return best
        some = best.take(_some_of_each_kind(best, 1)[:_LEVELLED])
        return weighed(self.task, level(self.task, some, self.watch.is_up), self.watch)

    @property
    def within_tolerance(self) -> Refined:
        """The promising shapes that may meet all targets: they do so in the mean."""
        promising = self.promising
        near = promising.cost <= float(self.task.tolerances.min()) ** 2
        return promising.take(np.flatnonzero(near))

    def _out_of_obstacles(self) -> Refined:
        best, is_up = self.best.best(_CLEARED), self.watch.is_up
        deep = np.flatnonzero(overlaps(self.task, best.shapes, best.joints, is_up=is_up).any(axis=1))
        if not len(deep) or is_up():
            return self.best
        moved = weighed(self.task, cleared(self.task, best.take(deep), is_up), self.watch)
        return self.best if is_up() else Refined.joined([self.best, moved])

    @property
    def agreed(self) -> bool:
        """Whether enough shapes meet all targets, or enough of them ended in the best valley.

        Of fewer fresh ones that is enough where algebra leads there, too: it knows nothing of them.
        """
        if np.count_nonzero(meets_all(self.task, self.best)) >= _ENOUGH:
            return True
        same = (1.0 + _SAME) * self.best.cost.min()
        by_fresh, by_algebra = (int(np.count_nonzero(ended <= same)) for ended in (self.fresh, self.led))
        alone = self.drawn >= _DRAWN and by_fresh >= max(_AGREEING * self.drawn, _ENOUGH)
        together = by_algebra >= _LED and by_fresh >= _AGREEING_TOGETHER * self.drawn
        squares = self.task.objective is Objective.LEAST_SQUARES
        return float(self.best.cost.min()) > _SHEETS and (alone or (squares and together))

    def explored(self, draw: Callable[[], Shapes], rng: np.random.Generator) -> Valleys:
        """Return what is known after a search for better valleys.

        Args:
            draw: Draws fresh shapes.
            rng: Source of randomness.
        """
        now, idle = replace(self, best=self.best.best(_KEPT)), 0
        for _ in range(_ROUNDS):
            before = float(now.best.cost.min())
            for step in (_bent, _swapped):
                if now.agreed or self.watch.is_up():
                    return now
                self.watch.tell(phase="looking among valleys")
                children = step(self.task, now.best.take(_parents(now.best)), rng, self.watch)
                now = now.with_better(children)
            now = now.with_fresh(draw())
            idle = idle + 1 if now.best.cost.min() > (1.0 - _GAIN) * before else 0
            if idle == _IDLE and now.best.cost.min() > _SHEETS:
                return now
        return now

    def with_fresh(self, shapes: Shapes) -> Valleys:
        """Return what is known with some more fresh shapes, the worst of which are given up half-way."""
        refined = refine_the_best(self.task, shapes, _FRESH, _GO_ON, self.watch.is_up)
        return self.joined(refined, len(shapes.length)).with_the_best_kept()

    def with_better(self, refined: Refined) -> Valleys:
        """Return what is known with more shapes, of which the best are kept."""
        return replace(self, best=Refined.joined([self.best, refined])).with_the_best_kept()

    def with_the_best_kept(self) -> Valleys:
        """Return what is known with as many shapes as are worth going on from.

        Where the worst miss counts these are only a few of each valley: the one that is lowest in the smooth
        norm need not be so in the end.
        """
        best = self.best
        if self.task.objective is Objective.MINIMAX:
            best = best.take(_some_of_each_kind(best, _OF_A_KIND))
        return replace(self, best=best.best(_KEPT))


def _bent(task: Task, parents: Refined, rng: np.random.Generator, watch: Watch) -> Refined:
    """Return shapes after bending them at random by a little or more."""
    bent = parents.shapes.varied(_SIZES, _LENGTHS, rng)
    return weighed(task, refine(task, bent, iterations=_BENT, near=True, is_up=watch.is_up), watch)


def _swapped(task: Task, parents: Refined, rng: np.random.Generator, watch: Watch) -> Refined:
    """Return shapes after giving one or two targets of each another angle of joint 2."""
    limits, theta2 = task.robot.joint_limits.second, parents.joints[..., 1]
    swapped = rng.integers(1, _MOST_SWAPPED + 1, (len(theta2), 1))
    chosen = np.argsort(rng.uniform(size=theta2.shape), axis=1) < swapped
    angles = np.where(chosen, rng.uniform(limits.lower, limits.upper, theta2.shape), theta2)
    first, last = _SWAPPED
    led = refine(task, parents.shapes, angles, iterations=first, is_up=watch.is_up)
    led = refine(task, led.shapes, iterations=last, near=True, is_up=watch.is_up)
    return weighed(task, led, watch)


def _parents(refined: Refined) -> NDArray[np.intp]:
    """Return the best shapes in order, many times over, except those that miss like an earlier one."""
    different = _some_of_each_kind(refined, 1)
    children = _PARENTS * _CHILDREN
    return np.concatenate(
        [np.resize(different[:_PARENTS], children // 2), np.resize(different[:_BEST_PARENTS], children // 2)]
    )


def _some_of_each_kind(refined: Refined, count: int) -> NDArray[np.intp]:
    """Return the best shapes in order, of those that miss alike at most `count`."""
    order = np.argsort(refined.cost, kind="stable")
    kinds = np.round(np.log(refined.cost[order] + _TINY) / _ALIKE)
    _, first, kind = np.unique(kinds, return_index=True, return_inverse=True)
    return np.asarray(order[np.arange(len(order)) - first[kind] < count])
