"""What a synthesis found, whatever it found, as plain data."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from synth.arrays import frozen_value
from synth.synthesis.solution.message import Status
from synth.version import __version__

if TYPE_CHECKING:
    from synth.synthesis.bound import Bound
    from synth.synthesis.wanted import Design
    from synth.task import Task
    from synth.watch import Timing


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


@frozen_value
class Outcome:
    """What a synthesis found, and how it ended.

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
        version: Version of synth that found it.
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
    version: str = __version__

    @property
    def shape_numbers(self) -> tuple[int, ...]:
        """The number of each of `designs`, counted from the best."""
        others = (number for number in range(1, len(self.designs) + 1) if number != self.shape)
        return (self.shape, *others)

    @property
    def found(self) -> bool:
        """Whether every target is within its tolerance, by the independent check."""
        return self.status is Status.FOUND
