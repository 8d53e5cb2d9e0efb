"""C3D files: read like the other captures if c3d is there; damaged ones are refused, and frames that lie."""

import random
import sys

import numpy as np
import pytest
from capture_files import c3d_bytes, recorded
from mutations import mutated
from planted import ROBOT
from standing import HOLD, SIGMA

from synth.errors import InputError
from synth.measurement import examine
from synth.measurement.markers.marker_file import load_readings

WANTED, TRUE, NAMES, POSITIONS = recorded()
MUTATIONS = 300


@pytest.fixture
def read(tmp_path):
    def read(content):
        path = tmp_path / "rest.c3d"
        path.write_bytes(content)
        return load_readings(path, ROBOT, HOLD)

    return read


@pytest.mark.parametrize("unit", [("mm", 1000.0), ("m", 1.0), ("cm", 100.0), ("meters", 1.0)])
def test_units(read, unit):
    readings = read(c3d_bytes(NAMES, POSITIONS, unit))
    assert readings.names == tuple(NAMES)
    assert readings.positions == pytest.approx(POSITIONS.mean(axis=0), abs=1e-6)
    assert examine(readings, WANTED, ROBOT, SIGMA, base_calibrated=False).refusal == ""


def test_a_point_with_a_negative_residual_is_a_gap(read):
    gaps = POSITIONS.copy()
    gaps[::3, 2] = np.nan
    gaps[:, -1] = np.nan
    readings = read(c3d_bytes(NAMES, gaps))
    assert readings.positions == pytest.approx(np.nanmean(gaps[:, :-1], axis=0), abs=1e-6)
    assert readings.warnings == ("A2:150 was never seen",)


def test_a_wrong_unit_is_refused(read):
    result = examine(
        read(c3d_bytes(NAMES, POSITIONS, ("mm", 1.0))), WANTED, ROBOT, SIGMA, base_calibrated=False
    )
    assert "1000 times too small" in result.refusal
    with pytest.raises(InputError, match="the unit of length is 'ft'"):
        read(c3d_bytes(NAMES, POSITIONS, ("ft", 1.0)))


def test_without_the_package_it_is_said_what_to_install(read, monkeypatch):
    monkeypatch.setitem(sys.modules, "c3d", None)
    with pytest.raises(InputError, match=r"pip install 'malleable-synth\[captures\]'"):
        read(b"\x02\x50" + bytes(510))


def test_mutated_files_are_read_or_refused(read):
    content = c3d_bytes(NAMES, POSITIONS[:3])
    chance = random.Random(0)  # noqa: S311
    read_at_all = 0
    for _ in range(MUTATIONS):
        try:
            readings = read(mutated(content, chance))
        except InputError:
            continue
        read_at_all += 1
        examine(readings, WANTED, ROBOT, SIGMA, base_calibrated=False)
    assert 0 < read_at_all < MUTATIONS
