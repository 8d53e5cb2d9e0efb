"""Captures of tracking systems: every layout says the same; a wrong unit or frame is never believed."""

import codecs

import numpy as np
import pytest
from capture_files import motive_frames_text, motive_text, qtm_text, recorded, trc_text
from planted import ROBOT
from standing import HOLD, SIGMA

from synth.errors import InputError
from synth.measurement import examine
from synth.measurement.markers.marker_file import load_points, load_readings

WANTED, TRUE, NAMES, POSITIONS = recorded()
MILLIMETRES, CENTIMETRES = ("Millimeters", 1000.0), ("Centimeters", 100.0)
Y_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])  # to a frame with y up
X_UP = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
GAPS = POSITIONS.copy()
GAPS[1::3, 2] = np.nan
GAPS[5:, -1] = np.nan
LOST = POSITIONS.copy()
LOST[:, -1] = np.nan


STILL = np.tile(POSITIONS.mean(axis=0), (len(POSITIONS), 1, 1))


def read(folder, text):
    path = folder / "capture.txt"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return load_readings(path, ROBOT, HOLD)


def refusal(folder, text):
    with pytest.raises(InputError) as caught:
        read(folder, text)
    return str(caught.value)


def examined(folder, text):
    return examine(read(folder, text), WANTED, ROBOT, SIGMA, base_calibrated=False)


LAYOUTS = {
    "motive 1.21, metres": motive_text(NAMES, POSITIONS, version="1.21"),
    "motive 1.23, millimetres": motive_text(NAMES, POSITIONS, MILLIMETRES),
    "motive 1.25, centimetres": motive_text(NAMES, POSITIONS, CENTIMETRES, version="1.25"),
    "motive, no set": motive_text(NAMES, POSITIONS, prefix=""),
    "motive, CR LF": motive_text(NAMES, POSITIONS).replace("\n", "\r\n"),
    "motive 1.1": motive_frames_text(NAMES, POSITIONS),
    "trc, mm": trc_text(NAMES, POSITIONS),
    "trc, m": trc_text(NAMES, POSITIONS, ("m", 1.0)),
    "trc, CR CR LF": trc_text(NAMES, POSITIONS, end="\r\r\n"),
    "trc, padded": trc_text(NAMES, POSITIONS, pad=30),
    "trc, names side by side": trc_text(NAMES, POSITIONS, aside=True),
    "trc, a count that lies": trc_text(NAMES, POSITIONS, frames=7),
    "trc, a count that lies more": trc_text(NAMES, POSITIONS, frames=100_000),
    "trc, leading blanks": "\r\n \t\r\n" + trc_text(NAMES, POSITIONS),
    "trc, axes one column beside": trc_text(NAMES, POSITIONS).replace("\t\tX1", "\t\t\tX1"),
    "trc, axes from the first column": trc_text(NAMES, POSITIONS, aside=True).replace("\t\tX1", "X1"),
    "trc, commas": trc_text(NAMES, POSITIONS).replace("\t", ","),
    "qtm": qtm_text(NAMES, POSITIONS),
    "qtm, coordinates only": qtm_text(NAMES, POSITIONS, columns=0, header=False),
    "qtm, no names of columns": qtm_text(NAMES, POSITIONS, header=False),
    "qtm, tabs at the ends": qtm_text(NAMES, POSITIONS, header=False, tab="\t"),
    "qtm, tabs at the ends, coordinates": qtm_text(NAMES, POSITIONS, columns=0, header=False, tab="\t"),
}


@pytest.mark.parametrize("text", LAYOUTS.values(), ids=LAYOUTS.keys())
def test_every_layout_says_the_same(tmp_path, text):
    readings = read(tmp_path, text)
    assert readings.names == tuple(NAMES)
    assert readings.positions == pytest.approx(POSITIONS.mean(axis=0), abs=1e-6)
    assert readings.warnings == ()
    result = examined(tmp_path, text)
    assert result.refusal == ""
    assert np.linalg.norm(result.fit.arm.end - TRUE.end) < 2e-3


