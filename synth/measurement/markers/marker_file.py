"""Markers from a file: a capture, CSV with a header, or JSON lines; checked as strictly as a task.

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
from synth.measurement.captures import FARTHEST, MISTAKES_AT_MOST, Capture, content_of, is_gap, number_of
from synth.measurement.markers.capture_markers import capture_readings
from synth.measurement.markers.marker_rows import UNITS, Row, csv_rows, json_rows
from synth.measurement.markers.markers import MARKER_NAMES, marker_named
from synth.measurement.markers.resting import RestingMarkers

if TYPE_CHECKING:
    import os
    from collections.abc import Iterator

    from synth.arrays import FloatArray
    from synth.measurement.markers.markers import Readings
    from synth.robot import Robot

STRAIGHT_ON = math.pi  # joint 2, where nothing is said of it
_ONE_PLACE = 5e-3  # m; what is seen nearer than this to another is the same marker again
_MOST_POINTS = 5_000  # of which places are made; of more, evenly along the list


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
    text = content_of(Path(path), file)
    if isinstance(text, Capture):
        return capture_readings(text, robot, (joint1, STRAIGHT_ON), file)
    is_json = text.lstrip()[:1] == "{"
    rows = json_rows(text, file) if is_json else csv_rows(text, file)
    return readings_of_rows(rows, robot, joint1, file)


def load_unnamed(path: str | os.PathLike[str]) -> FloatArray:
    """Read where something was seen while the arm was at rest, whatever the file calls it.

    Args:
        path: The file: a capture, or x_mm,y_mm,z_mm. What is seen at one place in many frames is one point.

    Returns:
        Positions in the frame of the file, shape (n, 3), m.

    Raises:
        InputError: The file cannot be read, is wrong, or holds no points.
    """
    file = str(path)
    content = content_of(Path(path), file)
    if not isinstance(content, Capture):
        return _places(load_points(path)[0])
    mistakes: list[Mistake] = []
    seen = [content.seen(track, file, mistakes) for track in content.tracks]
    if mistakes or not any(map(len, seen)):
        raise InputError(mistakes[:MISTAKES_AT_MOST] or [Mistake("holds no markers that were seen", file)])
    return _places(np.array([np.median(points, axis=0) for points in seen if len(points)]))


def _places(points: FloatArray) -> FloatArray:
    """Return the means of points that are one, seen again, shape (n, 3), m."""
    from scipy.cluster.hierarchy import fcluster, linkage  # type: ignore[import-untyped]  # noqa: PLC0415

    if len(points) < 2:
        return points
    if len(points) > _MOST_POINTS:
        points = points[:: -(-len(points) // _MOST_POINTS)]
    of = fcluster(linkage(points), _ONE_PLACE, "distance")
    return np.array([points[of == number].mean(axis=0) for number in range(1, of.max() + 1)])


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
    text = content_of(Path(path), file)
    if isinstance(text, Capture):
        what = "is a capture of markers: points of the end effector are read from x_mm,y_mm,z_mm only"
        raise InputError([Mistake(what, file)])
    is_json = text.lstrip()[:1] == "{"
    rows = (json_rows if is_json else csv_rows)(text, file, named=False)
    mistakes: list[Mistake] = []
    table = [list(_numbers(row, number, file, mistakes)) for number, row in rows]
    seen = [values for values in table if values[0] is not None]
    angled = [value is not None for values in seen for value in values[3:]]
    if any(angled) and not all(angled):
        mistakes.append(Mistake("must have both joint angles in every row, or none", file))
    if mistakes:
        raise InputError(mistakes[:MISTAKES_AT_MOST])
    if not seen:
        raise InputError([Mistake("holds no points", file)])
    array = np.array(seen, dtype=np.float64)
    return array[:, :3], np.radians(array[:, 3:]) if all(angled) else None


def readings_of_rows(rows: list[Row], robot: Robot, joint1: float, file: str) -> Readings:
    """Return the means of the frames; see `load_readings`."""
    mistakes: list[Mistake] = []
    resting, named = RestingMarkers(), set()
    for number, row in rows:
        marker = marker_named(str(row["marker"]), robot)
        if marker is None:
            name = repr(str(row["marker"])[:20])
            mistakes.append(Mistake(f"there is no marker {name}; {MARKER_NAMES}", file, number, "marker"))
            continue
        named.add(marker.name)
        values = [*_numbers(row, number, file, mistakes)]
        if values[0] is None:  # a gap
            continue
        first = joint1 if values[3] is None else math.radians(values[3])
        second = STRAIGHT_ON if values[4] is None else math.radians(values[4])
        resting.add(marker, [[float(v or 0.0) for v in values[:3]]], (first, second))
    if mistakes:
        more = [Mistake("has more such lines", file)] if len(mistakes) > MISTAKES_AT_MOST else []
        raise InputError([*mistakes[:MISTAKES_AT_MOST], *more])
    return resting.readings(named, file)


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
        if value is None or abs(value) / UNITS[unit] > FARTHEST:
            what = (
                "must be a number"
                if value is None
                else f"is farther than {FARTHEST:.0f} m: which unit is it in?"
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
