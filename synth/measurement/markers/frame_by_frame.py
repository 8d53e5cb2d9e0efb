"""Markers frame by frame, as they come or as they were recorded; each frame is readings of its own."""

from __future__ import annotations

import math
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from synth.errors import InputError, Mistake
from synth.measurement.captures import FARTHEST, Capture, content_of
from synth.measurement.markers.capture_markers import arm_tracks
from synth.measurement.markers.frames import turn_upright
from synth.measurement.markers.marker_file import STRAIGHT_ON, readings_of_rows
from synth.measurement.markers.marker_rows import csv_rows, json_rows
from synth.measurement.markers.markers import Marker, Readings
from synth.measurement.markers.resting import RestingMarkers

if TYPE_CHECKING:
    import os
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from synth.robot import Robot


def readings_of_lines(text: str, robot: Robot, joint1: float, source: str) -> Readings:
    """Return what some lines say, one JSON object each, as in a file of markers.

    Args:
        text: The lines, of one frame or of a few.
        robot: The hardware, which says where P2 and P4 are on their axes.
        joint1: The angle of joint 1 where a line does not say it, rad. Joint 2 is at 180 deg then.
        source: What they come from, for the mistakes.

    Raises:
        InputError: They are no such lines, or show no marker.
    """
    return readings_of_rows(json_rows(text, source), robot, joint1, source)


def readings_of_points(
    points: Mapping[str, Sequence[float]], markers: Mapping[str, Marker], joint1: float
) -> Readings | None:
    """Return what a frame of a stream shows of an arm; None if it shows none of its markers.

    Args:
        points: Where each name was seen, m; not a number where it was not.
        markers: Which of the names are markers of the arm.
        joint1: The angle of joint 1, rad. Joint 2 is at 180 deg.

    Raises:
        InputError: A marker is too far away to be measured in metres.
    """
    seen = {
        marker: points[name]
        for name, marker in markers.items()
        if name in points and all(map(math.isfinite, points[name]))
    }
    far = [marker.name for marker, point in seen.items() if max(map(abs, point)) > FARTHEST]
    if far:
        raise InputError([Mistake(f"is farther than {FARTHEST:.0f} m: which unit is it in?", key=far[0])])
    return _frame(seen, 1.0, joint1) if seen else None


def recorded_frames(path: str | os.PathLike[str], robot: Robot, joint1: float) -> list[Readings]:
    """Read a file of markers frame by frame: any that `load_readings` reads.

    Args:
        path: The file.
        robot: The hardware.
        joint1: As for `readings_of_lines`.

    Returns:
        The frames that show a marker, in the base frame. Where P1 and P2 show in the first frame with both
        that x or y of a capture is up, all are turned.

    Raises:
        InputError: The file cannot be read or is wrong, or shows no marker of this arm.
    """
    file = str(path)
    content = content_of(Path(path), file)
    if isinstance(content, Capture):
        frames = list(_captured(content, robot, joint1))
        turn = next((turn for frame in frames for up, turn in [turn_upright(frame)] if up), np.eye(3))
        frames = [Readings(each.markers, each.positions @ turn.T, each.joints) for each in frames]
    else:
        rows = (json_rows if content.lstrip()[:1] == "{" else csv_rows)(content, file)
        groups = groupby(rows, key=lambda row: row[1].get("frame"))
        frames = [readings_of_rows(list(group), robot, joint1, file) for _, group in groups]
    if not frames:
        raise InputError([Mistake("has no frame that shows a marker of this arm", file)])
    return frames


def _captured(capture: Capture, robot: Robot, joint1: float) -> Iterator[Readings]:
    """Yield the frames of a capture that show a marker; a cell that is no number is a gap."""
    tracks, farthest = arm_tracks(capture, robot), FARTHEST * capture.metre
    for _, cells in capture.rows:
        seen: dict[Marker, tuple[float, ...]] = {}
        for track, marker in tracks:
            try:
                point = tuple(map(float, cells[track.column : track.column + 3]))
            except ValueError:
                continue
            lost = not any(point) and capture.zeros_are_gaps
            if len(point) == 3 and all(abs(value) <= farthest for value in point) and not lost:
                seen[marker] = point
        if seen:
            yield _frame(seen, capture.metre, joint1)


def _frame(seen: Mapping[Marker, Sequence[float]], metre: float, joint1: float) -> Readings:
    """Return what was seen at one time as readings."""
    joints = np.tile([joint1, STRAIGHT_ON], (len(seen), 1))
    return Readings(tuple(seen), np.array(list(seen.values()), dtype=np.float64) / metre, joints)


def at_rest(frames: Iterable[Readings], source: str) -> Readings:
    """Return the means of markers over frames; what moved meanwhile is left out, and said.

    Args:
        frames: What was seen, frame by frame.
        source: What it comes from, for the mistakes.

    Raises:
        InputError: Nothing was at rest.
    """
    resting, named = RestingMarkers(), set()
    for frame in frames:
        for marker, position, joints in zip(
            frame.markers, frame.positions.tolist(), frame.joints.tolist(), strict=True
        ):
            named.add(marker.name)
            resting.add(marker, [position], joints)
    return resting.readings(named, source)
