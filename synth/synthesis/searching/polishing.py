"""From start points to shapes that were checked: the nonlinear program, then the verification."""

from __future__ import annotations

import math
import threading
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from synth.errors import SolverError
from synth.synthesis.check import verify_targets
from synth.synthesis.nlp import Structure, SynthesisNlp, separations, shared_nlp
from synth.synthesis.shapes import ARCS
from synth.synthesis.wanted import Design, judged, objective
from synth.task import Objective

if TYPE_CHECKING:
    from collections.abc import Sequence

    from synth.arrays import FloatArray
    from synth.robot import Arm
    from synth.synthesis.nlp import Separation
    from synth.synthesis.starts import Start
    from synth.task import Task
    from synth.watch import Watch

# How often planes before obstacles are taken anew where the solver ended, until a shape is found.
_PLANES_ANEW = 5
_GAINED = 0.9  # of the objective before: the least gain for which to go on
_CLASHES = ("obstacle", "itself")


@dataclass
class Polishing:
    """Polishes shapes for one task, checks them, and keeps what it saw.

    Attributes:
        task: The task.
        watch: Counts the time; when it is up, the solver ends with what it has.
        designs: The shapes so far that the hardware can take.
        blocked: Those that it cannot.
        breakdowns: What the solver said where it broke down.
    """

    task: Task
    watch: Watch
    designs: list[Design] = field(default_factory=list)
    blocked: list[Design] = field(default_factory=list)
    breakdowns: list[str] = field(default_factory=list)

    @property
    def found(self) -> bool:
        """Whether a shape reaches every target."""
        return any(design.verification.found for design in self.designs)

    @property
    def by_squares(self) -> Polishing:
        """The same, with the same lists, by the sum of the squares of the misses instead of the worst one."""
        return replace(self, task=replace(self.task, objective=Objective.LEAST_SQUARES))

    @property
    def by_worst(self) -> Polishing:
        """The same by the worst of the misses over their tolerances."""
        return replace(self, task=self.task.by_worst_miss)

    def polish(self, start: Start, *, near: bool = False) -> None:
        """Solve from one start; where something is in the way, take the planes before it anew.

        Args:
            start: The start.
            near: Whether the answer is near, so that the solver begins with short steps.
        """
        arm, joints, itself = start.arm, start.joints, False
        best = math.inf
        for _ in range(1 if self.found else _PLANES_ANEW):
            with self.watch.on("solving"):
                planes = separations(self.task, arm, joints, itself=itself)
                try:
                    answer = self._nlp(planes, near=near).solve(self.task, arm, joints, self.watch)
                except SolverError as error:
                    self.breakdowns.append(str(error))
                    return
            arm, joints = answer.arm, answer.joints
            design = self.keep(arm, joints)
            clashes = [v for v in design.verification.violations if v.limit.startswith(_CLASHES)]
            if not itself and any(clash.limit == "itself" for clash in clashes):
                # The start kept clearer of itself than where the way from there led without planes.
                arm, joints, itself = start.arm, start.joints, True
            # Other planes may give way: as long as they do, or as something is in the way.
            misses = objective(self.task, design)
            done = not planes or misses > _GAINED * best or design.verification.found
            best = min(best, misses)
            if (done and not clashes) or self.watch.is_up():
                return

    def _nlp(self, planes: Sequence[Separation], *, near: bool) -> SynthesisNlp:
        structure = Structure.of(self.task)
        # Where the worst miss counts a start is the answer but for the gentlest bend: long steps lose it.
        near = near or structure.objective is Objective.MINIMAX
        if planes:
            return SynthesisNlp(structure, ARCS, planes)
        return shared_nlp(structure, ARCS, near, threading.get_ident())

    def keep(self, arm: Arm, joints: FloatArray, *, stay: bool = False) -> Design:
        """Check a shape, keep it where it belongs, and return it.

        Args:
            arm: The robot in the shape.
            joints: Joint angles at the targets that `verify_targets` considers, shape (n, 2), rad.
            stay: Whether it keeps these where they will do; then it is judged, too.
        """
        with self.watch.on("verifying"):
            design = Design(arm, verify_targets(self.task, arm, joints, keep=stay))
            if stay and design.verification.found:
                design = judged(self.task, design, self.watch.is_up)
        (self.designs if design.verification.possible else self.blocked).append(design)
        return design
