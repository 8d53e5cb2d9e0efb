"""A certificate for a search: how near the best shape found is to the best there is."""

from __future__ import annotations

import math
import threading
from dataclasses import dataclass, field
from itertools import islice
from typing import TYPE_CHECKING

import numpy as np

from synth.errors import SolverError
from synth.robot import Arm
from synth.synthesis.bound import Bound, prove
from synth.synthesis.nlp import Structure, shared_nlp
from synth.synthesis.shapes import ARCS
from synth.synthesis.starts import start_points

if TYPE_CHECKING:
    from collections.abc import Callable

    from synth.arrays import FloatArray
    from synth.synthesis.bound import LinkEnd
    from synth.synthesis.run import Run
    from synth.synthesis.wanted import Design
    from synth.task import Task
    from synth.watch import Watch

_PROOF_TIME = 60.0  # s
_GAP = 1e-4  # m: the proof ends when the bound is as near as this to the best shape
_STARTS = 16  # for the least worst miss
_POLISHED = 6  # of the designs of the search, for the least worst miss
_LINKS = 96  # bent at random, to be brought to an end that the bound asks for
_NEAREST = 16  # of these are looked at
_TRIED = 3


@dataclass
class Certifier:
    """Finds the shape of the least worst miss, and proves how much better none can be.

    Attributes:
        task: The task, or a part of its targets.
        tightest: The tightest tolerance of the whole task, m.
        designs: The shapes found so far, all of which the hardware can take.
        keep: Checks a shape and puts it to the designs if it is possible.
        watch: Told of each step; when it is up, the proof ends with what there is.
        seed: Seed of the search.
    """

    task: Task
    tightest: float
    designs: list[Design]
    keep: Callable[[Arm, FloatArray], Design]
    watch: Watch
    seed: int
    _rng: np.random.Generator = field(init=False)
    _minimax: Task = field(init=False)

    def __post_init__(self) -> None:
        self._minimax = self.task.by_worst_miss
        self._rng = np.random.default_rng(self.seed)

    def certificate(self) -> Bound | None:
        """Look for the shape of the least worst miss; return the bound, None where there is none."""
        self.search()
        return self.bound()

    def bound(self, known: float = math.inf) -> Bound | None:
        """Return the bound, as near as may be to the least worst miss found.

        Args:
            known: The worst weighted miss of a shape with another rigid link or at another place, m: what is
                worse need not be found here, only excluded.
        """
        return prove(
            self.task,
            min(known, self._best()),
            self._best_misses(),
            tightest=self.tightest,
            gap=_GAP,
            watch=self.watch,
            improve=lambda end: min(known, self._improve(end)),
        )

    def search(self) -> float:
        """Look for the shape of the least worst miss; return the least worst weighted miss found, m."""
        for design in sorted(self.designs, key=self._worst)[:_POLISHED]:
            self._polish(design.arm, design.verification.joints)
        if self._best() > _GAP:
            # The shapes so far were searched for by the task's own objective, maybe another one.
            for start in islice(start_points(self._minimax, self.seed, watch=self.watch), _STARTS):
                self._polish(start.arm, start.joints)
        return self._best()

    def _worst(self, design: Design) -> float:
        """Return the worst weighted miss of a design, m."""
        tolerances = self.task.tolerances
        return float(np.max(design.verification.misses * (self.tightest / tolerances)))

    def _best(self) -> float:
        return min(map(self._worst, self.designs), default=math.inf)

    def _best_misses(self) -> FloatArray:
        if not self.designs:
            return np.zeros(len(self.task.targets))
        return min(self.designs, key=self._worst).verification.misses

    def _polish(self, arm: Arm, joints: FloatArray, *, near: bool = False) -> None:
        try:
            program = shared_nlp(Structure.of(self._minimax), ARCS, near, threading.get_ident())
            answer = program.solve(self._minimax, arm, joints, self.watch)
        except SolverError:
            return  # other starts may do
        self.keep(answer.arm, answer.joints)

    def _improve(self, end: LinkEnd) -> float:
        """Look for a link that ends about so; return the least worst weighted miss found, m."""
        robot = self.task.robot
        d35, d45 = robot.rigid_link.d35.lower, robot.rigid_link.d45.lower
        weights = self.tightest / self.task.tolerances
        arms, joints, worst = [], [], []
        for shape in end.links(robot.link, ARCS, _LINKS, self._rng)[:_NEAREST]:
            arms.append(Arm(robot, shape, d35, d45, self.task.base))
            closest, misses = arms[-1].closest_joints(self.task.table.positions)
            joints.append(closest)
            worst.append(np.max(misses * weights))
        for index in np.argsort(worst, kind="stable")[:_TRIED]:
            self.keep(arms[index], joints[index])
            for near in (False, True):
                self._polish(arms[index], joints[index], near=near)
        return self._best()


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
