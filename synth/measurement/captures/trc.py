"""TRC (track row column), as OpenSim, Vicon, Cortex and others write it.

Five rows of header with tabs between: the file's type, names of settings, their values, names of markers,
each over three columns, axes X1 Y1 Z1 X2 ...; then the frames. The number of frames and of markers that the
settings state is often wrong: the rows are believed.
"""

from __future__ import annotations

import re
from itertools import pairwise
from typing import TYPE_CHECKING

from synth.measurement.captures.capture import Capture, Track, lines_of, metre_in, refuse

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
    between = "\t" if "\t" in lines[0][1] else ","
    rows = [(number, [cell.strip() for cell in line.split(between)]) for number, line in lines]
    at = next((k for k, (_, cells) in enumerate(rows) if cells[0].lower().startswith("frame")), None)
    if at is None or at + 1 >= len(rows):
        refuse("has no rows Frame# and X1 Y1 Z1 that say which marker is in which column", file, rows[-1][0])
    tracks = _tracks(rows[at], rows[at + 1], rows[at + 2 :], file)
    return Capture(tracks, rows[at + 2 :], _metre(rows[:at], file))


def _metre(header: Sequence[_Row], file: str) -> float:
    """Return how many units of the file are a metre: what stands below "Units"."""
    for (_, names), (number, values) in pairwise(header):
        words = [name.lower() for name in " ".join(names).split()]
        if "units" in words:
            below = " ".join(values).split()
            at = words.index("units")
            return metre_in(below[at] if at < len(below) else "", file, number)
    return metre_in("", file, header[0][0])


def _tracks(names: _Row, axes: _Row, frames: Sequence[_Row], file: str) -> tuple[Track, ...]:
    """Return the markers: a name stands over its x, or the names stand in the order of the columns.

    The row of axes begins one column too far left or right in some dialects: only its order counts.
    """
    columns = [
        k
        for k in range(len(axes[1]) - 2)
        if _X.fullmatch(axes[1][k]) and _Y.fullmatch(axes[1][k + 1]) and _Z.fullmatch(axes[1][k + 2])
    ]
    if not columns:
        refuse("must have the row X1 Y1 Z1 X2 ... below the names of the markers", file, axes[0])
    before = sum(cell.lower().startswith(("frame", "time")) for cell in names[1][:2])
    for line, cells in frames:
        width = max((k + 1 for k, cell in enumerate(cells) if cell), default=0)
        if width > before + 3 * len(columns):
            refuse(f"has {width} columns, and X Y Z are said of {before + 3 * len(columns)}", file, line)
    named = {k: cell for k, cell in enumerate(names[1]) if cell and k >= before}
    if len(named) == len(columns):
        return tuple(Track(name, before + 3 * k) for k, name in enumerate(named.values()))
    if not set(named) <= set(columns):
        refuse(
            f"has {len(named)} names for {len(columns)} times X Y Z: which marker is which?", file, names[0]
        )
    return tuple(Track(name, before + 3 * columns.index(k)) for k, name in named.items())
