"""Markers from files: read, or refused with the reason and its place; never a wrong unit."""

import json

import numpy as np
import pytest
from planted import ROBOT

from synth.errors import InputError
from synth.measurement import Place, marker_named
from synth.measurement.markers.marker_file import load_points, load_readings

GOOD = """marker,x_mm,y_mm,z_mm,joint1_deg,joint2_deg,frame
P1,0.1,0.2,0.0,180,170,1
P3,-300,20,310,180,170,1
P3,-302,20,312,180,170,2
A2:-50.5,-250,20,310,180,170,1
L050,0,0,108,180,170,1
P5,,,,180,170,1
"""


def read(tmp_path, text, name="markers.csv"):
    path = tmp_path / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return load_readings(path, ROBOT, 3.0)


def mistakes(tmp_path, text):
    with pytest.raises(InputError) as caught:
        read(tmp_path, text)
    return str(caught.value)


@pytest.mark.parametrize(
    ("name", "place", "offset"),
    [
        ("P1", Place.AXIS_1, 0.0),
        ("P2", Place.AXIS_1, 0.058),
        (" p3 ", Place.AXIS_2, 0.0),
        ("P4", Place.AXIS_2, 0.049),
        ("P5", Place.END_EFFECTOR, 0.0),
        ("A1:150", Place.AXIS_1, 0.15),
        ("A2:-50.5", Place.AXIS_2, -0.0505),
        ("E:-60", Place.LINK_END, -0.06),
        ("L050", Place.LINK, 0.05),
    ],
)
def test_names(name, place, offset):
    marker = marker_named(name, ROBOT)
    assert marker.place is place
    assert marker.offset == pytest.approx(offset)


@pytest.mark.parametrize("name", ["", "P6", "A3:1", "A2:", "A2:1e3", "E", "L", "P1 P2"])
def test_names_that_are_none(name):
    assert marker_named(name, ROBOT) is None


def test_frames_are_averaged_and_gaps_are_told(tmp_path):
    readings = read(tmp_path, GOOD)
    assert readings.names == ("P1", "P3", "A2:-50.5", "L050")
    assert readings.positions[1] == pytest.approx([-0.301, 0.02, 0.311])
    assert np.allclose(readings.joints, np.radians([180, 170]))
    assert readings.warnings == ("P5 was never seen",)


def test_json_lines_and_metres_say_the_same(tmp_path):
    rows = [line.split(",") for line in GOOD.splitlines()[1:]]
    lines = [
        json.dumps(
            {"marker": r[0], "x_m": float(r[1] or "nan") / 1e3, "y_m": float(r[2] or "nan") / 1e3,
             "z_m": float(r[3] or "nan") / 1e3, "joint1_deg": 180, "joint2_deg": 170, "frame": r[6]}
        )
        for r in rows
    ]  # fmt: skip
    one, other = read(tmp_path, GOOD), read(tmp_path, "\n".join(lines), "markers.jsonl")
    assert one.names == other.names
    assert np.allclose(one.positions, other.positions)


def test_without_angles_joint_1_is_held_and_joint_2_is_straight(tmp_path):
    readings = read(tmp_path, "marker,x_mm,y_mm,z_mm\nP3,1,2,3\n")
    assert readings.joints == pytest.approx(np.array([[3.0, np.pi]]))


def test_line_ends_marks_and_case_do_not_matter(tmp_path):
    text = b"\xef\xbb\xbf" + GOOD.replace("\n", "\r\n").replace("marker,x_mm", " Marker , X_mm").encode()
    assert np.allclose(read(tmp_path, text).positions, read(tmp_path, GOOD).positions)


def test_another_posture_is_another_reading(tmp_path):
    readings = read(tmp_path, "marker,x_mm,y_mm,z_mm,joint1_deg\nP3,1,2,3,100\nP3,1,2,4,200\n")
    assert readings.names == ("P3", "P3")
    assert np.allclose(readings.joints[:, 0], np.radians([100, 200]))


