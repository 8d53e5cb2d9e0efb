"""Markers by their names, and the readings of them."""

from __future__ import annotations

import re
from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen, frozen_value
from synth.errors import InputError, Mistake

if TYPE_CHECKING:
    from collections.abc import Sequence

    from synth.robot import Robot

MARKER_ERROR = 0.455e-3  # m, mean 3D error of a marker that a camera system sees
# The length of a vector whose three components are normal with standard deviation 1 is sqrt(8 / pi) in the
# mean.
_MEAN_LENGTH = float(np.sqrt(8.0 / np.pi))
MARKER_NAMES = (
    "there are P1 to P5, A1:150 and A2:-50.5 on the axes, E:-60 at the link's end, L050 on the link (mm)"
)
_NUMBER = r"[+-]?\d+(?:\.\d*)?"
_OFFSET = re.compile(rf"(A1|A2|E):({_NUMBER})")
_ON_LINK = re.compile(r"L(\d+(?:\.\d*)?)")


class Place(Enum):
    """What a marker is fixed to."""

    AXIS_1 = "axis 1"
    AXIS_2 = "axis 2"
    LINK_END = "the link's end"
    END_EFFECTOR = "the end effector"
    LINK = "the link"


@dataclass(frozen=True)
class Marker:
    """A marker.

    Attributes:
        name: As it was given.
        place: What it is fixed to.
        offset: Where, m: on axis 1 from P1 towards P2; on axis 2 from P3 towards P4; along the link's end,
            negative back from it; along the link from P2. 0 for the end effector.
    """

    name: str
    place: Place
    offset: float


def marker_named(name: str, robot: Robot) -> Marker | None:
    """Return the marker of a name such as "P3", "A2:-50.5", "E:-60" (mm) or "L050"; None for no such name."""
    word = name.strip().upper()
    points = {
        "P1": (Place.AXIS_1, 0.0),
        "P2": (Place.AXIS_1, robot.d12),
        "P3": (Place.AXIS_2, 0.0),
        "P4": (Place.AXIS_2, robot.d34),
        "P5": (Place.END_EFFECTOR, 0.0),
    }
    if word in points:
        return Marker(word, *points[word])
    if match := _OFFSET.fullmatch(word):
        place = {"A1": Place.AXIS_1, "A2": Place.AXIS_2, "E": Place.LINK_END}[match[1]]
        return Marker(word, place, float(match[2]) / 1000.0)
    if match := _ON_LINK.fullmatch(word):
        return Marker(word, Place.LINK, float(match[1]) / 1000.0)
    return None


def markers_named(names: str, robot: Robot) -> tuple[Marker, ...]:
    """Return the markers of names with spaces or commas between, such as "P1 P2 A2:-150".

    Raises:
        InputError: There is no such marker, or one is there twice.
    """
    words = names.replace(",", " ").split()
    found = [(word, marker_named(word, robot)) for word in words]
    mistakes = [
        Mistake(f"there is no marker {w[:20]!r}; {MARKER_NAMES}", key="markers")
        for w, m in found
        if m is None
    ]
    twice = {word for word in words if words.count(word) > 1}
    mistakes += [Mistake(f"{word[:20]} is there twice", key="markers") for word in sorted(twice)]
    if mistakes:
        raise InputError(mistakes)
    return tuple(marker for _, marker in found if marker is not None)


def sigma_of(mean_error: float) -> float:
    """Return the standard deviation of each coordinate, m, from the mean 3D error of a marker, m."""
    return mean_error / _MEAN_LENGTH


@frozen_value
class Readings:
    """Where markers were seen, each in one posture of the arm.

    Attributes:
        markers: One for each reading; a marker may come again in another posture.
        positions: In the base frame, shape (m, 3), m; the means of the frames.
        joints: What the encoders said, (joint 1, joint 2), shape (m, 2), rad.
        warnings: What was noticed in reading them, as sentences.
    """

    markers: tuple[Marker, ...]
    positions: FloatArray
    joints: FloatArray
    warnings: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "positions", frozen(self.positions))
        object.__setattr__(self, "joints", frozen(self.joints))

    @property
    def names(self) -> tuple[str, ...]:
        """Their names."""
        return tuple(marker.name for marker in self.markers)

    @property
    def offsets(self) -> FloatArray:
        """Their offsets, shape (m,), m."""
        return np.array([marker.offset for marker in self.markers])

    def at(self, place: Place) -> FloatArray:
        """Return which are fixed to a place, as indices."""
        return np.array([k for k, marker in enumerate(self.markers) if marker.place is place], dtype=np.intp)

    def take(self, chosen: Sequence[int]) -> Readings:
        """Return some of them."""
        index = list(chosen)
        return Readings(
            tuple(self.markers[k] for k in index), self.positions[index], self.joints[index], self.warnings
        )

    def without(self, name: str) -> Readings:
        """Return all but those of one marker."""
        return self.take([k for k, other in enumerate(self.names) if other != name])
