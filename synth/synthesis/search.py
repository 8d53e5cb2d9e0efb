"""One run of a synthesis: start points, polished until enough is found, ranked and told."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from synth.robot import ANYWHERE, Interval, links_to_poses
from synth.synthesis.certificate import Certifier
from synth.synthesis.impossibility import why_impossible
from synth.synthesis.many_targets import improved, levelled, ranked
from synth.synthesis.polishing import Polishing
from synth.synthesis.population import in_equal_arcs
from synth.synthesis.ranking import best_of, objective
from synth.synthesis.screening import Start, starts
from synth.synthesis.solution import Design, Solution, Status
from synth.synthesis.verdict import message, why_no_better
from synth.synthesis.verification import verify
from synth.synthesis.wished import wished
from synth.task import Objective

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from synth.synthesis.bound import Bound
    from synth.synthesis.clock import Clock
    from synth.task import Task

_STARTS_AT_MOST = 48
_STARTS_WHEN_IMPOSSIBLE = 12  # for a good best effort
_FOLLOWED = 2  # shapes of a neighbour that are polished
ALTERNATIVES = 3  # starts polished after a shape was found: for distinct, gentler and nearer ones
_ALTERNATIVES_THAT_MISS = 2  # likewise, at most, where no shape meets all targets
_GAIN = 1e-3  # of the objective: the least that is worth another start
_PROOF_TIME = 60.0  # s
# Targets of all shapes together that are looked at where the search knew only a part of them.
_VERIFIED_AT_MOST = 20_000


@dataclass(frozen=True)
class Progress:
    """How far a search is: start points polished, of at most how many, and the best worst miss, m.

    While a proof runs, `lower_bound` is the bound so far, m.
    """

    starts: int
    starts_at_most: int
    worst_miss: float
    found: bool
    lower_bound: float | None = None


@dataclass
class Search:
    """One run of `solve`: the designs so far, for the part of the task that is searched with."""

    task: Task
    part: Task
    seed: int
    clock: Clock
    stop: Callable[[], bool]
    progress: Callable[[Progress], None]
    alternatives: int = ALTERNATIVES
    starts: int = 0
    starts_at_most: int = 0
    starts_found: int = 0  # since a shape was found, that start included
    interrupted: bool = False
    bound: Bound | None = None

    @cached_property
    def polishing(self) -> Polishing:
        """The shapes so far."""
        return Polishing(self.part, self.clock, self._out_of_time)

    @cached_property
    def _impossible(self) -> tuple[str, ...]:
        return why_impossible(self.task)

    def follow(self, designs: Sequence[Design]) -> bool:
        """Polish the best shapes for a task nearby; whether one of them reaches every target."""
        for design in designs[:_FOLLOWED]:
            arm = in_equal_arcs(replace(design.arm, robot=self.task.robot, base=self.task.base))
            self.polishing.polish(Start(arm, arm.closest_joints(self.part.table.positions)[0]), near=True)
            self.starts += 1
            if self.polishing.found or self._out_of_time():
                break
        return self.polishing.found

    def run(self, most: int | None = None) -> None:
        """Polish start points until enough is found, or the time is up; if `most`, quick ones, so many."""
        self.starts_at_most = self.starts + (most or self._usual_starts)
        no_better = 0
        for start in self._start_points(quick=most is not None or bool(self._impossible)):
            if self._out_of_time():
                # A start that was not polished is better than nothing.
                if not self.polishing.designs:
                    self.polishing.keep(start.arm, start.joints)
                if self.polishing.designs or len(self.polishing.blocked) >= _STARTS_WHEN_IMPOSSIBLE:
                    return
                continue
            if not self._may_be_better(start):
                no_better += 1
                if no_better > min(_ALTERNATIVES_THAT_MISS, self.alternatives):
                    continue
            self.polishing.polish(start)
            if self._led_astray(start) and self.polishing.keep(start.arm, start.joints).verification.possible:
                self.polishing.polish(start, near=True)
            self.starts += 1
            self.starts_found += self.polishing.found
            self._report()
            if self.starts_found == 1 and self.alternatives and self._wished_for():
                return
            if self.starts >= self.starts_at_most or self.starts_found > self.alternatives:
                return

    def _wished_for(self) -> bool:
        """Look for shapes that a person would rather have than the first one; whether there are any."""
        known = [design.arm for design in self.polishing.designs if design.verification.found]
        found, candidates = 0, wished(self.part, known, self.seed, self._out_of_time)
        for _ in range(2 * self.alternatives):
            with self.clock.on("solving"):
                candidate = next(candidates, None)
            if candidate is None or self._out_of_time():
                break
            found += self.polishing.keep(*candidate, stay=True).verification.found
            if found == self.alternatives:
                break
        return found > 0

    def _may_be_better(self, start: Start) -> bool:
        """Whether a start may lead to a better shape than the best: not if its valley is above that."""
        if not self.polishing.designs or self.polishing.found:
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

    def prove(self) -> None:
        """Bound how little any shape can miss, unless the search was stopped already."""
        if self.interrupted:
            return
        until = time.perf_counter() + _PROOF_TIME
        certifier = Certifier(
            self.part,
            float(self.task.tolerances.min()),
            self.polishing.designs,
            self.polishing.keep,
            lambda: self.stop() or self.clock.is_up() or time.perf_counter() > until,
            lambda worst, lower: self.progress(
                Progress(self.starts, self.starts_at_most, worst, self.polishing.found, lower)
            ),
            self.seed,
        )
        with self.clock.on("proving"):
            self.bound = certifier.certificate()

    def _bound_for(self, designs: tuple[Design, ...]) -> Bound | None:
        """Return the bound with what was found for all targets: that of a part holds for all of them."""
        if self.bound is None or self.part is self.task:
            return self.bound
        relative = [float(np.max(d.verification.misses / self.task.tolerances)) for d in designs]
        best = self.bound.tightest_tolerance * min(relative, default=math.inf)
        return replace(self.bound, best_found=best)

    def solution(self) -> Solution:
        """Rank what was found and say what it is worth."""
        found = [*self.polishing.designs, *self._changing_little()]
        designs = self._for_all_targets(best_of(self.part, found))
        status, reasons = self._verdict(designs)
        return Solution(
            self.task,
            status,
            message(self.task, status, designs, reasons),
            reasons,
            self.seed,
            designs,
            self.starts,
            self.clock.timing(),
            self._bound_for(designs),
        )

    @property
    def _usual_starts(self) -> int:
        return _STARTS_WHEN_IMPOSSIBLE if self._impossible else _STARTS_AT_MOST

    def _start_points(self, *, quick: bool) -> Iterator[Start]:
        candidates = starts(self.part, self.seed, quick=quick, stop=self._out_of_time)
        while True:
            with self.clock.on("screening"):
                start = next(candidates, None)
            if start is None:
                return
            yield start

    def _verdict(self, designs: tuple[Design, ...]) -> tuple[Status, tuple[str, ...]]:
        """Return how the search ended, and why it found no more, as far as that is known."""
        if designs and designs[0].verification.found:
            return Status.FOUND, ()
        if self._impossible:
            return Status.PROVEN_IMPOSSIBLE, self._impossible
        if self.bound is not None and self.bound.excludes:
            return Status.PROVEN_IMPOSSIBLE, (self.bound.sentence,)
        if self.polishing.breakdowns and not (self.polishing.designs or self.polishing.blocked):
            return Status.FAILED, tuple(self.polishing.breakdowns[:1])
        status = Status.LIMIT if self.interrupted else Status.BEST_EFFORT
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
            with self.clock.on("solving"):
                shapes = links_to_poses(
                    self.task.robot.link, positions, axes, current=current, theta1=where, seed=self.seed
                )
            with self.clock.on("verifying"):
                for arm, shape in zip(best, shapes, strict=True):
                    if shape is not None:
                        nearer = replace(arm, shape=shape)
                        bent_again.append(Design(nearer, verify(self.part, nearer)))
        return [design for design in bent_again if design.verification.found]

    def _for_all_targets(self, designs: tuple[Design, ...]) -> tuple[Design, ...]:
        """Return designs improved for all targets, and verified with them, in their order."""
        if self.part is self.task:
            return designs
        with self.clock.on("solving"):
            arms = ranked(self.task, [design.arm for design in designs], self.seed)
        whole = []
        for found in arms[: max(1, _VERIFIED_AT_MOST // len(self.task.targets))]:
            with self.clock.on("solving"):
                arm = improved(self.task, found)
                if self.task.objective is Objective.MINIMAX:
                    arm = levelled(self.task, arm)
            with self.clock.on("verifying"):
                check = verify(self.task, arm)
                # The steps know neither floor nor obstacles.
                if not check.possible:
                    arm, check = found, verify(self.task, found)
            if check.possible:
                whole.append(Design(arm, check))
            else:
                self.polishing.blocked.append(Design(arm, check))
        return best_of(self.task, whole)

    def _out_of_time(self) -> bool:
        self.interrupted = self.interrupted or self.stop() or self.clock.is_up()
        return self.interrupted

    def _report(self) -> None:
        worst = min(
            (float(design.verification.misses.max()) for design in self.polishing.designs), default=math.inf
        )
        self.progress(Progress(self.starts, self.starts_at_most, worst, self.polishing.found))
