"""ROS 2 bags with motion-capture markers, by the package rosbags, which is imported on use.

Markers are messages of the type Markers of mocap4r2_msgs, or of mocap_msgs as it was called before: a list of
names or numbers with translations, in metres as everything in ROS (REP 103).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from synth.errors import InputError, Mistake
from synth.measurement.captures.capture import Capture, Track

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

_TYPES = ("mocap4r2_msgs/msg/Markers", "mocap_msgs/msg/Markers")
_METADATA = "metadata.yaml"
_BY_INDEX = 1  # id_type of a marker that has a number and no name
_MOST_FRAMES = 100_000
_MISSING = "is a ROS bag, which needs rosbags to be read: pip install 'malleable-synth[bags]'"


def is_bag(path: Path) -> bool:
    """Whether a path is a ROS 2 bag: a folder that describes itself."""
    return path.is_dir() and (path / _METADATA).is_file()


def bag_capture(path: Path, file: str) -> Capture:
    """Read a ROS 2 bag.

    Args:
        path: Its folder.
        file: Its name, for the mistakes.

    Raises:
        InputError: rosbags is not installed, or the bag is damaged, does not say what its messages hold, or
            holds no markers.
    """
    try:
        from rosbags.highlevel import AnyReader  # noqa: PLC0415 - not of everybody's installation
    except ImportError:
        raise InputError([Mistake(_MISSING, file)]) from None
    try:
        with AnyReader([path]) as reader:
            topics = [each for each in reader.connections if each.msgtype in _TYPES]
            others = sorted({each.msgtype for each in reader.connections})
            frames = list(_frames(reader, topics)) if topics else []
    except Exception as error:  # noqa: BLE001 - a damaged bag breaks rosbags in any way
        reason = f"is a ROS bag that cannot be read: {' '.join(str(error).split()) or type(error).__name__}"
        raise InputError([Mistake(reason[:300], file)]) from None
    if not topics:
        holds = ", ".join(others) or "no messages"
        raise InputError([Mistake(f"is a ROS bag without {_TYPES[0]}: it holds {holds}", file)])
    names = list(dict.fromkeys(name for frame in frames for name in frame))
    unseen = (math.nan, math.nan, math.nan)
    rows = tuple(
        (number, [value for name in names for value in frame.get(name, unseen)])
        for number, frame in enumerate(frames, 1)
    )
    return Capture(tuple(Track(name, 3 * k) for k, name in enumerate(names)), rows, 1.0)


def _frames(reader: Any, topics: list[Any]) -> Iterator[dict[str, tuple[float, float, float]]]:
    """Yield where each marker was seen in each message, by its name or number, m."""
    for count, (connection, _, data) in enumerate(reader.messages(connections=topics)):
        if count == _MOST_FRAMES:
            return
        markers = reader.deserialize(data, connection.msgtype).markers
        yield {_name(each): (each.translation.x, each.translation.y, each.translation.z) for each in markers}


def _name(marker: Any) -> str:
    if marker.id_type == _BY_INDEX or not marker.marker_name:
        return str(marker.marker_index)
    return str(marker.marker_name)
