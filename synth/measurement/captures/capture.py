"""A capture: the table that tracking software exports, one row a frame and three columns a marker."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, NoReturn

import numpy as np

from synth.arrays import frozen_value
from synth.errors import InputError, Mistake
from synth.measurement.captures.cells import is_gap, number_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from synth.arrays import FloatArray

MISTAKES_AT_MOST = 10
FARTHEST = 100.0  # m; a coordinate beyond this is no measurement of this robot
# How many of a unit are a metre, by its first letters or its sign.
_UNITS = {
    "mm": 1000.0,
    "millimeter": 1000.0,
    "millimetre": 1000.0,
    "cm": 100.0,
    "centimeter": 100.0,
    "centimetre": 100.0,
    "m": 1.0,
    "meter": 1.0,
    "metre": 1.0,
}


@dataclass(frozen=True)
class Track:
    """The columns of one marker.

    Attributes:
        name: As the file has it.
        column: Of x, from 0; y and z follow.
    """

    name: str
    column: int


@frozen_value
class Capture:
    """A table of frames, whose cells are not looked at yet.

    Attributes:
        tracks: The markers that were measured; a name may come twice, where a marker was lost and found.
        rows: Frames: the line in the file, or the number of the frame, from 1, and the cells.
        metre: How many units of the file are a metre.
        zeros_are_gaps: Whether a marker at (0, 0, 0) was not seen.
        solved: Names of which the file has only positions that follow from a rigid body.
    """

    tracks: tuple[Track, ...]
    rows: Sequence[tuple[int, Sequence[str | float]]]
    metre: float
    zeros_are_gaps: bool = False
    solved: tuple[str, ...] = ()

    def seen(self, track: Track, file: str, mistakes: list[Mistake]) -> FloatArray:
        """Return where a marker was seen, shape (n, 3), m, without its gaps; mistakes are noted."""
        found = []
        farthest = FARTHEST * self.metre
        for line, cells in self.rows:
            try:  # the many cells that are as they should be; anything else is looked at below
                x, y, z = map(float, cells[track.column : track.column + 3])
            except ValueError:
                x = y = z = np.inf
            if abs(x) <= farthest and abs(y) <= farthest and abs(z) <= farthest:  # not of what is no number
                found.append((x, y, z))
            elif len(mistakes) <= MISTAKES_AT_MOST:
                mistakes.extend(self._wrong(track, line, cells, file))
        points = np.array(found, dtype=np.float64).reshape(-1, 3) / self.metre
        somewhere = points.any(axis=1)  # not exactly at the origin, where some systems put what they lost
        return points[somewhere] if self.zeros_are_gaps or somewhere.any() else points

    def _wrong(self, track: Track, line: int, cells: Sequence[str | float], file: str) -> Iterator[Mistake]:
        """Yield what is wrong with a marker in a frame; nothing, if it was not seen."""
        point = cells[track.column : track.column + 3]
        if len(point) < 3 or any(map(is_gap, point)):
            return
        for axis, cell in zip("xyz", point, strict=True):
            value = number_of(cell)
            if value is not None and abs(value) <= FARTHEST * self.metre:
                continue
            what = (
                f"must be a number, but is {str(cell)[:30]!r}"
                if value is None
                else f"is farther than {FARTHEST:.0f} m: which unit is it in?"
            )
            yield Mistake(what, file, line, f"{axis} of {shown(track.name)}")
            return


def metre_in(word: str, file: str, line: int | None) -> float:
    """Return how many of a unit are a metre, or refuse a unit that is not known."""
    unit = word.strip().strip("()[]").lower()
    known = next((name for name in (unit, unit.removesuffix("s")) if name in _UNITS), "")
    if not known:
        said = f"is {shown(word)}" if unit else "is not said"
        refuse(f"the unit of length {said}: in which are these numbers? There are mm, cm and m", file, line)
    return _UNITS[known]


def refuse(what: str, file: str, line: int | None = None) -> NoReturn:
    """Refuse a file for one mistake, maybe of a line."""
    raise InputError([Mistake(what, file, line)])


def lines_of(text: str) -> list[str]:
    """Return the lines of a text; a line may end in any number of CR, with LF or without."""
    return re.split(r"\r*\n|\r", text)


def shown(word: str) -> str:
    """Return a word of a file as it can be shown: short, in quotes, without control characters."""
    return repr(" ".join(word.split())[:30])