@pytest.mark.parametrize("encode", [
    lambda text: codecs.BOM_UTF8 + text.encode(),
    lambda text: text.encode("utf-16"),
    lambda text: codecs.BOM_UTF16_BE + text.encode("utf-16-be"),
    lambda text: text.replace("at rest", "r\xe9p\xe9t\xe9").replace("rest.trc", "\xe9").encode("latin-1"),
], ids=["byte-order mark", "UTF-16", "UTF-16 BE", "Latin-1"])  # fmt: skip
@pytest.mark.parametrize("text", [motive_text(NAMES, POSITIONS), trc_text(NAMES, POSITIONS)])
def test_encodings(tmp_path, text, encode):
    assert read(tmp_path, encode(text)).positions == pytest.approx(POSITIONS.mean(axis=0), abs=1e-6)


@pytest.mark.parametrize("text", [
    motive_text(NAMES, GAPS), trc_text(NAMES, GAPS), qtm_text(NAMES, GAPS), qtm_text(NAMES, GAPS, lost=""),
    qtm_text(NAMES, GAPS, lost="NaN"), motive_frames_text(NAMES, GAPS, lost="nan"),
    motive_frames_text(NAMES, GAPS), motive_frames_text(NAMES, GAPS, lost="-1.#IND"),
    qtm_text(NAMES, GAPS, header=False), trc_text(NAMES, np.nan_to_num(GAPS)),
])  # fmt: skip
def test_gaps_are_no_positions(tmp_path, text):
    assert read(tmp_path, text).positions == pytest.approx(np.nanmean(GAPS, axis=0), abs=1e-6)


@pytest.mark.parametrize("text", [
    motive_text(NAMES, LOST), trc_text(NAMES, LOST), qtm_text(NAMES, LOST), qtm_text(NAMES, LOST, lost=""),
    qtm_text(NAMES, LOST, lost="", header=False), qtm_text(NAMES, LOST, lost="", header=False, columns=0),
])  # fmt: skip
def test_a_marker_that_was_never_seen_is_named(tmp_path, text):
    readings = read(tmp_path, text)
    assert readings.names == tuple(NAMES[:-1])
    assert readings.positions == pytest.approx(POSITIONS.mean(axis=0)[:-1], abs=1e-6)
    assert readings.warnings == ("A2:150 was never seen",)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (motive_text(NAMES, STILL, ("Millimeters", 1.0)), "1000 times too small"),
        (motive_text(NAMES, STILL, ("Centimeters", 1000.0)), "10 times too large"),
        (trc_text(NAMES, STILL, ("mm", 1.0)), "1000 times too small"),
        (trc_text(NAMES, STILL, ("m", 100.0)), "distances between the markers are 100 times"),
        (motive_frames_text(NAMES, STILL, unit=10.0), "10 times too large"),
        (qtm_text(NAMES, STILL, unit=1.0), "1000 times too small"),
    ],
)
def test_a_wrong_unit_is_refused_with_its_number(tmp_path, text, told):
    result = examined(tmp_path, text)
    assert result.fit is None
    assert told in result.refusal


def test_noise_that_a_wrong_unit_makes_large_is_asked_about(tmp_path):
    text = trc_text(NAMES, POSITIONS, ("m", 100.0))
    assert "P1 is left out: it moved by" in refusal(tmp_path, text)
    assert "was the arm at rest, and is the unit right?" in refusal(tmp_path, text)


@pytest.mark.parametrize("text", [
    motive_text(NAMES, POSITIONS, ("Meters", 1000.0)), trc_text(NAMES, POSITIONS, ("m", 1000.0)),
    motive_frames_text(NAMES, POSITIONS, unit=1000.0),
])  # fmt: skip
def test_metres_that_are_millimetres_are_too_far(tmp_path, text):
    assert "is farther than 100 m: which unit is it in?" in refusal(tmp_path, text)


