"""TRC (track row column), as OpenSim, Vicon, Cortex and others write it.

Five rows of header with tabs between: the file's type, names of settings, their values, names of markers,
each over three columns, axes X1 Y1 Z1 X2 ...; then the frames. The number of frames and of markers that the
settings state is often wrong: the rows are believed.
"""

from __future__ import annotations

import re
from itertools import pairwise
from typing import TYPE_CHECKING, NoReturn

from synth.errors import InputError, Mistake
from synth.measurement.captures.capture import Capture, Track, lines_of, metre_in

if TYPE_CHECKING:
    from collections.abc import Sequence

_X, _Y, _Z = (re.compile(rf"{axis}\d*", re.IGNORECASE) for axis in "xyz")

_Row = tuple[int, list[str]]


def begins_as_trc(line: str) -> bool:
    """Whether a file with this first line is TRC."""
    return line.lstrip().lower().startswith("pathfiletype")


def trc_capture(text: str, file: str) -> Capture:
    """Read a TRC file.

    Args:
        text: The file.
        file: Its name, for the mistakes.

    Raises:
        InputError: It lacks a row of the header, or names and columns do not match.
    """
    lines = [(number, line) for number, line in enumerate(lines_of(text), 1) if line.strip()]
    rows: list[_Row] = [(number, [cell.strip() for cell in line.split("\t")]) for number, line in lines]
    at = next((k for k, (_, cells) in enumerate(rows) if cells[0].lower().startswith("frame")), None)
    if at is None or at + 1 >= len(rows):
        _refuse("has no rows Frame# and X1 Y1 Z1 that say which marker is in which column", file, rows[-1][0])
    metre = _metre(lines[:at], file)
    axes = rows[at + 1][1]
    columns = [
        k
        for k in range(len(axes) - 2)
        if _X.fullmatch(axes[k]) and _Y.fullmatch(axes[k + 1]) and _Z.fullmatch(axes[k + 2])
    ]
    if not columns:
        _refuse("must have the row X1 Y1 Z1 X2 ... below the names of the markers", file, rows[at + 1][0])
    before = sum(cell.lower().startswith(("frame", "time")) for cell in rows[at][1][:2])
    if columns[0] != before:
        _refuse(
            f"must have X1 in column {before + 1}, below the name of the first marker", file, rows[at + 1][0]
        )
    return Capture(_tracks(rows[at], columns, file), tuple(rows[at + 2 :]), metre)


def _metre(header: Sequence[tuple[int, str]], file: str) -> float:
    """Return how many units of the file are a metre: what stands below "Units"."""
    for (_, names), (number, values) in pairwise(header):
        words = [word.lower() for word in names.split()]
        if "units" in words:
            below = values.split()
            at = words.index("units")
            return metre_in(below[at] if at < len(below) else "", file, number)
    return metre_in("", file, header[0][0])


def _tracks(row: _Row, columns: list[int], file: str) -> tuple[Track, ...]:
    """Return the markers: a name stands over its x, or the names stand side by side."""
    line, cells = row
    named = {k: cell for k, cell in enumerate(cells) if cell and k >= columns[0]}
    if set(named) <= set(columns):
        return tuple(Track(name, k) for k, name in named.items())
    if len(named) != len(columns):
        _refuse(f"has {len(named)} names for {len(columns)} times X Y Z: which marker is which?", file, line)
    return tuple(Track(name, k) for name, k in zip(named.values(), columns, strict=True))


def _refuse(what: str, file: str, line: int) -> NoReturn:
    raise InputError([Mistake(what, file, line)])
