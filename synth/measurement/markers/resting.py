"""Markers at rest: the mean of the frames of each, in each posture."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from synth.errors import InputError, Mistake
from synth.measurement.markers.markers import Marker, Readings

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

_SAME_POSTURE = math.radians(0.5)
_SPREAD = 2e-3  # m; a marker that moves by more while it is measured was not at rest


class RestingMarkers:
    """Frames of markers, by marker and posture."""

    def __init__(self) -> None:
        self._frames: dict[tuple[Marker, int, int], list[list[float]]] = {}

    def add(self, marker: Marker, positions: Sequence[Sequence[float]], joints: Sequence[float]) -> None:
        """Add frames of a marker.

        Args:
            marker: Which.
            positions: Where it was seen, shape (n, 3), m.
            joints: Where the joints stood meanwhile, (joint 1, joint 2), rad.
        """
        key = (marker, round(joints[0] / _SAME_POSTURE), round(joints[1] / _SAME_POSTURE))
        if len(positions):
            self._frames.setdefault(key, []).extend([*position, *joints] for position in positions)

    def readings(self, named: Collection[str], file: str, warnings: Sequence[str] = ()) -> Readings:
        """Return the means; what moved is left out.

        Args:
            named: The markers that the file names.
            file: Its name, for the mistakes.
            warnings: What was noticed before.

        Raises:
            InputError: No marker was seen at rest.
        """
        if not self._frames:
            raise InputError([Mistake("holds no marker that was seen", file)])
        unseen = sorted(set(named) - {marker.name for marker, *_ in self._frames})
        told = [*warnings, *(f"{name} was never seen" for name in unseen)]
        kept, means = [], []
        for (marker, *_), frames in self._frames.items():
            array = np.array(frames)
            spread = float(np.sqrt(np.sum(array[:, :3].var(axis=0))))
            if spread > _SPREAD:
                told.append(
                    f"{marker.name} is left out: it moved by {1e3 * spread:.1f} mm while it was measured"
                )
                continue
            kept.append(marker)
            means.append(array.mean(axis=0))
        if not kept:
            told.append("was the arm at rest, and is the unit right?")
            raise InputError([Mistake("; ".join(told), file)])
        table = np.array(means)
        return Readings(tuple(kept), table[:, :3], table[:, 3:], tuple(told))