@pytest.mark.parametrize(("turn", "axis"), [(Y_UP, "y"), (X_UP, "x")])
def test_up_is_found_from_p1_to_p2(tmp_path, turn, axis):
    text = motive_text(NAMES, POSITIONS @ turn.T)
    readings = read(tmp_path, text)
    assert readings.positions == pytest.approx(POSITIONS.mean(axis=0), abs=1e-6)
    assert readings.warnings == (
        f"P1 to P2 points along {axis} of the file: its frame was turned so that z is up",
    )
    assert examined(tmp_path, text).refusal == ""


@pytest.mark.parametrize(
    ("turn", "told"),
    [
        (np.diag([1.0, 1.0, -1.0]) @ Y_UP, "mirrored"),
        (np.diag([1.0, -1.0, 1.0]), "mirrored"),
        (np.diag([1.0, -1.0, -1.0]), "points along -z"),
        (np.diag([1.0, -1.0, -1.0]) @ Y_UP, "points along -y"),
    ],
)
def test_other_frames_are_refused(tmp_path, turn, told):
    assert told in examined(tmp_path, trc_text(NAMES, POSITIONS @ turn.T)).refusal


def test_markers_in_one_place_show_no_axis(tmp_path):
    told = examined(tmp_path, trc_text(NAMES, np.zeros_like(POSITIONS))).refusal
    assert "distances between the markers are 0 times what the hardware has" in told


def test_measured_positions_are_preferred_to_solved_ones(tmp_path):
    both = motive_text(NAMES * 2, np.concatenate([POSITIONS + 0.01, POSITIONS], axis=1))
    three = 3 * len(NAMES)
    both = both.replace(",Marker" * three, ",Rigid Body Marker" * three, 1)
    readings = read(tmp_path, both)
    assert readings.positions == pytest.approx(POSITIONS.mean(axis=0), abs=1e-6)
    assert readings.warnings == ()
    some = both.replace(",Marker" * 3, ",Rigid Body Marker" * 3, 1)
    assert read(tmp_path, some).warnings == (
        "passed over, being solved from a rigid body and not measured: 'Arm:P1'",
    )
    solved = motive_text(NAMES, POSITIONS, kind="Rigid Body Marker")
    assert "has only solved positions of 'Arm:P1', 'Arm:P2', 'Arm:A1:300', 'Arm:P3' and 4" in refusal(
        tmp_path, solved
    )


def test_other_markers_are_passed_over_and_named(tmp_path):
    readings = read(tmp_path, trc_text([*NAMES[:-1], "LHEE"], POSITIONS))
    assert readings.names == tuple(NAMES[:-1])
    assert readings.warnings == ("passed over, being no markers of this arm: 'LHEE'",)
    assert "has no marker of this arm, only 'LHEE'; there are P1 to P5" in refusal(
        tmp_path, trc_text(["LHEE"], POSITIONS[:, :1])
    )


def test_a_marker_lost_and_found_is_one_and_two_sets_are_two(tmp_path):
    halves = np.concatenate([POSITIONS, POSITIONS[:, -1:]], axis=1)
    halves[:9, -1] = halves[9:, -2] = np.nan
    for write in (motive_text, motive_frames_text):
        readings = read(tmp_path, write([*NAMES, NAMES[-1]], halves))
        assert readings.positions == pytest.approx(POSITIONS.mean(axis=0), abs=1e-6)
    text = motive_text(["Arm:P1", "Leg:P1"], POSITIONS[:, :2], prefix="")
    assert "P1 is there as 'Arm:P1' and as 'Leg:P1': which is it?" in refusal(tmp_path, text)


def test_points_of_the_end_effector_are_no_capture(tmp_path):
    path = tmp_path / "points.trc"
    path.write_text(trc_text(NAMES, POSITIONS))
    with pytest.raises(InputError, match="is a capture of markers"):
        load_points(path)


def test_a_column_without_a_name_is_no_marker(tmp_path):
    names = ["", *NAMES[1:]]
    readings = read(tmp_path, trc_text(names, POSITIONS))
    assert readings.names == tuple(NAMES[1:])
    assert readings.positions == pytest.approx(POSITIONS.mean(axis=0)[1:], abs=1e-6)
