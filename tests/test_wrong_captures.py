"""Captures that cannot be read: refused with what is wrong; mutated ones never break the reader."""

import random

import pytest
from capture_files import motive_frames_text, motive_text, qtm_text, recorded, trc_text
from mutations import mutated
from planted import ROBOT
from standing import HOLD, SIGMA

from synth.errors import InputError
from synth.measurement import examine
from synth.measurement.markers.marker_file import load_readings

WANTED, _, NAMES, POSITIONS = recorded()
SHORT = POSITIONS[:3]
MOTIVE, TRC, QTM = motive_text(NAMES, SHORT), trc_text(NAMES, SHORT), qtm_text(NAMES, SHORT)
FRAMES = motive_frames_text(NAMES, SHORT)
MUTATIONS = 300


def read(folder, content):
    path = folder / "capture.txt"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return load_readings(path, ROBOT, HOLD)


def without(text, *beginnings):
    """Return a text without its lines that begin so."""
    return "\n".join(line for line in text.splitlines() if not line.startswith(beginnings))


WRONG = {
    "no header line": (without(MOTIVE, "Format"), "does not say Length Units: in which unit are these"),
    "no unit": (motive_text(NAMES, SHORT, ("", 1.0)), "does not say Length Units"),
    "an unknown unit": (motive_text(NAMES, SHORT, ("Feet", 1.0)), "the unit of length is 'Feet': in which"),
    "two units": (MOTIVE.replace("at rest", "Length Units,Inches"), "says 'Inches' and 'Meters' for a unit"),
    "no types": (
        without(MOTIVE, ",Type"),
        "without the rows Type, Name and Frame,Time: which marker is which",
    ),
    "only axes": (without(MOTIVE, ",", "Format"), "without the rows Type, Name and Frame,Time"),
    "only numbers": ("\n".join(MOTIVE.splitlines()[7:]), "in which unit are these numbers?"),
    "only a rigid body": (
        motive_text([], SHORT[:, :0]),
        "has no positions of markers, only rigid body: export the markers too",
    ),
    "1.1, left-handed": (
        FRAMES.replace("righthanded", "lefthanded"),
        "is left-handed, so all in it is mirrored",
    ),
    "1.1 with a marker less": (FRAMES.replace(",8,", ",7,"), "has 56 cells where 51 are said"),
    "1.1 with a marker more": (FRAMES.replace(",8,", ",9,"), "has 56 cells where 61 are said"),
    "1.1 without counts": (FRAMES.replace(",8,", ",,"), "does not say how many rigid bodies and markers"),
    "TRC without a unit": (trc_text(NAMES, SHORT, ("", 1.0)), "the unit of length is '100.00'"),
    "TRC with another": (trc_text(NAMES, SHORT, ("in", 1.0)), "the unit of length is 'in'"),
    "TRC without settings": (without(TRC, "DataRate"), "the unit of length is not said"),
    "TRC without names": (without(TRC, "Frame#"), "has no rows Frame# and X1 Y1 Z1"),
    "TRC without axes": (without(TRC, "\t\tX1"), "must have the row X1 Y1 Z1"),
    "TRC with a column more": (
        TRC.replace("0.000000\t", "0.000000\t1\t"),
        "has 27 columns, and X Y Z are said of 26",
    ),
    "TRC with a name more": (TRC.replace("\tP2\t", "\tP2\tP9"), "has 9 names for 8 times X Y Z"),
    "TRC with a word": (
        TRC.replace("0.008333\t", "0.008333\tabc"),
        "x of 'P1': must be a number, but is 'abc",
    ),
    "TRC with a comma": (TRC.replace("0.000000\t", "0.000000\t0,"), "must be a number"),
    "QTM without names": (without(QTM, "MARKER_NAMES"), "has no row MARKER_NAMES"),
    "QTM with a name more": (QTM.replace("\tP2\t", "\tP2\tP9\t", 1), "names 9 markers, and has 26 columns"),
    "QTM in 6D": (QTM.replace("\t3D", "\t6D"), "holds '6D' and not 3D: export the 3D data"),
    "QTM without frames": (without(QTM, "1\t", "2\t", "3\t"), "holds no marker that was seen"),
}


@pytest.mark.parametrize(("text", "told"), WRONG.values(), ids=WRONG.keys())
def test_what_cannot_be_read_is_told(tmp_path, text, told):
    with pytest.raises(InputError) as caught:
        read(tmp_path, text)
    assert told in str(caught.value)


def test_ten_mistakes_of_many_are_told(tmp_path):
    text = trc_text(NAMES, POSITIONS).replace(".", "x").replace("restxtrc", "rest.trc")
    with pytest.raises(InputError) as caught:
        read(tmp_path, text)
    assert len(caught.value.mistakes) == 11
    assert str(caught.value.mistakes[-1]).endswith("has more such lines")


@pytest.mark.parametrize("text", [MOTIVE, FRAMES, TRC, QTM], ids=["motive", "1.1", "trc", "qtm"])
def test_mutated_files_are_read_or_refused(tmp_path, text):
    chance = random.Random(0)  # noqa: S311
    read_at_all = 0
    for _ in range(MUTATIONS):
        try:
            readings = read(tmp_path, mutated(text.encode(), chance))
        except InputError:
            continue
        read_at_all += 1
        examine(readings, WANTED, ROBOT, SIGMA, base_calibrated=False)
    assert 0 < read_at_all < MUTATIONS
