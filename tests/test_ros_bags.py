"""ROS 2 bags of markers: read by name, and refused with the reason."""

import numpy as np
import pytest
from planted import ROBOT
from standing import BARS, HOLD, seen, standing

from synth.errors import InputError
from synth.measurement import load_readings

rosbags = pytest.importorskip("rosbags")

from rosbags.rosbag2 import Writer  # noqa: E402 - as above
from rosbags.typesys import Stores, get_types_from_msg, get_typestore  # noqa: E402 - as above

MARKER = "int8 id_type\nint32 marker_index\nstring marker_name\ngeometry_msgs/Point translation\n"
MARKERS = "std_msgs/Header header\nuint32 frame_number\nmocap4r2_msgs/Marker[] markers\n"


def written(folder, frames, topic="/markers"):
    """Write a bag of frames, each a mapping of names to positions in metres."""
    types = get_typestore(Stores.ROS2_HUMBLE)
    types.register(
        get_types_from_msg(MARKER, "mocap4r2_msgs/msg/Marker")
        | get_types_from_msg(MARKERS, "mocap4r2_msgs/msg/Markers")
    )
    kinds = types.types
    time = kinds["builtin_interfaces/msg/Time"](sec=0, nanosec=0)
    header = kinds["std_msgs/msg/Header"](stamp=time, frame_id="base")
    with Writer(folder, version=9) as bag:
        connection = bag.add_connection(topic, "mocap4r2_msgs/msg/Markers", typestore=types)
        for number, frame in enumerate(frames):
            markers = [
                kinds["mocap4r2_msgs/msg/Marker"](
                    id_type=0 if isinstance(name, str) else 1,
                    marker_index=-1 if isinstance(name, str) else name,
                    marker_name=name if isinstance(name, str) else "",
                    translation=kinds["geometry_msgs/msg/Point"](*map(float, position)),
                )
                for name, position in frame.items()
            ]
            message = kinds["mocap4r2_msgs/msg/Markers"](header=header, frame_number=number, markers=markers)
            data = types.serialize_cdr(message, "mocap4r2_msgs/msg/Markers")
            bag.write(connection, number * 10_000_000, data)
    return folder


def test_markers_are_read_by_name_and_their_frames_are_averaged(tmp_path):
    _, true = standing(0)
    exact = seen(true, BARS)
    where = dict(zip(exact.names, exact.positions, strict=True))
    shaken = [{name: place + off for name, place in where.items()} for off in (-1e-4, 1e-4)]
    shaken[0].pop("P5")  # was not seen in one frame
    bag = written(tmp_path / "bag", [{**frame, 7: (0.1, 0.2, 0.3)} for frame in shaken])
    readings = load_readings(bag, ROBOT, HOLD)
    assert sorted(readings.names) == sorted(exact.names)
    for name, place in zip(readings.names, readings.positions, strict=True):
        np.testing.assert_allclose(place, where[name] + (1e-4 if name == "P5" else 0.0), atol=1e-12)
    assert any("'7'" in said for said in readings.warnings)


def test_a_bag_that_is_damaged_is_refused(tmp_path):
    bag = written(tmp_path / "bag", [{"P1": (0.0, 0.0, 0.0)}])
    (data,) = bag.glob("*.db3")
    data.write_bytes(data.read_bytes()[:5000])
    with pytest.raises(InputError, match="ROS bag that cannot be read"):
        load_readings(bag, ROBOT, HOLD)
    (bag / "metadata.yaml").write_text("rosbag2_bagfile_information: [")
    with pytest.raises(InputError, match="ROS bag that cannot be read"):
        load_readings(bag, ROBOT, HOLD)
