"""One run of `solve`: a search, a proof, and what both are worth, in order and in words."""

from __future__ import annotations

import math
import traceback
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from synth.errors import in_a_line
from synth.synthesis.bound import Bound, why_impossible
from synth.synthesis.present_shape import changing_little
from synth.synthesis.searching import ALTERNATIVES, Search
from synth.synthesis.solution import Solution, Status, message, note_on_ways, why_no_better
from synth.synthesis.wanted import Design, best_of
from synth.synthesis.whole import WholeTask, looked_through, only_proven, verified_in_time, without_partial

if TYPE_CHECKING:
    from collections.abc import Iterator

    from synth.robot import BasePlaces
    from synth.task import Task
    from synth.watch import Watch

_PROVEN_IN_TIME = 50_000  # targets: whether each of more is within reach takes a second or longer
_AS_LONG = 30_000  # targets that are looked at in the time of the search for a part of them
_LEAST_SEARCH = 0.2  # of all the time, which is left to the search however many there are


@dataclass
class Run:
    """One run of `solve`.

    Attributes:
        task: The task.
        part: The same with the part of its targets that is searched with.
        seed: Seed of the search.
        watch: Its time.
        alternatives: As for `solve`.
        complete: Whether the search came to its end; a proof may be cut short all the same.
        bound: What was proven.
        broke_off: What broke that nobody foresaw.
        notes: What else is to be said.
        places: Where the base could be made to stand; `task` has it at the one of these that was chosen.
        elsewhere: Whether another place, of which there is no run, may do what this one cannot.
        others: The runs at other places and with other rigid links, of which this one was chosen.
    """

    task: Task
    part: Task
    seed: int
    watch: Watch
    alternatives: int = ALTERNATIVES
    complete: bool = False
    bound: Bound | None = None
    broke_off: Exception | None = None
    notes: list[str] = field(default_factory=list)
    places: BasePlaces | None = None
    elsewhere: bool = False
    others: tuple[Run, ...] = ()

    @contextmanager
    def kept(self) -> Iterator[None]:
        """Keep what was found so far where something breaks that nobody foresaw."""
        try:
            yield
        except Exception as error:
            if error is self.watch.raised:  # not ours
                raise
            self.broke_off = self.broke_off or error

    @cached_property
    def search(self) -> Search:
        """The search, with the shapes so far."""
        return Search(
            self.part,
            self.seed,
            self.watch,
            lambda: bool(self.impossible),
            self.alternatives,
            sees_all=self.sees_all,
        )

    @cached_property
    def impossible(self) -> tuple[str, ...]:
        """Why no shape can do the task where the base stands, as far as that is known at once."""
        # What proves that a part is out of reach proves it of all, and is sooner done.
        limited = self.watch.remaining < math.inf and len(self.task.targets) > _PROVEN_IN_TIME
        asked = without_partial(self.part if limited else self.task)
        return () if asked is None else why_impossible(asked)

    @property
    def excluded(self) -> tuple[str, ...]:
        """Why no shape can do the task with this place and rigid link, as far as that is proven."""
        proven = self.bound is not None and self.bound.excludes
        return self.impossible or ((self._bound.sentence,) if proven and self._bound is not None else ())

    @property
    def _bound(self) -> Bound | None:
        """What is proven of all shapes, with whatever place and rigid link there is a choice of."""
        bounds = [run.bound for run in (self, *self.others)]
        return Bound.least_of([each for each in bounds if each is not None]) if all(bounds) else None

    def look_beside(self, alternatives: int) -> None:
        """Look for other shapes that a person would rather have, where one does what is searched for."""
        with self.kept(), self.watch.keeping_back(self.kept_back):
            self.search.look_beside(alternatives)
            self.__dict__.pop("whole", None)  # what was known of fewer shapes

    @property
    def sees_all(self) -> bool:
        """Whether the search knows all that is asked: all targets, and nothing between them."""
        return self.part is self.task and not (self.task.surfaces or self.task.paths)

    @property
    def was_looked_through(self) -> bool:
        """Whether it is known what its shapes do of all that is asked."""
        return "whole" in self.__dict__

    @property
    def does_all(self) -> bool:
        """Whether a shape does all that is asked, and not only the part that is searched with."""
        found = self.search.polishing.found
        if found and not self.sees_all:
            found = False
            with self.kept():
                found = any(design.verification.found for design in self.whole.designs[:1])
        return found

    @cached_property
    def whole(self) -> WholeTask:
        """What was found, for all targets; what is searched for later is not in it."""
        found = self.search.polishing.designs
        known = [*found, *changing_little(self.part, found, self.seed, self.watch)]
        whole = looked_through(self.task, self.part, known, self.seed, self.watch)
        self.search.polishing.blocked.extend(whole.blocked)
        return whole

    @property
    def _why_broken(self) -> tuple[str, ...]:
        return () if self.broke_off is None else (f"the search broke off: {in_a_line(self.broke_off)}",)

    @property
    def kept_back(self) -> float:
        """Which share of the time the search leaves for looking at all targets."""
        count = len(self.task.targets)
        return 0.0 if self.part is self.task else min(count / (count + _AS_LONG), 1.0 - _LEAST_SEARCH)

    def solution(self) -> Solution:
        """Rank what was found and say what it is worth."""
        whole = WholeTask(self.task)
        with self.kept():
            whole = self.whole
        if self.broke_off is not None and not whole.designs:
            with self.kept():
                for one in best_of(self.part, self.search.polishing.designs)[:1]:
                    seen, design = verified_in_time(self.task, one.arm, self.watch)
                    whole = WholeTask(seen, (design,) if design.verification.possible else ())
        task, designs = whole.task, tuple(only_proven(whole.task, each) for each in whole.designs)
        whole = replace(whole, designs=designs)
        status, reasons = Status.FAILED, tuple[str, ...]()
        with self.kept():
            status, reasons = _verdict(self, whole)
        words = status.sentence
        with self.kept():
            words = message(task, status, designs, (*self._why_broken, *reasons))
        no_time = note_on_ways(designs, interrupted=self.watch.interrupted)
        return Solution(
            replace(task, places=self.places),
            status,
            words,
            (*self._why_broken, *reasons),
            self.seed,
            designs,
            self.search.starts,
            self.watch.timing(),
            self._bound if self.part is self.task else bound_of_all(self._bound, task, designs),
            notes=(*self.notes, *filter(None, [whole.note, no_time])),
            breakdown="".join(traceback.format_exception(self.broke_off)) if self.broke_off else "",
        )


