"""What a synthesis found: always returned, whatever it found."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from synth.arrays import compared_by_value
from synth.errors import SynthError
from synth.sentences import SentenceEnum
from synth.synthesis.check import TargetResult, target_results

if TYPE_CHECKING:
    from synth.robot import Arm
    from synth.synthesis.bound import Bound
    from synth.synthesis.wanted import Design
    from synth.task import Task
    from synth.watch import Timing


class Status(SentenceEnum):
    """How a synthesis ended."""

    FOUND = "found", "every target is within its tolerance"
    BEST_EFFORT = "best_effort", "no shape was found that reaches every target"
    PROVEN_IMPOSSIBLE = "proven_impossible", "no shape of this robot can do the task"
    LIMIT = "limit", "stopped before the search was complete"
    FAILED = "failed", "the solver broke down"

    def told(self, *, with_shape: bool) -> str:
        """Return the sentence, with what the shape shown is, if there is one."""
        if with_shape and self in (Status.BEST_EFFORT, Status.LIMIT, Status.PROVEN_IMPOSSIBLE):
            return f"{self.sentence}; what follows is of the nearest shape found"
        return self.sentence


class NotFoundError(SynthError):
    """Use of a shape that was not found.

    Attributes:
        solution: The whole result, with the reason.
    """

    def __init__(self, solution: Solution) -> None:
        super().__init__(solution.message)
        self.solution = solution


@dataclass(frozen=True)
class Release:
    """One limit that blocks a task, and how much less of it would do.

    Attributes:
        limit: Name of the limit.
        amount: By how much it has to give way, m or rad.
        share: The same as a share of what the limit is, by which limits are compared.
        sentence: What would do, for the user.
        design: A shape that meets the task released so far, with its verification.
        task: The task released so far.
    """

    limit: str
    amount: float
    share: float
    sentence: str
    design: Design
    task: Task


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

    def or_raise(self) -> Solution:
        """Return this solution if it was found.

        Raises:
            NotFoundError: It was not.
        """
        if not self.found:
            raise NotFoundError(self)
        return self