def test_a_marker_that_moved_is_left_out(tmp_path):
    readings = read(tmp_path, "marker,x_mm,y_mm,z_mm\nP3,1,2,3\nP3,1,2,30\nP4,1,2,3\n")
    assert readings.names == ("P4",)
    assert "P3 is left out: it moved by 13.5 mm" in readings.warnings[0]


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "holds no markers"),
        ("P1,0,0,0\n", "in which unit"),
        ("marker,x,y,z\nP1,0,0,0\n", "did you mean x_m"),
        ("marker,x_mm,y_mm,z_m\nP1,0,0,0\n", "in one unit"),
        ("marker,x_mm,y_mm\nP1,0,0\n", "must have all of"),
        ("x_mm,y_mm,z_mm\n0,0,0\n", "must name the marker"),
        ("marker,x_mm,x_mm,y_mm,z_mm\nP1,0,0,0,0\n", "is there twice"),
        ("marker,x_mm,y_mm,z_mm\nP1,0,0\n", "2: has 3 cells, and the header 4"),
        ("marker,x_mm,y_mm,z_mm\nP9,0,0,0\n", "2: marker: there is no marker 'P9'"),
        ("marker,x_mm,y_mm,z_mm\nP1,zero,0,0\n", "2: x_mm: must be a number, but is 'zero'"),
        ("marker,x_m,y_m,z_m\nP1,512,0,0\n", "2: x_m: is farther than 100 m: which unit is it in?"),
        ("marker,x_mm,y_mm,z_mm,joint1_deg\nP1,1,0,0,much\n", "must be an angle in degrees"),
        ("marker,x_mm,y_mm,z_mm\nP1,,,\n", "no marker that was seen"),
        ('{"marker": "P1", "x_mm": 1}', "must have all of"),
        ('{"marker": "P1"', "is no JSON object"),
        ("{}\n[1]\n", "1"),
        (b"marker\0", "NUL"),
        (b"\xff\xfe\xfa", "UTF-8"),
    ],
)
def test_what_is_refused(tmp_path, text, told):
    assert told in mistakes(tmp_path, text)


def test_no_file(tmp_path):
    with pytest.raises(InputError, match="no such file"):
        load_readings(tmp_path / "none.csv", ROBOT, 0.0)


def test_mutated_files_are_read_or_refused(tmp_path):
    rng = np.random.default_rng(0)
    refused = 0
    for _ in range(1500):
        content = bytearray(GOOD.encode())
        for _ in range(rng.integers(1, 6)):
            at = int(rng.integers(len(content)))
            kind = rng.integers(3)
            if kind == 0:
                content[at] = int(rng.integers(256))
            elif kind == 1:
                del content[at : at + int(rng.integers(1, 9))]
            else:
                content[at:at] = bytes(rng.integers(32, 127, 3).tolist())
        try:
            readings = read(tmp_path, bytes(content))
        except InputError:
            refused += 1
            continue
        assert np.isfinite(readings.positions).all()
        assert np.abs(readings.positions).max() <= 100.0
    assert refused > 300


def test_points(tmp_path):
    path = tmp_path / "points.csv"
    path.write_text("x_mm,y_mm,z_mm,joint1_deg,joint2_deg\n1,2,3,90,180\n,,,90,180\n4,5,6,90,180\n")
    points, joints = load_points(path)
    assert np.allclose(points, [[1e-3, 2e-3, 3e-3], [4e-3, 5e-3, 6e-3]])
    assert np.allclose(joints, np.radians([[90, 180], [90, 180]]))
    path.write_text("x_mm,y_mm,z_mm\n1,2,3\n")
    assert load_points(path)[1] is None
    path.write_text("x_mm,y_mm,z_mm,joint1_deg\n1,2,3,4\n")
    with pytest.raises(InputError, match="both joint angles"):
        load_points(path)
