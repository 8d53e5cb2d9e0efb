"""CSV exports of Motive (OptiTrack), versions 1.2 and later.

A line of settings, then rows that say for each column what it belongs to (Type), its name, its ID, in late
versions its parent, what it is (Position, Rotation, Mean Marker Error) and along which axis; then the frames.
`Marker` columns are measured. `Rigid Body Marker` and `Bone Marker` columns are where the body says that the
marker is: they move as one and hide an error of a single marker.
"""

from __future__ import annotations

import csv

from synth.errors import InputError, Mistake
from synth.measurement.captures.capture import Capture, Track, lines_of, metre_in, refuse, shown

_MEASURED = "marker"
_SOLVED = ("rigid body marker", "bone marker")
_TYPES = {_MEASURED, *_SOLVED, "rigid body", "bone", "skeleton", "asset", "marker set", "markerset"}
_AGAIN = "export it again with the header information, or as TRC"

_Rows = list[tuple[int, list[str]]]


def begins_as_motive(line: str) -> bool:
    """Whether a file with this first line is an export of Motive, with its header or without."""
    cells = [cell.strip().strip('"').lower() for cell in line.split(",")]
    is_axis_row = len(cells) > 1 and cells[0] == "frame" and cells[1].startswith("time")
    return cells[0] == "format version" or is_axis_row or _are_kinds(cells)


def motive_capture(text: str, file: str) -> Capture:
    """Read an export of Motive.

    Args:
        text: The file.
        file: Its name, for the mistakes.

    Raises:
        InputError: It has no header, no unit of length, or no measured markers.
    """
    rows = _rows(text, file)
    at = next((k for k, (_, cells) in enumerate(rows) if cells[0].lower() == "frame"), None)
    kinds = next((k for k, (_, cells) in enumerate(rows[:at]) if _are_kinds(cells)), None)
    if at is None or kinds is None or at - kinds < 3:
        refuse(
            "is an export of Motive without the rows Type, Name and Frame,Time: which marker is which, and "
            f"in which unit are these numbers? {_AGAIN}",
            file,
            rows[0][0],
        )
    metre = _metre(rows[:kinds], file, rows[0][0])
    measured, solved = _tracks(rows[kinds][1], rows[kinds + 1][1], rows[at - 1][1], rows[at][1])
    if not measured and not solved:
        has = sorted({cell.lower() for cell in rows[kinds][1]} & _TYPES)
        refuse(f"has no positions of markers, only {', '.join(has)}: export the markers too", file)
    names = {track.name for track in measured}
    return Capture(
        tuple(measured),
        rows[at + 1 :],
        metre,
        solved=tuple(dict.fromkeys(track.name for track in solved if track.name not in names)),
    )


def _are_kinds(cells: list[str]) -> bool:
    """Whether a row says what the columns belong to."""
    return cells[0] == "" and any(cell.lower() in _TYPES for cell in cells)


def _rows(text: str, file: str) -> _Rows:
    """Return the rows that hold anything, with their lines."""
    lines = csv.reader(lines_of(text))
    try:
        return [(lines.line_num, [c.strip() for c in cells]) for cells in lines if any(map(str.strip, cells))]
    except csv.Error as error:
        raise InputError([Mistake(f"is no CSV: {error}", file, lines.line_num)]) from None


def _metre(rows: _Rows, file: str, line: int) -> float:
    """Return how many units of the file are a metre: what stands after "Length Units"."""
    said = {
        cells[k + 1] for _, cells in rows for k in range(len(cells) - 1) if cells[k].lower() == "length units"
    }
    if len(said) > 1:
        refuse(f"says {' and '.join(map(shown, sorted(said)))} for a unit", file, line)
    if not said:
        refuse(f"does not say Length Units: in which unit are these numbers? {_AGAIN}", file, line)
    return metre_in(said.pop(), file, line)


def _tracks(
    kinds: list[str], names: list[str], measures: list[str], axes: list[str]
) -> tuple[list[Track], list[Track]]:
    """Return the markers that were measured and those that were solved for."""
    measured, solved = [], []
    for k in range(min(map(len, (kinds, names, measures, axes))) - 2):
        whole = (
            [axis.lower() for axis in axes[k : k + 3]] == ["x", "y", "z"]
            and {measure.lower() for measure in measures[k : k + 3]} == {"position"}
            and len({(kinds[j], names[j]) for j in range(k, k + 3)}) == 1
        )
        if whole and kinds[k].lower() == _MEASURED:
            measured.append(Track(names[k], k))
        elif whole and kinds[k].lower() in _SOLVED:
            solved.append(Track(names[k], k))
    return measured, solved
