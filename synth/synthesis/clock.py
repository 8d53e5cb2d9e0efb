"""Where the time of a search goes, and when it is up."""

from __future__ import annotations

import time
from contextlib import contextmanager
from typing import TYPE_CHECKING

from synth.synthesis.solution import Timing

if TYPE_CHECKING:
    from collections.abc import Iterator


class Clock:
    """Counts the time of the parts of a search.

    Args:
        time_limit: Time after which it is up, s.
    """

    def __init__(self, time_limit: float) -> None:
        self._began = time.perf_counter()
        self._time_limit = time_limit
        self._spent = {"screening": 0.0, "solving": 0.0, "verifying": 0.0, "proving": 0.0}

    @contextmanager
    def on(self, part: str) -> Iterator[None]:
        """Count the time of a block under the name of a part."""
        began = time.perf_counter()
        try:
            yield
        finally:
            self._spent[part] += time.perf_counter() - began

    def is_up(self) -> bool:
        """Whether the time limit is exceeded."""
        return time.perf_counter() - self._began > self._time_limit

    def timing(self) -> Timing:
        """Return the time so far, in all and by parts."""
        return Timing(time.perf_counter() - self._began, **self._spent)
