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
from synth.synthesis.all_targets import (
    WholeTask,
    for_all_targets,
    led_to_missed,
    only_proven,
    proven_whole,
    verified_in_time,
)
from synth.synthesis.bound import Bound, why_impossible
from synth.synthesis.many_targets import without_partial
from synth.synthesis.present_shape import changing_little
from synth.synthesis.proving import Certifier
from synth.synthesis.search import ALTERNATIVES, Search
from synth.synthesis.solution import Solution, Status, message, note_on_ways, why_no_better
from synth.synthesis.wanted import Design, best_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from synth.robot import BasePlaces
    from synth.task import Task
    from synth.watch import Watch

_PROOF_TIME = 60.0  # s
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
        return Search(self.part, self.seed, self.watch, lambda: bool(self.impossible), self.alternatives)

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

    @property
    def kept_back(self) -> float:
        """Which share of the time the search leaves for looking at all targets."""
        count = len(self.task.targets)
        return 0.0 if self.part is self.task else min(count / (count + _AS_LONG), 1.0 - _LEAST_SEARCH)

    def solution(self) -> Solution:
        """Rank what was found and say what it is worth."""
        whole = WholeTask(self.task)
        with self.kept():
            known = [
                *self.search.polishing.designs,
                *changing_little(self.part, self.search.polishing.designs, self.seed, self.watch),
            ]
            best = best_of(self.part, known, self.watch.is_up)
            whole = self._whole(best if self.part is self.task else _and_others(best, known))
        if self.broke_off is not None and not whole.designs:
            with self.kept():
                for one in best_of(self.part, self.search.polishing.designs)[:1]:
                    seen, design = verified_in_time(self.task, one.arm, self.watch)
                    whole = WholeTask(seen, (design,) if design.verification.possible else ())
        task, designs = whole.task, tuple(only_proven(whole.task, each) for each in whole.designs)
        whole = replace(whole, designs=designs)
        status, reasons = Status.FAILED, tuple[str, ...]()
        with self.kept():
            status, reasons = self._verdict(whole)
        words = status.sentence
        with self.kept():
            words = message(task, status, designs, (*self._why_broken(), *reasons))
        no_time = note_on_ways(designs, interrupted=self.watch.interrupted)
        return Solution(
            replace(task, places=self.places),
            status,
            words,
            (*self._why_broken(), *reasons),
            self.seed,
            designs,
            self.search.starts,
            self.watch.timing(),
            self._bound if self.part is self.task else bound_of_all(self._bound, task, designs),
            notes=(*self.notes, *filter(None, [whole.note, no_time])),
            breakdown="".join(traceback.format_exception(self.broke_off)) if self.broke_off else "",
        )

    def _why_broken(self) -> tuple[str, ...]:
        return () if self.broke_off is None else (f"the search broke off: {in_a_line(self.broke_off)}",)

    def _whole(self, designs: tuple[Design, ...]) -> WholeTask:
        """Return designs for a part of the targets as designs for all."""
        whole = WholeTask(self.task, designs)
        if self.part is not self.task:
            whole = for_all_targets(self.task, designs, self.seed, self.watch)
            self.search.polishing.blocked.extend(whole.blocked)
            whole = led_to_missed(self.part, whole, self.seed, self.watch)
        return proven_whole(self.part, whole, self.seed, self.watch)

    def _verdict(self, whole: WholeTask) -> tuple[Status, tuple[str, ...]]:
        """Return how the search ended, and why it found no more, as far as that is known."""
        designs = whole.designs
        if designs and designs[0].verification.found:
            return Status.FOUND, ()
        if self.broke_off is not None:
            return Status.FAILED, ()
        if all(run.excluded and not run.elsewhere for run in (self, *self.others)):
            return Status.PROVEN_IMPOSSIBLE, self.excluded
        if self.search.polishing.breakdowns and not (
            self.search.polishing.designs or self.search.polishing.blocked
        ):
            return Status.FAILED, tuple(self.search.polishing.breakdowns[:1])
        cut_short = self.watch.interrupted and not self.complete
        status = Status.LIMIT if cut_short or whole.unseen else Status.BEST_EFFORT
        asked = replace(self.task, places=self.places)
        return status, why_no_better(asked, designs, self.search.polishing.blocked)


def _and_others(best: tuple[Design, ...], known: Sequence[Design]) -> tuple[Design, ...]:
    """Return designs, and behind them those that are like one of them for a part of the targets.

    For all targets they may not be: one has its dead zone where no target is, or nearly so.
    """
    taken = {id(design.arm) for design in best}
    return (*best, *(design for design in known if id(design.arm) not in taken))


def prove_run(run: Run) -> None:
    """Bound how little any shape can miss, unless the search was stopped already.

    Args:
        run: The run, whose search is over; the bound is of what was not chosen, too.
    """
    if run.watch.interrupted:
        run.notes.append("nothing was proven: the search was stopped before")
        return
    if run.task.is_partial:
        run.notes.append("nothing was proven: which part of a surface is left is not bounded")
        return
    if not run.task.robot.rigid_link.is_fixed:
        run.notes.append("nothing was proven: a rigid link in ranges is not bounded, one of given lengths is")
        return
    run.complete = True
    watch, stopped = run.watch.within(_PROOF_TIME), False
    with run.watch.on("proving"):
        own = _certifier(run, watch)
        known = own.search()
        # What is not to be chosen is soon excluded, mostly; the time that is left is for what was.
        for number, other in enumerate(run.others):
            share = watch.within(watch.remaining / (len(run.others) + 1 - number))
            other.bound = _certifier(other, share).bound(known)
            known = known if other.bound is None else other.bound.best_found
            stopped |= share.interrupted
        run.bound = own.bound(known)
    if stopped or watch.interrupted:
        run.notes.append("the proof was stopped early: more time may prove more")
    if run.elsewhere and run.bound is not None and run.bound.lower_bound > 0.0:
        run.notes.append("what is proven holds where the base was found to stand")


def _certifier(run: Run, watch: Watch) -> Certifier:
    return Certifier(
        run.part,
        float(run.task.tolerances.min()),
        run.search.polishing.designs,
        run.search.polishing.keep,
        watch,
        run.seed,
    )


def bound_of_all(bound: Bound | None, task: Task, designs: tuple[Design, ...]) -> Bound | None:
    """Return a bound that was proven for a part of the targets, with what was found for all of them."""
    if bound is None:
        return None
    relative = [float(np.max(design.verification.misses / task.tolerances)) for design in designs]
    return replace(bound, best_found=bound.tightest_tolerance * min(relative, default=math.inf))
