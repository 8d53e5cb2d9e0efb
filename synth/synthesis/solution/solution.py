"""The solution: an outcome, and what a user does with it."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

from synth.arrays import frozen_value
from synth.errors import SynthError
from synth.rounding import counted
from synth.synthesis.check import TargetResult, target_results
from synth.synthesis.solution.message import message
from synth.synthesis.solution.outcome import Outcome
from synth.synthesis.solution.summary import summary

if TYPE_CHECKING:
    from synth.robot import Arm
    from synth.synthesis.wanted import Design


class NotFoundError(SynthError):
    """Use of a shape that was not found.

    Attributes:
        solution: The whole result, with the reason.
    """

    def __init__(self, solution: Solution) -> None:
        super().__init__(solution.message)
        self.solution = solution


@frozen_value
class Solution(Outcome):
    """The result of a synthesis: always returned, whatever was found; see `Outcome` for what it holds."""

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
        return summary(self)

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