def bound_of_all(bound: Bound | None, task: Task, designs: tuple[Design, ...]) -> Bound | None:
    """Return a bound that was proven for a part of the targets, with what was found for all of them."""
    if bound is None:
        return None
    relative = [float(np.max(design.verification.misses / task.tolerances)) for design in designs]
    return replace(bound, best_found=bound.tightest_tolerance * min(relative, default=math.inf))


def _verdict(run: Run, whole: WholeTask) -> tuple[Status, tuple[str, ...]]:
    """Return how the search ended, and why it found no more, as far as that is known."""
    designs = whole.designs
    if designs and designs[0].verification.found:
        return Status.FOUND, ()
    if run.broke_off is not None:
        return Status.FAILED, ()
    if all(each.excluded and not each.elsewhere for each in (run, *run.others)):
        return Status.PROVEN_IMPOSSIBLE, run.excluded
    if run.search.polishing.breakdowns and not (run.search.polishing.designs or run.search.polishing.blocked):
        return Status.FAILED, tuple(run.search.polishing.breakdowns[:1])
    cut_short = run.watch.interrupted and not run.complete
    status = Status.LIMIT if cut_short or whole.unseen else Status.BEST_EFFORT
    asked = replace(run.task, places=run.places)
    return status, why_no_better(asked, designs, run.search.polishing.blocked)
