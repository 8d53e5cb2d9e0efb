"""The search for shapes: start points, polished until enough is found."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

from synth.synthesis.searching.polishing import Polishing
from synth.synthesis.shapes import in_equal_arcs
from synth.synthesis.starts import Start, start_points
from synth.synthesis.wanted import (
    Design,
    has_all_ways,
    leaves_no_wish,
    may_be_met,
    objective,
    wished,
)
from synth.task import Objective

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from synth.synthesis.wanted import Design
    from synth.task import Task
    from synth.watch import Watch

_STARTS_AT_MOST = 48
_STARTS_WHEN_IMPOSSIBLE = 12  # for a good best effort
_FOLLOWED = 2  # shapes of a neighbour that are polished
ALTERNATIVES = 2  # shapes looked for after one was found, or else starts polished
_LOOKED_AT = 4  # shapes that a person would want, for each alternative
_MORE = 2  # than the alternatives, with all ways, of which none need leave nothing to wish for
_ALTERNATIVES_THAT_MISS = 2  # likewise, at most, where no shape meets all targets
_NEXT_TO_NOTHING = 0.02  # of the tightest tolerance: a start that misses no more is not polished
_GAIN = 1e-3  # of the objective: the least that is worth another start
_LATE = 0.2  # s after the time is up, from when on not even unpolished starts are looked at


class Search:
    """Looks for shapes, and keeps them.

    Args:
        task: The task, of few targets.
        seed: Seed of the random shapes.
        watch: When it is up, the search ends.
        is_impossible: Tells whether it is known that no shape can do the task.
        alternatives: As for `solve`.
        sees_all: Whether the task is all that is asked. If not, starts that reach all of it are polished,
            too: leaning on limits they may do less between its targets.

    Attributes:
        polishing: The shapes so far.
        starts: How many start points were polished.
    """

    def __init__(
        self,
        task: Task,
        seed: int,
        watch: Watch,
        is_impossible: Callable[[], bool],
        alternatives: int = ALTERNATIVES,
        *,
        sees_all: bool = True,
    ) -> None:
        self._task, self._seed, self._watch, self._sees_all = task, seed, watch, sees_all
        self._is_impossible, self._alternatives = is_impossible, alternatives
        self.polishing = Polishing(task, watch)
        self.starts = 0
        self._since_found = 0  # starts polished since a shape was found, that start included

    def follow(self, designs: Sequence[Design]) -> bool:
        """Polish the best shapes for a task nearby; whether one of them reaches every target."""
        for design in designs[:_FOLLOWED]:
            arm = in_equal_arcs(replace(design.arm, robot=self._task.robot, base=self._task.base))
            self.polishing.polish(Start(arm, arm.closest_joints(self._task.table.positions)[0]), near=True)
            self.starts += 1
            if self.polishing.found or self._watch.is_up():
                break
        return self.polishing.found

    def look_beside(self, alternatives: int) -> None:
        """Where a shape reaches every target, look for others that a person would rather have."""
        self._alternatives = alternatives
        if self.polishing.found and alternatives and not self._watch.is_up():
            self._wished_for()

    def run(self, most: int | None = None) -> None:
        """Polish start points until enough is found, or the time is up; if `most`, quick ones, so many."""
        self._run(most)
        if self._may_be_met(self.polishing.designs):
            polishing = self.polishing.by_worst
            search = Search(
                polishing.task,
                self._seed,
                self._watch,
                self._is_impossible,
                self._alternatives,
                sees_all=self._sees_all,
            )
            search.polishing = polishing  # what it finds stands with the other shapes
            search.run(most)
            self.starts += search.starts

    def _may_be_met(self, designs: Sequence[Design]) -> bool:
        """Whether a target is missed that may be reached if others are missed by more, and there is time."""
        if self.polishing.found or self._task.is_partial or self._watch.is_up():
            return False
        return may_be_met(self._task, designs)

    def _run(self, most: int | None) -> None:
        usual = _STARTS_WHEN_IMPOSSIBLE if self._is_impossible() else _STARTS_AT_MOST
        at_most = self.starts + (most or usual)
        no_better = 0
        quick = most is not None or self._is_impossible()
        starts = start_points(self._task, self._seed, quick=quick, watch=self._watch)
        for start in _watched(starts, self._watch):
            if self._watch.is_up():
                # A start that was not polished is better than nothing.
                if not self.polishing.designs:
                    self.polishing.keep(start.arm, start.joints)
                enough = len(self.polishing.blocked) >= _STARTS_WHEN_IMPOSSIBLE
                if self.polishing.designs or enough or self._watch.overdue > _LATE:
                    return
                continue
            if not self._may_be_better(start):
                no_better += 1
                if no_better > min(_ALTERNATIVES_THAT_MISS, self._alternatives):
                    continue
            self.polish(start)
            self._watch.tell(**_progress(self.polishing, self.starts, at_most))
            if self._since_found == 1 and self._alternatives and self._wished_for():
                return
            if self.starts >= at_most or self._since_found > self._alternatives:
                return

    def polish(self, start: Start) -> None:
        """Polish one start point; where it leads astray, again: nearer, by squares, by the worst miss."""
        if not self.polishing.found and _promises_all(self._task, start):  # else polished ones are gentler
            found = self.polishing.keep(start.arm, start.joints).verification.found
            if found and self._sees_all and start.relative_miss(self._task) <= _NEXT_TO_NOTHING:
                self.starts += 1
                self._since_found += 1
                return
        self.polishing.polish(start)
        # Its long first steps may have led away from a start that is nearly an answer.
        squares = self._task.objective is Objective.LEAST_SQUARES
        astray = squares and not self.polishing.found and self._may_be_better(start)
        if astray and self.polishing.keep(start.arm, start.joints).verification.possible:
            self.polishing.polish(start, near=True)
        if not self.polishing.found and _passes_all(self._task, start):  # and polishing lost them
            if self._task.objective is Objective.MINIMAX:  # the sum of squares is the smoother one
                self.polishing.by_squares.polish(start, near=True)
            if not self.polishing.found:  # a start that is an answer is better than what polishing made of it
                self.polishing.keep(start.arm, start.joints)
        last = self.polishing.designs[-1:]
        if self._may_be_met(last):
            self.polishing.by_worst.polish(Start(last[0].arm, last[0].verification.joints), near=True)
        self.starts += 1
        self._since_found += self.polishing.found

    def _wished_for(self) -> bool:
        """Look for shapes that a person would rather have than the first one; whether there are any."""
        known = [design.arm for design in self.polishing.designs if design.verification.found]
        found, wanted, passable = 0, 0, 0
        candidates = wished(self._task, known, self._seed, self._watch.is_up)
        for _ in range(_LOOKED_AT * self._alternatives):
            with self._watch.on("solving"):
                candidate = next(candidates, None)
            if candidate is None or self._watch.is_up():
                break
            design = self.polishing.keep(*candidate, stay=True)
            if design.verification.found:
                found += 1
                wanted += leaves_no_wish(design.figures)  # by its ways, not only by where they end
                passable += has_all_ways(design.figures)
                if found == 1:  # the most wanted one may be had with a gentler bend
                    self.polishing.polish(Start(design.arm, design.verification.joints), near=True)
            if wanted == self._alternatives or passable == self._alternatives + _MORE:
                break
        return found > 0

    def _may_be_better(self, start: Start) -> bool:
        """Whether a start may lead to a better shape than the best."""
        designs = self.polishing.designs
        certain = not designs or self.polishing.found or self._is_impossible()
        return certain or _promises_less(self._task, start, designs)


def _watched(starts: Iterator[Start], watch: Watch) -> Iterator[Start]:
    """Yield start points; the time that looking for them takes is that of the screening."""
    while True:
        with watch.on("screening"):
            start = next(starts, None)
        if start is None:
            return
        yield start


def _promises_less(task: Task, start: Start, designs: Sequence[Design]) -> bool:
    """Return whether the valley of a start is not above the best of some shapes.

    For targets far out of reach the refinement, which takes misses for small, does not say how low it is.
    """
    least = start.cost / float(task.tolerances.min()) ** 2  # in the mean, so also of the worst
    if task.objective is Objective.LEAST_SQUARES:
        least *= len(task.targets)
    return least < (1.0 - _GAIN) * min(objective(task, design) for design in designs)


def _passes_all(task: Task, start: Start) -> bool:
    """Return whether a start passes through all targets, whatever limits it breaks."""
    return bool((start.misses(task) <= task.tolerances).all())


def _promises_all(task: Task, start: Start) -> bool:
    """Return whether a start may reach every target as it is, and better than what the program makes of it.

    It may reach them all but exactly; and among obstacles the program may lose it.
    """
    return start.relative_miss(task) <= (1.0 if task.solids else _NEXT_TO_NOTHING)


def _progress(polishing: Polishing, starts: int, at_most: int) -> dict[str, object]:
    """Return what is told of the search after each start point."""
    misses = (float(design.verification.misses.max()) for design in polishing.designs)
    return {
        "starts": starts,
        "starts_at_most": at_most,
        "worst_miss": min(misses, default=math.inf),
        "found": polishing.found,
        "phase": "polishing shapes",
    }
