"""What was seen last and what is to be done now: written by sources and checker, read for every browser.

A reader that is slow gets the newest of each kind and nothing older: what is shown is never late.
"""

from __future__ import annotations

import json
import threading
import time
from collections import deque
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from synth.measurement import Readings

WINDOW = 0.5  # s: what was seen in this time is measured together, and a marker not seen in it is lost
_MOST_FRAMES = 1000  # in the window, of a source that is as fast as it can be


class Feed:
    """The newest of all that is told.

    Args:
        clock: Returns the time, s, for the age of frames.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._changed = threading.Condition()
        self._frames: deque[tuple[float, Readings]] = deque(maxlen=_MOST_FRAMES)
        self._events: dict[str, tuple[int, str]] = {}
        self._number = 0
        self._seen = 0
        self._closed = False

    @property
    def closed(self) -> bool:
        """Whether nothing more is told."""
        return self._closed

    @property
    def seen(self) -> int:
        """How many frames came so far."""
        return self._seen

    def close(self) -> None:
        """Let all that wait for something go."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()

    def wait(self, seconds: float) -> None:
        """Wait, but no longer than until the feed is closed."""
        with self._changed:
            self._changed.wait_for(lambda: self._closed, seconds)

    def saw(self, frame: Readings) -> None:
        """Take a frame: markers with their positions in the base frame."""
        with self._changed:
            self._seen += 1
            self._frames.append((self._clock(), frame))
            latest = {
                marker.name: (position, joints)
                for each in self._recent()
                for marker, position, joints in zip(each.markers, each.positions, each.joints, strict=True)
            }
        self.publish(
            "frame",
            {
                "count": self._seen,
                "at": time.time(),
                "markers": {name: np.round(place, 6).tolist() for name, (place, _) in latest.items()},
                "joints": frame.joints[-1].tolist(),
            },
        )

    def recent(self) -> list[Readings]:
        """Return the frames of the last half second, the oldest first."""
        with self._changed:
            return self._recent()

    def _recent(self) -> list[Readings]:
        oldest = self._clock() - WINDOW
        while self._frames and self._frames[0][0] < oldest:
            self._frames.popleft()
        return [frame for _, frame in self._frames]

    def publish(self, kind: str, content: Mapping[str, object]) -> None:
        """Tell all readers something; it stands in the place of the last of its kind."""
        data = json.dumps(content, allow_nan=False)
        with self._changed:
            self._number += 1
            self._events[kind] = self._number, data
            self._changed.notify_all()

    def after(self, number: int, patience: float) -> tuple[int, list[tuple[str, str]]]:
        """Return what is new, waiting for it a while.

        Args:
            number: Of the newest that the reader has; 0 for a new one.
            patience: How long to wait, s.

        Returns:
            The number of the newest, and kind and JSON of each that is new.
        """
        with self._changed:
            self._changed.wait_for(lambda: self._closed or self._number > number, patience)
            told = sorted((at, kind, data) for kind, (at, data) in self._events.items() if at > number)
            return self._number, [(kind, data) for _, kind, data in told]
