"""A certificate for a search: how near the best shape found is to the best there is."""

from __future__ import annotations

import math
import threading
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from synth.errors import SolverError
from synth.geometry import Invariants
from synth.synthesis.bound import Bound, prove
from synth.synthesis.exact_starts import nearest_to_designs
from synth.synthesis.nlp import Structure, shared_nlp
from synth.synthesis.population import ARCS, Population
from synth.synthesis.refinement import refine
from synth.task import Objective

if TYPE_CHECKING:
    from collections.abc import Callable

    from synth.arrays import FloatArray
    from synth.geometry import SweptCircle
    from synth.robot import Arm
    from synth.synthesis.solution import Design
    from synth.task import Task

_POLISHED = 6  # of the designs of the search, for the least worst miss
_LINKS = 20_000  # drawn, to find some that end like a surface that the bound asks for
_NEAREST = 6  # of these for each way in which the surface may lie
_TRIED = 3


@dataclass
class Certifier:
    """Finds the shape of the least worst miss, and proves how much better none can be.

    Attributes:
        task: The task, or a part of its targets.
        tightest: The tightest tolerance of the whole task, m.
        designs: The shapes found so far, all of which the hardware can take.
        keep: Checks a shape and puts it to the designs if it is possible.
        stop: Whether to end with what there is.
        progress: Told the least worst weighted miss found and the bound so far, m.
        rng: Source of randomness.
    """

    task: Task
    tightest: float
    designs: list[Design]
    keep: Callable[[Arm, FloatArray], Design]
    stop: Callable[[], bool]
    progress: Callable[[float, float], None]
    rng: np.random.Generator
    _minimax: Task = field(init=False)
    _links: Population = field(init=False)

    def __post_init__(self) -> None:
        table = self.task.table
        equal = replace(table, weights=np.ones(len(table)))
        self._minimax = replace(self.task, objective=Objective.MINIMAX, targets=equal)
        self._links = Population.sample(self.task.robot, _LINKS, self.rng)

    def certificate(self) -> Bound | None:
        """Return the bound; None where there is no proof for such a task."""
        for design in sorted(self.designs, key=self._worst)[:_POLISHED]:
            self._polish(design.arm, design.verification.joints)
        return prove(
            self.task,
            self._best(),
            self._best_misses(),
            tightest=self.tightest,
            stop=self.stop,
            improve=self._improve,
            progress=lambda lower: self.progress(self._best(), lower),
        )

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

    def _polish(self, arm: Arm, joints: FloatArray) -> None:
        try:
            program = shared_nlp(Structure.of(self._minimax), ARCS, False, threading.get_ident())
            answer = program.solve(self._minimax, arm, joints, self.stop)
        except SolverError:
            return  # other starts may do
        self.keep(answer.arm, answer.joints)

    def _improve(self, circle: SweptCircle) -> float:
        """Look for a link whose workspace is about that of a circle; return the least worst miss found, m."""
        near = nearest_to_designs(self._links, [Invariants.from_circle(circle)], _NEAREST)
        links = self._links.take(near)
        refined = refine(self.task, links)
        for index in np.argsort(refined.cost, kind="stable")[:_TRIED]:
            self._polish(refined.population.arm(int(index), self.task.base), refined.joints[index])
        return self._best()
