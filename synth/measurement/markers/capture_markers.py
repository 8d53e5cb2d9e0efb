"""Markers of this arm among those of a capture, in the posture in which the sheet holds it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from synth.errors import InputError, Mistake
from synth.measurement.captures import MISTAKES_AT_MOST, Capture, Track, shown
from synth.measurement.markers.frames import upright
from synth.measurement.markers.markers import MARKER_NAMES, marker_named
from synth.measurement.markers.resting import RestingMarkers

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from synth.measurement.markers.markers import Marker, Readings
    from synth.robot import Robot

_NAMES_AT_MOST = 4


def capture_readings(capture: Capture, robot: Robot, joints: Sequence[float], file: str) -> Readings:
    """Return the readings of the markers of an arm in a capture.

    A name may stand behind that of its set, as in "Arm:P3". Other markers are passed over. No axis of the
    file is believed to be up: where P1 and P2 show that y or x is, the frame is turned so that z is.

    Args:
        capture: What was recorded while the arm was at rest.
        robot: The hardware.
        joints: Where the joints stood, (joint 1, joint 2), rad.
        file: The file's name, for the mistakes.

    Raises:
        InputError: None of its markers is one of the arm, or cells are wrong.
    """
    known = arm_tracks(capture, robot)
    solved = [name for name in capture.solved if arm_marker(name, robot)]
    if not known:
        raise InputError([Mistake(_nothing_known(capture, solved), file)])
    mistakes = _ambiguous(known, file)
    resting = RestingMarkers()
    for track, marker in [] if mistakes else known:
        resting.add(marker, capture.seen(track, file, mistakes).tolist(), joints)
    if mistakes:
        more = [Mistake("has more such lines", file)] if len(mistakes) > MISTAKES_AT_MOST else []
        raise InputError([*mistakes[:MISTAKES_AT_MOST], *more])
    others = [track.name for track in capture.tracks if arm_marker(track.name, robot) is None]
    warnings = [f"passed over, being no markers of this arm: {_some(others)}"] if others else []
    if solved:
        warnings.append(f"passed over, being solved from a rigid body and not measured: {_some(solved)}")
    return upright(resting.readings({marker.name for _, marker in known}, file, warnings))


def arm_tracks(capture: Capture, robot: Robot) -> list[tuple[Track, Marker]]:
    """Return the columns of a capture that are markers of an arm."""
    return [(track, marker) for track in capture.tracks if (marker := arm_marker(track.name, robot))]


def streamed_markers(names: Iterable[str], robot: Robot) -> dict[str, Marker]:
    """Return which of the names in a stream are markers of an arm, as for a capture.

    Args:
        names: All that the stream has.
        robot: The hardware.

    Raises:
        InputError: None of them is one of the arm, or one is there twice.
    """
    capture = Capture(tuple(Track(name, 0) for name in names), (), 1.0)
    known = arm_tracks(capture, robot)
    mistakes = _ambiguous(known) if known else [Mistake(_nothing_known(capture, ()))]
    if mistakes:
        raise InputError(mistakes)
    return {track.name: marker for track, marker in known}


def arm_marker(name: str, robot: Robot) -> Marker | None:
    """Return the marker of a name with or without that of its set before it."""
    return marker_named(name, robot) or marker_named(name.partition(":")[2], robot)


def _nothing_known(capture: Capture, solved: Sequence[str]) -> str:
    if solved:
        return (
            f"has only solved positions of {_some(solved)} (Rigid Body Marker), where the rigid body says "
            "that they are: export the measured ones (Marker) too"
        )
    names = _some(track.name for track in capture.tracks)
    return f"has no marker of this arm, only {names}; {MARKER_NAMES}" if names else "has no markers"


def _ambiguous(known: Sequence[tuple[Track, Marker]], file: str | None = None) -> list[Mistake]:
    """Return the markers that two sets have."""
    names: dict[str, set[str]] = {}
    for track, marker in known:
        names.setdefault(marker.name, set()).add(track.name)
    return [
        Mistake(f"{name} is there as {' and as '.join(map(shown, sorted(tracks)))}: which is it?", file)
        for name, tracks in names.items()
        if len(tracks) > 1
    ]


def _some(names: Iterable[str]) -> str:
    """Return the first few of some names, and how many there are more."""
    distinct = list(dict.fromkeys(names))
    more = len(distinct) - _NAMES_AT_MOST
    return ", ".join(map(shown, distinct[:_NAMES_AT_MOST])) + (f" and {more} more" if more > 0 else "")
