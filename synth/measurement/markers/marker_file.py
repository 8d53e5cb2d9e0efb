"""Markers from a file: CSV with a header, or the same as JSON lines; checked as strictly as a task.

    marker,x_mm,y_mm,z_mm,joint1_deg,joint2_deg,frame
    P3,-432.1,20.4,310.0,180,180,1

Rows of one marker in one posture are frames: their mean counts. A row without coordinates is a gap.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from synth.errors import InputError, Mistake
from synth.measurement.markers.marker_rows import UNITS, Row, csv_rows, is_gap, json_rows, number_of, text_of
from synth.measurement.markers.markers import Marker, Readings, marker_named

if TYPE_CHECKING:
    import os
    from collections.abc import Iterator

    from synth.arrays import FloatArray
    from synth.robot import Robot

_MISTAKES_AT_MOST = 10
_FARTHEST = 100.0  # m; a coordinate beyond this is no measurement of this robot
_NAMES = "there are P1 to P5, A1:150 and A2:-50.5 on the axes, E:-60 at the link's end, L050 on the link (mm)"
_SAME_POSTURE = math.radians(0.5)
_STRAIGHT = math.pi  # joint 2 where nothing is said of it
_SPREAD = 2e-3  # m; a marker that moves by more while it is measured was not at rest


def load_readings(path: str | os.PathLike[str], robot: Robot, joint1: float) -> Readings:
    """Read a file of markers.

    Args:
        path: The file.
        robot: The hardware, which says where P2 and P4 are on their axes.
        joint1: The angle of joint 1 where the file does not say it, rad. Joint 2 is at 180 deg then.

    Returns:
        The readings, in the base frame, m and rad; the mean of the frames of each posture.

    Raises:
        InputError: The file cannot be read or is wrong; with its mistakes, up to ten.
    """
    file = str(path)
    text = text_of(Path(path), file)
    is_json = text.lstrip()[:1] == "{"
    rows = json_rows(text, file) if is_json else csv_rows(text, file)
    return _readings(rows, robot, joint1, file)


def load_points(path: str | os.PathLike[str]) -> tuple[FloatArray, FloatArray | None]:
    """Read a file of positions of the end effector: the columns of markers but for the marker.

    Args:
        path: The file.

    Returns:
        Positions in the base frame, shape (n, 3), m, and joint angles, shape (n, 2), rad, or None if the
        file has
        none. Gaps are passed over.

    Raises:
        InputError: The file cannot be read or is wrong; with its mistakes, up to ten.
    """
    file = str(path)
    text = text_of(Path(path), file)
    is_json = text.lstrip()[:1] == "{"
    rows = (json_rows if is_json else csv_rows)(text, file, named=False)
    mistakes: list[Mistake] = []
    table = [list(_numbers(row, number, file, mistakes)) for number, row in rows]
    seen = [values for values in table if values[0] is not None]
    angled = [value is not None for values in seen for value in values[3:]]
    if any(angled) and not all(angled):
        mistakes.append(Mistake("must have both joint angles in every row, or none", file))
    if mistakes:
        raise InputError(mistakes[:_MISTAKES_AT_MOST])
    if not seen:
        raise InputError([Mistake("holds no points", file)])
    array = np.array(seen, dtype=np.float64)
    return array[:, :3], np.radians(array[:, 3:]) if all(angled) else None


def _readings(rows: list[Row], robot: Robot, joint1: float, file: str) -> Readings:
    """Return the means of the frames."""
    mistakes: list[Mistake] = []
    seen: dict[tuple[str, int, int], list[list[float]]] = {}
    markers: dict[str, Marker] = {}
    for number, row in rows:
        marker = marker_named(str(row["marker"]), robot)
        if marker is None:
            shown = repr(str(row["marker"])[:20])
            mistakes.append(Mistake(f"there is no marker {shown}; {_NAMES}", file, number, "marker"))
            continue
        values = [*_numbers(row, number, file, mistakes)]
        if values[0] is None:  # a gap
            continue
        first = joint1 if values[3] is None else math.radians(values[3])
        second = _STRAIGHT if values[4] is None else math.radians(values[4])
        markers[marker.name] = marker
        key = (marker.name, round(first / _SAME_POSTURE), round(second / _SAME_POSTURE))
        seen.setdefault(key, []).append([*(float(v or 0.0) for v in values[:3]), first, second])
    if mistakes:
        more = [Mistake("has more such lines", file)] if len(mistakes) > _MISTAKES_AT_MOST else []
        raise InputError([*mistakes[:_MISTAKES_AT_MOST], *more])
    if not seen:
        raise InputError([Mistake("holds no marker that was seen", file)])
    named = {m.name for _, row in rows if (m := marker_named(str(row["marker"]), robot))}
    warnings = [f"{name} was never seen" for name in sorted(named - set(markers))]
    kept, means = [], []
    for (name, *_), frames in seen.items():
        array = np.array(frames)
        spread = float(np.sqrt(np.sum(array[:, :3].var(axis=0))))
        if spread > _SPREAD:
            warnings.append(f"{name} is left out: it moved by {1e3 * spread:.1f} mm while it was measured")
            continue
        kept.append(markers[name])
        means.append(array.mean(axis=0))
    if not kept:
        raise InputError([Mistake("; ".join(warnings), file)])
    table = np.array(means)
    return Readings(tuple(kept), table[:, :3], table[:, 3:], tuple(warnings))


def _numbers(
    row: dict[str, object], number: int, file: str, mistakes: list[Mistake]
) -> Iterator[float | None]:
    """Yield x, y, z, m, and both angles, deg; None for what is not there; mistakes are noted."""
    unit = next(unit for unit in UNITS if f"x_{unit}" in row)
    cells = [row[f"{axis}_{unit}"] for axis in "xyz"]
    gap = any(is_gap(cell) for cell in cells)
    for axis, cell in zip("xyz", cells, strict=True):
        if gap:
            yield None
            continue
        value = number_of(cell)
        if value is None or abs(value) / UNITS[unit] > _FARTHEST:
            what = (
                "must be a number"
                if value is None
                else f"is farther than {_FARTHEST:.0f} m: which unit is it in?"
            )
            mistakes.append(
                Mistake(
                    f"{what}, but is {str(cell)[:30]!r}" if value is None else what,
                    file,
                    number,
                    f"{axis}_{unit}",
                )
            )
            yield 0.0
        else:
            yield value / UNITS[unit]
    for name in ("joint1_deg", "joint2_deg"):
        cell = row.get(name)
        value = number_of(cell)
        if not is_gap(cell) and (value is None or abs(value) > 720.0):
            mistakes.append(
                Mistake(f"must be an angle in degrees, but is {str(cell)[:30]!r}", file, number, name)
            )
        yield None if value is None or abs(value) > 720.0 else value
