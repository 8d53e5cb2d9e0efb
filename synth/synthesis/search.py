"""One run of a synthesis: start points, polished until enough is found, ranked and told."""

from __future__ import annotations

import math
import traceback
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from synth.errors import in_a_line
from synth.robot import ANYWHERE, Interval, links_to_poses
from synth.synthesis.all_targets import WholeTask, for_all_targets, verified_in_time
from synth.synthesis.certificate import Certifier
from synth.synthesis.impossibility import why_impossible
from synth.synthesis.polishing import Polishing
from synth.synthesis.population import in_equal_arcs
from synth.synthesis.ranking import best_of, leaves_no_wish, objective
from synth.synthesis.screening import Start, starts
from synth.synthesis.solution import Design, Solution, Status
from synth.synthesis.verdict import message, why_no_better
from synth.synthesis.verification import verify
from synth.synthesis.wished import wished
from synth.task import Objective

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from synth.synthesis.bound import Bound
    from synth.synthesis.watch import Watch
    from synth.task import Task

_STARTS_AT_MOST = 48
_STARTS_WHEN_IMPOSSIBLE = 12  # for a good best effort
_FOLLOWED = 2  # shapes of a neighbour that are polished
ALTERNATIVES = 2  # shapes looked for after one was found, or else starts polished
_LOOKED_AT = 4  # shapes that a person would want, for each alternative
_ALTERNATIVES_THAT_MISS = 2  # likewise, at most, where no shape meets all targets
_GAIN = 1e-3  # of the objective: the least that is worth another start
_PROOF_TIME = 60.0  # s
_LATE = 0.2  # s after the time is up, from when on not even unpolished starts are looked at
_PROVEN_IN_TIME = 50_000  # targets: whether each of more is within reach takes a second or longer
# So many targets are looked at in the time of the search for a part of them; of all the time it is left some.
_AS_LONG, _LEAST_SEARCH = 30_000, 0.2


