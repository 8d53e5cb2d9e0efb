"""Markers that are wrong: refused with the reason, or left out; good ones are believed."""

import numpy as np
import pytest
from planted import ROBOT
from standing import BARS, HOLD, SIGMA, seen, standing

from synth.measurement import Readings, examine

FULL = "P1 P2 A1:300 P3 P4 P5 A2:-150 A2:150 E:-60"
BENT = np.tile([HOLD, 2.5], (9, 1))


def examined(readings, wanted, *, base_calibrated=False):
    return examine(readings, wanted, ROBOT, SIGMA, base_calibrated=base_calibrated)


def moved(readings, turn):
    return Readings(readings.markers, readings.positions @ np.asarray(turn).T, readings.joints)


@pytest.fixture(params=range(4))
def scene(request):
    wanted, true = standing(request.param)
    return wanted, true, np.random.default_rng(request.param)


@pytest.mark.parametrize("names", ["P1 P2 P3 P4", "P1 P2 P3 P4 P5", BARS])
def test_good_markers_are_believed(scene, names):
    wanted, true, rng = scene
    result = examined(seen(true, names, rng), wanted)
    assert result.refusal == ""
    assert result.rejected == ()
    assert np.linalg.norm(result.fit.arm.end - true.end) < 2e-3


@pytest.mark.parametrize(
    ("factor", "told"),
    [(10.0, "10 times too large"), (1e-3, "1000 times too small"), (1 / 25.4, "inches"), (2.0, "2 times")],
)
def test_wrong_units_are_refused(scene, factor, told):
    wanted, true, rng = scene
    readings = seen(true, BARS, rng)
    readings = Readings(readings.markers, factor * readings.positions, readings.joints)
    assert told in examined(readings, wanted).refusal


@pytest.mark.parametrize(
    ("turn", "told"),
    [
        (np.diag([1.0, -1.0, 1.0]), "mirrored"),
        (np.diag([-1.0, 1.0, 1.0]), "mirrored"),
        (np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]]), "P1 to P2 points along y"),
        (np.diag([1.0, -1.0, -1.0]), "P1 to P2 points along -z"),
    ],
)
def test_other_frames_are_refused(scene, turn, told):
    wanted, true, rng = scene
    assert told in examined(moved(seen(true, FULL, rng, BENT), turn), wanted).refusal


@pytest.mark.parametrize("turn", [np.diag([1.0, -1.0, 1.0]), np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])])
def test_other_frames_are_refused_without_markers_on_axis_1(scene, turn):
    wanted, true, rng = scene
    result = examined(moved(seen(true, "P3 P4 P5 A2:150", rng), turn), wanted, base_calibrated=True)
    assert "the frame is" in result.refusal


def test_an_origin_that_is_not_p1_is_refused(scene):
    wanted, true, rng = scene
    readings = seen(true, BARS, rng)
    readings = Readings(readings.markers, readings.positions + [0.3, 0.0, 0.0], readings.joints)
    assert "origin is P1" in examined(readings, wanted).refusal


@pytest.mark.parametrize("names", ["P1 P2 P3 P4", "P1 P2 P3 P4 P5", FULL])
def test_names_that_were_exchanged_are_refused(scene, names):
    wanted, true, rng = scene
    readings = seen(true, names, rng, BENT[: len(names.split())])
    swapped = [{"P3": "P4", "P4": "P3"}.get(name, name) for name in readings.names]
    named = dict(zip(readings.names, readings.markers, strict=True))
    result = examined(Readings(tuple(named[n] for n in swapped), readings.positions, readings.joints), wanted)
    assert "each other's names" in result.refusal


def test_one_bad_marker_among_many_is_left_out(scene):
    wanted, true, rng = scene
    readings = seen(true, FULL, rng, BENT)
    positions = np.array(readings.positions)
    positions[7] += [0.0, 0.02, 0.01]
    result = examined(Readings(readings.markers, positions, readings.joints), wanted)
    assert [name for name, _ in result.rejected] == ["A2:150"]
    assert "mm from where the other markers say" in result.rejected[0][1]
    assert np.linalg.norm(result.fit.arm.end - true.end) < 2e-3


def test_a_contradiction_that_names_no_marker_is_refused(scene):
    wanted, true, rng = scene
    readings = seen(true, "P1 P2 P3 P4", rng)
    positions = np.array(readings.positions)
    positions[3] += 0.012 * true.axis
    result = examined(Readings(readings.markers, positions, readings.joints), wanted)
    assert result.fit is None
    assert "contradict each other" in result.refusal


@pytest.mark.parametrize(
    ("names", "told"), [("P1 P2 P3 P5", "axis 2 is not shown"), ("P3 P4 P5", "axis 1 is not shown")]
)
def test_too_few_markers_are_refused(scene, names, told):
    wanted, true, rng = scene
    assert told in examined(seen(true, names, rng), wanted).refusal


def test_markers_on_the_link_are_not_counted(scene):
    wanted, true, rng = scene
    readings = seen(true, BARS, rng)
    from synth.measurement import marker_named  # noqa: PLC0415

    more = Readings(
        (*readings.markers, marker_named("L050", ROBOT)),
        np.vstack([readings.positions, [[0.0, 0.0, 0.1]]]),
        np.vstack([readings.joints, readings.joints[:1]]),
    )
    result = examined(more, wanted)
    assert result.refusal == ""
    assert "L050" not in result.used.names
