"""TSV exports of QTM (Qualisys): rows of settings, then frames; millimetres, and zeros where nothing is seen.

Frame and time may stand before the coordinates, with a row of column names or without one.
"""

from __future__ import annotations

from synth.measurement.captures.capture import Capture, Track, lines_of, refuse, shown
from synth.measurement.captures.cells import number_of

_MILLIMETRES = 1000.0
_BEFORE = ("frame", "time")  # columns that may stand before the coordinates

_Row = tuple[int, list[str]]


def begins_as_qtm(line: str) -> bool:
    """Whether a file with this first line is an export of QTM."""
    return line.lstrip().upper().startswith(("NO_OF_FRAMES", "NO_OF_MARKERS", "NO_OF_CAMERAS"))


def qtm_capture(text: str, file: str) -> Capture:
    """Read an export of QTM.

    Args:
        text: The file.
        file: Its name, for the mistakes.

    Raises:
        InputError: It names no markers, has no 3D data, or names and columns do not match.
    """
    rows = [
        (number, [cell.strip() for cell in line.split("\t")])
        for number, line in enumerate(lines_of(text), 1)
        if line.strip()
    ]
    settings = {cells[0]: (k, cells[1:]) for k, (_, cells) in enumerate(rows) if _is_setting(cells[0])}
    included = " ".join(settings.get("DATA_INCLUDED", (0, ["3D"]))[1]).strip()
    if included and "3D" not in included.upper().split():
        refuse(f"holds {shown(included)} and not 3D: export the 3D data", file, rows[0][0])
    if "MARKER_NAMES" not in settings:
        refuse("has no row MARKER_NAMES: which marker is which?", file, rows[0][0])
    at, names = settings["MARKER_NAMES"]
    names = [name for name in names if name]
    frames = rows[max(k for k, _ in settings.values()) + 1 :]
    before, header = _before(frames, 3 * len(names), file, rows[at][0])
    tracks = tuple(Track(name, before + 3 * k) for k, name in enumerate(names))
    return Capture(tracks, frames[header:], _MILLIMETRES, zeros_are_gaps=True)


def _is_setting(word: str) -> bool:
    """Whether a row is one of settings: it begins with a word in capitals, such as NO_OF_FRAMES."""
    return word.isupper() and word.lower() not in _BEFORE and number_of(word) is None


def _before(rows: list[_Row], coordinates: int, file: str, line: int) -> tuple[int, int]:
    """Return how many columns stand before the coordinates, and how many rows before the frames."""
    first = [cell.lower() for cell in rows[0][1]] if rows else []
    header = bool(first) and bool(first[0]) and number_of(first[0]) is None
    if header:
        width = max(k + 1 for k, cell in enumerate(first) if cell)
        before = sum(cell in _BEFORE for cell in first[:2])
    else:
        width = max((len(cells) for _, cells in rows), default=coordinates)
        width -= (width - coordinates) % 2 and all(cells[-1] == "" for _, cells in rows)  # a tab at the end
        before = 2 if width - coordinates == 2 else 0
    if width != before + coordinates:
        refuse(f"names {coordinates // 3} markers, and has {width} columns: which is which?", file, line)
    return before, int(header)
