"""What was seen last and what is to be done now: written by sources and checker, read for every browser.

A reader that is slow gets the newest of each kind and nothing older: what is shown is never late. No axis of
a stream is believed to be up: where P1 and P2 show that y or x is, its frame is turned so that z is.
"""

from __future__ import annotations

import json
import threading
import time
from collections import deque
from typing import TYPE_CHECKING

import numpy as np

from synth.measurement import Readings, axis_up, turn_to_z

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

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
        self._up = "z"  # of the stream; held while P1 or P2 is not seen
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
        """Take a frame: markers with their positions in the base frame, but for the axis that is up."""
        with self._changed:
            self._seen += 1
            self._frames.append((self._clock(), frame))
            latest = _newest(self._recent())
            self._up = axis_up(latest) or self._up
            latest = self._upright(latest)
        self.publish(
            "frame",
            {
                "count": self._seen,
                "at": time.time(),
                "markers": dict(zip(latest.names, np.round(latest.positions, 6).tolist(), strict=True)),
                "joints": frame.joints[-1].tolist(),
                "up": self._up,
            },
        )

    def recent(self) -> list[Readings]:
        """Return the frames of the last half second, the oldest first, with z up."""
        with self._changed:
            return [self._upright(frame) for frame in self._recent()]

    def _recent(self) -> list[Readings]:
        oldest = self._clock() - WINDOW
        while self._frames and self._frames[0][0] < oldest:
            self._frames.popleft()
        return [frame for _, frame in self._frames]

    def _upright(self, frame: Readings) -> Readings:
        return Readings(frame.markers, frame.positions @ turn_to_z(self._up).T, frame.joints, frame.warnings)

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


def _newest(frames: list[Readings]) -> Readings:
    """Return the last that was seen of each marker."""
    last = {name: (each, k) for each in frames for k, name in enumerate(each.names)}
    return Readings(
        tuple(each.markers[k] for each, k in last.values()),
        np.array([each.positions[k] for each, k in last.values()]),
        np.array([each.joints[k] for each, k in last.values()]),
    )
