"""What a run obeys and whom it tells: its time limit, the wish to stop, its progress, its times."""

from __future__ import annotations

import math
import time
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

_T = TypeVar("_T")


@dataclass(frozen=True)
class Progress:
    """How far a run is.

    Attributes:
        starts: Start points polished so far.
        starts_at_most: Of at most how many; 0 while that is not known.
        worst_miss: The worst miss of the best shape so far, m; infinite before there is one.
        found: Whether a shape reaches every target.
        lower_bound: While a proof runs, the bound so far, m.
        phase: What is being done, for the user.
    """

    starts: int = 0
    starts_at_most: int = 0
    worst_miss: float = math.inf
    found: bool = False
    lower_bound: float | None = None
    phase: str = ""


@dataclass(frozen=True)
class Timing:
    """Where the time went, s.

    Attributes:
        total: From call to return.
        screening: Finding start points.
        solving: Building and running the nonlinear program.
        verifying: Checking what it found.
        proving: Bounding what any shape can do.
    """

    total: float
    screening: float
    solving: float
    verifying: float
    proving: float = 0.0


def never() -> bool:
    """Return that the time is not up: where there is no limit."""
    return False


class Watch:
    """Handed to everything that takes long: it asks `is_up` many times a second, and tells how far it is.

    Args:
        time_limit: Time after which it is up, s.
        stop: Asked whether to stop; once it said yes, it is not asked again.
        report: Told how far the run is.
        clock: Returns the time, s.

    Attributes:
        raised: What `stop` or `report` raised, if they did: it is the caller's, and passes through all nets.
    """

    def __init__(
        self,
        time_limit: float = math.inf,
        *,
        stop: Callable[[], bool] | None = None,
        report: Callable[[Progress], None] | None = None,
        clock: Callable[[], float] = time.perf_counter,
    ) -> None:
        self._clock, self._stop, self._report = clock, stop, report
        self._began = clock()
        self._time_limit = time_limit
        self._spent = {"screening": 0.0, "solving": 0.0, "verifying": 0.0, "proving": 0.0}
        self._progress = Progress()
        self._wished = self._up = self._interrupted = False
        self.raised: BaseException | None = None

    @property
    def elapsed(self) -> float:
        """The time since it was made, s."""
        return self._clock() - self._began

    @property
    def remaining(self) -> float:
        """The time left, s; infinite without a limit, never below 0."""
        return max(self._time_limit - self.elapsed, 0.0)

    @property
    def overdue(self) -> float:
        """For how long the time is up, s; negative while it is not."""
        return self.elapsed - self._time_limit

    @property
    def interrupted(self) -> bool:
        """Whether somebody asked and was told that the time is up: something may be left undone."""
        return self._interrupted

    def is_up(self) -> bool:
        """Whether to end with what there is; it stays so, within a block of `keeping_back` until its end."""
        if not self._wished and self._stop is not None:
            self._wished = self._users(self._stop)
        self._up = self._up or self._wished or self.remaining <= 0.0
        self._interrupted = self._interrupted or self._up
        return self._up

    @contextmanager
    def keeping_back(self, share: float) -> Iterator[None]:
        """Within a block, be up while a share of the time left is still there: what follows needs it."""
        seconds = share * self.remaining if math.isfinite(self.remaining) else 0.0
        self._time_limit -= seconds
        try:
            yield
        finally:
            self._time_limit += seconds
            self._up = False

    def tell(self, **changes: Any) -> None:
        """Tell how far the run is: what has changed of the `Progress` told before, or that it is alive."""
        self._progress = replace(self._progress, **changes)
        report, now = self._report, self._progress
        if report is not None:
            self._users(lambda: report(now))

    def _users(self, call: Callable[[], _T]) -> _T:
        """Return what a function of the user returns, and remember what it raises."""
        try:
            return call()
        except BaseException as error:
            self.raised = error
            raise

    @contextmanager
    def on(self, part: str) -> Iterator[None]:
        """Count the time of a block under the name of a part of `Timing`."""
        began = self._clock()
        try:
            yield
        finally:
            self._spent[part] += self._clock() - began

    def timing(self) -> Timing:
        """Return the time so far, in all and by parts."""
        return Timing(self._clock() - self._began, **self._spent)

    def within(self, seconds: float) -> Watch:
        """Return a watch that is up when this one is, and after some seconds in any case."""
        inner = Watch(seconds, stop=self.is_up, report=self._report, clock=self._clock)
        inner._progress = self._progress
        return inner

    def aside(self) -> Watch:
        """Return a watch for a smaller run within this one: up when this one is, with times of its own.

        What that run tells of itself is told as a sign of life of this one.
        """
        return Watch(self.remaining, stop=self.is_up, report=lambda _: self.tell(), clock=self._clock)
