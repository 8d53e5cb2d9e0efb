"""CSV exports of Motive and Tracking Tools in version 1.1: a line a frame, with what was seen in it.

    frame,INDEX,TIME,BODIES,{id,x,y,z,qx,qy,qz,qw,yaw,pitch,roll},MARKERS,{x,y,z,id,name}

The markers are the measured ones. The file does not say its unit, which is the metre: whoever uses the
positions must hold distances against known ones.
"""

from __future__ import annotations

import csv

from synth.measurement.captures.capture import Capture, Track, lines_of, refuse

_BEFORE_BODIES, _OF_BODY, _OF_MARKER = 4, 11, 5  # cells
_LOST = "#"  # is in the cells of what was not seen

_Seen = dict[tuple[str, int], list[str]]


def begins_as_motive_frames(line: str) -> bool:
    """Whether a file with this first line is such an export."""
    word = line.partition(",")[0].strip().lower()
    return word in {"comment", "info", "righthanded", "lefthanded"}


def motive_frames_capture(text: str, file: str) -> Capture:
    """Read an export in version 1.1.

    Args:
        text: The file.
        file: Its name, for the mistakes.

    Raises:
        InputError: It is left-handed, or a line has not as many cells as it says.
    """
    frames: list[tuple[int, _Seen]] = []
    reader = csv.reader(lines_of(text))
    try:
        for cells in reader:
            word = cells[0].strip().lower() if cells else ""
            if word == "lefthanded":
                refuse(
                    "is left-handed, so all in it is mirrored: export it right-handed", file, reader.line_num
                )
            if word == "frame":
                frames.append((reader.line_num, _seen(cells, file, reader.line_num)))
    except csv.Error as error:
        refuse(f"is no CSV: {error}", file, reader.line_num)
    columns = {key: 3 * k for k, key in enumerate(dict.fromkeys(key for _, seen in frames for key in seen))}
    lost = [""] * 3
    rows = [(line, [cell for key in columns for cell in seen.get(key, lost)]) for line, seen in frames]
    return Capture(tuple(Track(name, column) for (name, _), column in columns.items()), rows, metre=1.0)


def _seen(cells: list[str], file: str, line: int) -> _Seen:
    """Return x, y and z of the markers of a frame, by their names and how often each was there before."""
    count_at = _BEFORE_BODIES + _OF_BODY * _count(cells, _BEFORE_BODIES - 1, file, line)
    start = count_at + 1
    end = start + _OF_MARKER * _count(cells, count_at, file, line)
    if len(cells) < end or any(cell.strip() for cell in cells[end:]):
        refuse(f"has {len(cells)} cells where {end} are said: which marker is which?", file, line)
    found: _Seen = {}
    for k in range(start, end, _OF_MARKER):
        name, point = cells[k + 4].strip(), cells[k : k + 3]
        before = sum(name == other for other, _ in found)
        found[name, before] = [""] * 3 if _LOST in "".join(point) else point
    return found


def _count(cells: list[str], at: int, file: str, line: int) -> int:
    """Return how many of something follow, no more than the line has cells."""
    word = cells[at].strip() if at < len(cells) else ""
    if not (word.isascii() and word.isdigit() and len(word) < len(str(len(cells))) + 1):
        refuse("does not say how many rigid bodies and markers it holds", file, line)
    return int(word)
