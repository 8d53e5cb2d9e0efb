"""What became of one task of many."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from synth.errors import SynthError
from synth.solution_file import solution_from_json
from synth.synthesis import Status

if TYPE_CHECKING:
    from synth.synthesis import Solution

_STATUSES = {status.value: status for status in Status}


@dataclass(frozen=True)
class TaskOutcome:
    """What became of one task of many: a solution, or why there is none.

    Attributes:
        name: What the task is called.
        text: The solution as JSON, in the form of `solution.json`; empty if there is none.
        error: Why there is none: wrong input, or a worker that broke down; else empty.
        seconds: How long it was solved, s.
        stored: Whether it comes from a store, and was solved by an earlier run.
        wrong_input: Whether the task itself is wrong.
    """

    name: str
    text: str = ""
    error: str = ""
    seconds: float = 0.0
    stored: bool = False
    wrong_input: bool = False

    @property
    def solved(self) -> bool:
        """Whether there is a solution, whatever its status."""
        return bool(self.text)

    @property
    def found(self) -> bool:
        """Whether every target is within its tolerance."""
        return self.status is Status.FOUND

    @property
    def status(self) -> Status:
        """How the synthesis ended; `failed` where there is no solution."""
        return _STATUSES[self._content["status"]] if self.solved else Status.FAILED

    @property
    def worst_miss(self) -> float:
        """The largest miss of any target that is told of, m; infinite without a shape."""
        misses = [target["miss"] for target in self._content["targets"]] if self.solved else []
        return max((math.inf if miss is None else miss for miss in misses), default=math.inf)

    @cached_property
    def _content(self) -> dict[str, Any]:
        content: dict[str, Any] = json.loads(self.text)
        return content

    @cached_property
    def solution(self) -> Solution:
        """The solution, verified again when it is first asked for.

        Raises:
            SynthError: There is none, with the reason.
        """
        if not self.solved:
            raise SynthError(f"{self.name}: {self.error}")
        return solution_from_json(self.text)


@dataclass(frozen=True)
class SweepProgress:
    """How far a sweep is, told with each task that is done.

    Attributes:
        done: How many tasks are done, those from the store among them.
        total: Of how many.
        index: Which task this is, counted from 0 in the order given.
        outcome: What became of it.
    """

    done: int
    total: int
    index: int
    outcome: TaskOutcome
