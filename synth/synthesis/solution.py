"""What a synthesis found: always returned, whatever it found, and what is told of it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import compared_by_value
from synth.errors import SynthError
from synth.rounding import counted, rounded_up
from synth.sentences import FOUND, MISSED, bulleted, headed
from synth.synthesis.check import TargetResult, target_results
from synth.synthesis.message import Status, ending, message
from synth.synthesis.shape_text import shape_lines, target_lines

if TYPE_CHECKING:
    from synth.robot import Arm
    from synth.synthesis.bound import Bound
    from synth.synthesis.relaxed_limits import Release
    from synth.synthesis.wanted import Design
    from synth.task import Task
    from synth.watch import Timing

_MOST_REASONS = 5


class NotFoundError(SynthError):
    """Use of a shape that was not found.

    Attributes:
        solution: The whole result, with the reason.
    """

    def __init__(self, solution: Solution) -> None:
        super().__init__(solution.message)
        self.solution = solution


@compared_by_value
@dataclass(frozen=True, eq=False)
class Solution:
    """The result of a synthesis.

    Attributes:
        task: What was asked.
        status: How it ended.
        message: The same as a sentence, with the misses and the reasons.
        reasons: Why no more was found, as far as that is known: proofs, algebra, limits that block.
        seed: Seed of the search: the same task, seed and version give the same answer.
        designs: Distinct shapes, the best first; only shapes that the hardware can take.
        starts: How many start points were polished.
        time: Where the time went.
        bound: How much better than the best shape found any shape may be; None if that was not asked, or
            there is no proof for such a task.
        releases: What would release a task that was not met; empty before `explain` has looked.
        notes: What else is to be said: what was left undone for lack of time, what `explain` found.
        explained: Whether `explain` has looked for releases, be it in vain.
        breakdown: The traceback of what broke off the search and nobody foresaw; empty mostly.
        shape: Which of the shapes, counted from the best, `designs` begins with; see `showing`.
    """

    task: Task
    status: Status
    message: str
    reasons: tuple[str, ...]
    seed: int
    designs: tuple[Design, ...]
    starts: int
    time: Timing
    bound: Bound | None = None
    releases: tuple[Release, ...] = ()
    notes: tuple[str, ...] = ()
    breakdown: str = ""
    shape: int = 1
    explained: bool = False

    @property
    def shape_numbers(self) -> tuple[int, ...]:
        """The number of each of `designs`, counted from the best."""
        others = (number for number in range(1, len(self.designs) + 1) if number != self.shape)
        return (self.shape, *others)

    @property
    def found(self) -> bool:
        """Whether every target is within its tolerance, by the independent check."""
        return self.status is Status.FOUND

    @property
    def best(self) -> Design:
        """The best shape.

        Raises:
            NotFoundError: There is none.
        """
        if not self.designs:
            raise NotFoundError(self)
        return self.designs[0]

    @property
    def robot(self) -> Arm:
        """The robot in the best shape, with its forward and inverse kinematics.

        Raises:
            NotFoundError: There is none.
        """
        return self.best.arm

    @cached_property
    def targets(self) -> tuple[TargetResult, ...]:
        """What becomes of each target in the best shape.

        Raises:
            NotFoundError: There is none.
        """
        return target_results(self.task, self.best.arm, self.best.verification)

    def __str__(self) -> str:
        """Return a headline, what is known, and a few bullets: what the terminal shows of it."""
        return _summary(self)

    def __repr__(self) -> str:
        shapes = counted(len(self.designs), "shape")
        return f"<{type(self).__name__} {self.task.name!r}: {self.status.value}, {shapes}>"

    def or_raise(self) -> Solution:
        """Return this solution if it was found.

        Raises:
            NotFoundError: It was not.
        """
        if not self.found:
            raise NotFoundError(self)
        return self


def showing(solution: Solution, number: int) -> Solution:
    """Return a solution that begins with another of its shapes: all that is told is then of that one.

    Args:
        solution: What a synthesis found, its best shape first.
        number: Which shape, counted from 1, the best.

    Raises:
        SynthError: There are not so many.
    """
    designs, count = solution.designs, len(solution.designs)
    if not 1 <= number <= count:
        are = (
            "is no shape"
            if not count
            else f"{'is 1 shape' if count == 1 else f'are {count} distinct shapes'}"
        )
        raise SynthError(f"there is no shape {number} to show: there {are} of this task")
    ordered = (designs[number - 1], *designs[: number - 1], *designs[number:])
    told = message(solution.task, solution.status, ordered, solution.reasons)
    return replace(solution, designs=ordered, shape=number, message=told)


def _summary(solution: Solution) -> str:
    """Return a result as a headline, what is known of it, and a few bullets, for any status."""
    task, bullets = solution.task, []
    sign = FOUND if solution.found else MISSED
    lines = [*map(bulleted, knowledge(solution))]
    if solution.designs:
        lines += target_lines(task, solution.best)
        bullets = shape_lines(task, solution.best)
    else:
        asked = counted(len(task.targets), "target")
        lines.append(bulleted(f"{asked} asked for, none reached: there is no shape"))
    if len(solution.designs) > 1:
        best = (", the best" if solution.found else ", the nearest") if solution.shape == 1 else ""
        bullets.append(
            f"{len(solution.designs)} distinct shapes; this is shape {solution.shape}{best} "
            "(--all lists them, --shape K shows another)"
        )
    starts = counted(solution.starts, "start")
    bullets.append(f"seed {solution.seed}, {starts}, {solution.time.total:.2f} s")
    headline = f"{sign} {task.name}: {ending(solution.status, solution.designs)}"
    return headed(headline, [*lines, *map(bulleted, bullets)])


def knowledge(solution: Solution, most: int = _MOST_REASONS) -> list[str]:
    """Return why no more was found, what is proven, and what would help: of many reasons the first.

    Args:
        solution: The result.
        most: How many reasons are told.
    """
    proof = proof_sentence(solution)
    told = [*reasons_told(solution, most), *([proof] if proof else [])]
    return [*told, *help_told(solution)]


def help_told(solution: Solution) -> list[str]:
    """Return what would let a task be met that is not, how more is found out, and what else is to be said."""
    if solution.found or solution.status is Status.FAILED:
        return list(solution.notes)
    told = [f"{release.sentence} would do" for release in solution.releases]
    open_yet = solution.status is not Status.PROVEN_IMPOSSIBLE
    if open_yet and solution.designs and not solution.best.verification.violations:
        worst = rounded_up(float(solution.best.verification.misses.max()), digits=2)
        told.append(f"tolerances of {worst} mm would be met by the nearest shape found")
    told += solution.notes
    if solution.status is Status.LIMIT:
        told.append("more time may find a shape")
    if not (solution.explained or solution.releases):
        told.append("solving with --why looks for one limit that, if it gave way, would let the task be met")
    if open_yet and solution.bound is None and solution.task.robot.rigid_link.is_fixed:
        told.append("solving with --prove tells how near any shape can come, or that the task is impossible")
    return told


def reasons_told(solution: Solution, most: int) -> list[str]:
    """Return why no more was found, but for what `proof_sentence` says: of many the first, counted."""
    bound = solution.bound
    reasons = [reason for reason in solution.reasons if bound is None or reason != bound.sentence]
    if len(reasons) <= most:
        return reasons
    return [*reasons[:most], f"and {len(reasons) - most} more of this kind"]


def proof_sentence(solution: Solution) -> str:
    """Return what `--prove` proved, of the shape that is shown; empty if it was not asked."""
    bound = solution.bound
    if bound is None:
        return ""
    if not solution.designs:
        return bound.sentence
    weights = bound.tightest_tolerance / solution.task.tolerances
    worst = float(np.max(solution.best.verification.misses * weights))
    return bound.sentence_of_shape(worst)