@dataclass
class Search:
    """One run of `solve`: the designs so far, for the part of the task that is searched with."""

    task: Task
    part: Task
    seed: int
    watch: Watch
    alternatives: int = ALTERNATIVES
    starts: int = 0
    starts_at_most: int = 0
    starts_found: int = 0  # since a shape was found, that start included
    complete: bool = False  # a proof may be cut short all the same
    bound: Bound | None = None
    broke_off: Exception | None = None
    notes: list[str] = field(default_factory=list)

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
    def polishing(self) -> Polishing:
        """The shapes so far."""
        return Polishing(self.part, self.watch)

    @cached_property
    def _impossible(self) -> tuple[str, ...]:
        # What proves that a part is out of reach proves it of all, and is sooner done.
        limited = self.watch.remaining < math.inf and len(self.task.targets) > _PROVEN_IN_TIME
        return why_impossible(self.part if limited else self.task)

    @property
    def kept_back(self) -> float:
        """Which share of the time the search leaves for looking at all targets."""
        count = len(self.task.targets)
        return 0.0 if self.part is self.task else min(count / (count + _AS_LONG), 1.0 - _LEAST_SEARCH)

    def follow(self, designs: Sequence[Design]) -> bool:
        """Polish the best shapes for a task nearby; whether one of them reaches every target."""
        for design in designs[:_FOLLOWED]:
            arm = in_equal_arcs(replace(design.arm, robot=self.task.robot, base=self.task.base))
            self.polishing.polish(Start(arm, arm.closest_joints(self.part.table.positions)[0]), near=True)
            self.starts += 1
            if self.polishing.found or self.watch.is_up():
                break
        return self.polishing.found

    def run(self, most: int | None = None) -> None:
        """Polish start points until enough is found, or the time is up; if `most`, quick ones, so many."""
        self.starts_at_most = self.starts + (most or self._usual_starts)
        no_better = 0
        for start in self._start_points(quick=most is not None or bool(self._impossible)):
            if self.watch.is_up():
                # A start that was not polished is better than nothing.
                if not self.polishing.designs:
                    self.polishing.keep(start.arm, start.joints)
                enough = len(self.polishing.blocked) >= _STARTS_WHEN_IMPOSSIBLE
                if self.polishing.designs or enough or self.watch.overdue > _LATE:
                    return
                continue
            if not self._may_be_better(start):
                no_better += 1
                if no_better > min(_ALTERNATIVES_THAT_MISS, self.alternatives):
                    continue
            self._polish(start)
            if self.starts_found == 1 and self.alternatives and self._wished_for():
                return
            if self.starts >= self.starts_at_most or self.starts_found > self.alternatives:
                return

    def _polish(self, start: Start) -> None:
        if self._promises_all(start):
            self.polishing.keep(start.arm, start.joints)
        self.polishing.polish(start)
        if self._led_astray(start) and self.polishing.keep(start.arm, start.joints).verification.possible:
            self.polishing.polish(start, near=True)
        if self._lost(start):
            self.polishing.by_squares.polish(start, near=True)
        self.starts += 1
        self.starts_found += self.polishing.found
        self._report()

    def _wished_for(self) -> bool:
        """Look for shapes that a person would rather have than the first one; whether there are any."""
        known = [design.arm for design in self.polishing.designs if design.verification.found]
        found, wanted, candidates = 0, 0, wished(self.part, known, self.seed, self.watch.is_up)
        for _ in range(_LOOKED_AT * self.alternatives):
            with self.watch.on("solving"):
                candidate = next(candidates, None)
            if candidate is None or self.watch.is_up():
                break
            design = self.polishing.keep(*candidate, stay=True)
            if design.verification.found:
                found += 1
                wanted += leaves_no_wish(design.figures)  # by its ways, not only by where they end
            if wanted == self.alternatives:
                break
        return found > 0

    def _promises_all(self, start: Start) -> bool:
        """Whether a start may reach every target as it is, and the program may lose it among obstacles."""
        if not self.part.obstacles:
            return False
        return start.cost <= float(self.part.tolerances.min()) ** 2

    def _may_be_better(self, start: Start) -> bool:
        """Whether a start may lead to a better shape than the best: not if its valley is above that.

        For targets far out of reach the refinement, which takes misses for small, does not say how low it is.
        """
        if not self.polishing.designs or self.polishing.found or self._impossible:
            return True
        least = start.cost / float(self.part.tolerances.min()) ** 2  # in the mean, so also of the worst
        if self.part.objective is Objective.LEAST_SQUARES:
            least *= len(self.part.targets)
        best = min(objective(self.part, design) for design in self.polishing.designs)
        return least < (1.0 - _GAIN) * best

    def _led_astray(self, start: Start) -> bool:
        """Whether polishing may have led away from a start that is nearly an answer, by long first steps."""
        sum_of_squares = self.part.objective is Objective.LEAST_SQUARES
        return sum_of_squares and not self.polishing.found and self._may_be_better(start)

    def _lost(self, start: Start) -> bool:
        """Whether a start passes through all targets, whatever limits it breaks, and its polishing lost them.

        Where every target can be met the objectives agree, and the sum of squares is the smoother one.
        """
        if self.polishing.found or self.part.objective is Objective.LEAST_SQUARES:
            return False
        return bool((start.misses(self.part) <= self.part.tolerances).all())

    def prove(self) -> None:
        """Bound how little any shape can miss, unless the search was stopped already."""
        if self.watch.interrupted:
            self.notes.append("nothing was proven: the search was stopped before")
            return
        self.complete = True
        watch = self.watch.within(_PROOF_TIME)
        certifier = Certifier(
            self.part,
            float(self.task.tolerances.min()),
            self.polishing.designs,
            self.polishing.keep,
            watch,
            self.seed,
        )
        with self.watch.on("proving"):
            self.bound = certifier.certificate()
        if watch.interrupted:
            self.notes.append("the proof was stopped early: more time may prove more")

    def _bound_for(self, designs: tuple[Design, ...]) -> Bound | None:
        """Return the bound with what was found for all targets: that of a part holds for all of them."""
        if self.bound is None or self.part is self.task:
            return self.bound
        relative = [float(np.max(d.verification.misses / self.task.tolerances)) for d in designs]
        best = self.bound.tightest_tolerance * min(relative, default=math.inf)
        return replace(self.bound, best_found=best)

    def solution(self) -> Solution:
        """Rank what was found and say what it is worth."""
        whole = WholeTask(self.task)
        with self.kept():
            known = [*self.polishing.designs, *self._changing_little()]
            whole = self._whole(best_of(self.part, known, self.watch.is_up))
        if self.broke_off is not None and not whole.designs:
            with self.kept():
                for one in best_of(self.part, self.polishing.designs)[:1]:
                    seen, design = verified_in_time(self.task, one.arm, self.watch)
                    whole = WholeTask(seen, (design,) if design.verification.possible else ())
        task, designs = whole.task, whole.designs
        status: Status = Status.FAILED
        reasons: tuple[str, ...] = ()
        with self.kept():
            status, reasons = self._verdict(whole)
        words = status.sentence
        with self.kept():
            words = message(task, status, designs, (*self._why_broken(), *reasons))
        return Solution(
            task,
            status,
            words,
            (*self._why_broken(), *reasons),
            self.seed,
            designs,
            self.starts,
            self.watch.timing(),
            self._bound_for(designs),
            notes=(*self.notes, *filter(None, [whole.note])),
            breakdown="".join(traceback.format_exception(self.broke_off)) if self.broke_off else "",
        )

    @property
    def _usual_starts(self) -> int:
        return _STARTS_WHEN_IMPOSSIBLE if self._impossible else _STARTS_AT_MOST

    def _start_points(self, *, quick: bool) -> Iterator[Start]:
        candidates = starts(self.part, self.seed, quick=quick, watch=self.watch)
        while True:
            with self.watch.on("screening"):
                start = next(candidates, None)
            if start is None:
                return
            yield start

    def _why_broken(self) -> tuple[str, ...]:
        return () if self.broke_off is None else (f"the search broke off: {in_a_line(self.broke_off)}",)

    def _whole(self, designs: tuple[Design, ...]) -> WholeTask:
        """Return designs for a part of the targets as designs for all."""
        if self.part is self.task:
            return WholeTask(self.task, designs)
        whole = for_all_targets(self.task, designs, self.seed, self.watch)
        self.polishing.blocked.extend(whole.blocked)
        return whole

    def _verdict(self, whole: WholeTask) -> tuple[Status, tuple[str, ...]]:
        """Return how the search ended, and why it found no more, as far as that is known."""
        designs = whole.designs
        if designs and designs[0].verification.found:
            return Status.FOUND, ()
        if self.broke_off is not None:
            return Status.FAILED, ()
        if self._impossible:
            return Status.PROVEN_IMPOSSIBLE, self._impossible
        if self.bound is not None and self.bound.excludes:
            return Status.PROVEN_IMPOSSIBLE, (self.bound.sentence,)
        if self.polishing.breakdowns and not (self.polishing.designs or self.polishing.blocked):
            return Status.FAILED, tuple(self.polishing.breakdowns[:1])
        cut_short = self.watch.interrupted and not self.complete
        status = Status.LIMIT if cut_short or whole.unseen else Status.BEST_EFFORT
        return status, why_no_better(self.task, designs, self.polishing.blocked)

    def _changing_little(self) -> list[Design]:
        """Return the shapes found, bent again: to the same workspace, as near to the present one as may be.

        Joint 1 takes up by how much the link is turned about axis 1, if its limits allow.
        """
        current = self.task.current
        found = [design for design in self.polishing.designs if design.verification.found]
        if current is None or not found:
            return []
        best = [design.arm for design in best_of(self.part, found)]
        ends = [arm.shape.end_frame() for arm in best]
        positions, axes = np.array([end for _, end in ends]), np.array([frame[:, 0] for frame, _ in ends])
        bent_again = []
        for where in (ANYWHERE, Interval.fixed(0.0)):
            with self.watch.on("solving"):
                shapes = links_to_poses(
                    self.task.robot.link, positions, axes, current=current, theta1=where, seed=self.seed
                )
            with self.watch.on("verifying"):
                for arm, shape in zip(best, shapes, strict=True):
                    if shape is not None:
                        nearer = replace(arm, shape=shape)
                        bent_again.append(Design(nearer, verify(self.part, nearer)))
        return [design for design in bent_again if design.verification.found]

    def _report(self) -> None:
        worst = min(
            (float(design.verification.misses.max()) for design in self.polishing.designs), default=math.inf
        )
        self.watch.tell(
            starts=self.starts,
            starts_at_most=self.starts_at_most,
            worst_miss=worst,
            found=self.polishing.found,
            phase="polishing shapes",
        )
