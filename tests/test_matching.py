"""Points without names: told by where the markers of an arm must be, or refused."""

import numpy as np
import pytest
from planted import ROBOT
from standing import BARS, SIGMA, seen, standing

from synth.measurement import marker_named, matched


def match(points, names, wanted):
    markers = tuple(marker_named(name, ROBOT) for name in names.split())
    return matched(points, markers, wanted, ROBOT.tip_offset, SIGMA, base_calibrated=True)


@pytest.mark.parametrize("names", [BARS, "P1 P2 P3 P4 P5", "P1 P2 A2:-150 A2:150"])
@pytest.mark.parametrize("seed", range(4))
def test_names_are_those_of_the_arm_whatever_else_is_seen(seed, names):
    wanted, true = standing(seed)
    rng = np.random.default_rng([seed, 1])
    readings = seen(true, names, rng)
    points = np.vstack([readings.positions, rng.uniform(-0.8, 0.8, (3, 3))])
    found = match(points[rng.permutation(len(points))], names, wanted)
    assert not found.refusal
    assert sorted(found.readings.names) == sorted(readings.names)
    where = dict(zip(readings.names, readings.positions, strict=True))
    for name, position in zip(found.readings.names, found.readings.positions, strict=True):
        np.testing.assert_array_equal(position, where[name])


def test_a_frame_with_y_up_is_turned_and_a_marker_unseen_is_named():
    wanted, true = standing(0)
    readings = seen(true, BARS, np.random.default_rng(0)).without("P4")
    y_up = readings.positions @ np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
    found = match(y_up, BARS, wanted)
    np.testing.assert_allclose(found.readings.positions, readings.positions, atol=1e-12)
    assert any("y is up" in said for said in found.readings.warnings)
    assert "P4 was not seen" in found.readings.warnings


def test_points_of_another_arm_are_refused():
    wanted, _ = standing(0)
    points = np.random.default_rng(0).uniform(-0.8, 0.8, (12, 3))
    assert "fit no arm" in match(points, BARS, wanted).refusal


def test_points_that_can_be_named_in_two_ways_are_refused():
    wanted, true = standing(0)
    readings = seen(true, "P1 P2 A2:-150 A2:150")
    # The same bar once more, 30 mm beside it: which of the two is on axis 2 nobody knows.
    beside = readings.positions[2:] + 0.03 * true.frame[:, 2]
    assert (
        "cannot be told"
        in match(np.vstack([readings.positions, beside]), "P1 P2 A2:-150 A2:150", wanted).refusal
    )
