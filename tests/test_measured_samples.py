"""What the bounds of a measurement leave open: sampled shapes, and links that take their pose."""

from dataclasses import replace

import numpy as np
import pytest
from planted import ROBOT
from planted_distances import MILLIMETRE, as_measured, named, planted_points, rounded

from synth.export.inspection.text import inspection_text
from synth.geometry import Invariants, SweptCircle
from synth.measurement import fit_link, inspect, sample_shapes
from synth.measurement.distances.measured import Measurement, Precision


def measurement_of(points, precision=MILLIMETRE, markers=None):
    robot = replace(ROBOT)
    return Measurement("planted", robot, precision, as_measured(rounded(named(points)), precision), markers)


def test_samples_keep_the_bounds_and_their_numbers_are_those_of_the_geometry():
    points = planted_points(2)
    measurement = measurement_of(points)
    samples = sample_shapes(measurement, 50, np.random.default_rng(0))
    spreads = samples.spreads()
    angles, misfits = [], samples.misfits()
    for k in range(len(samples)):
        shape = np.vstack([np.zeros(3), [0, 0, samples.d12[k]], samples.p3[k], samples.p4[k]])
        d = named(shape)
        for name, lower, upper in zip(
            measurement.distances.names, measurement.distances.lower, measurement.distances.upper, strict=True
        ):
            assert name not in d or lower - 1e-9 <= d[name] <= upper + 1e-9
        centre = samples.p3[k] + samples.centre_offset[k] * samples.axis[k]
        circle = SweptCircle(centre, samples.axis[k], float(samples.radius[k]))
        angles.append(Invariants.from_circle(circle).alpha)
        rho, z = samples.pose[k]
        assert float(circle.distance([rho, 0.0, z])) == pytest.approx(misfits[k], abs=5e-5)
    assert spreads["alpha"].least == pytest.approx(min(angles))
    assert spreads["alpha"].most == pytest.approx(max(angles))
    assert spreads["alpha"].low <= spreads["alpha"].median <= spreads["alpha"].high


def test_samples_surround_the_truth_and_shrink_with_the_rounding():
    points = planted_points(3)
    truth = Invariants.from_circle(SweptCircle.from_points(points)).alpha
    widths = []
    for step in (1e-3, 1e-4):
        measurement = measurement_of(points, Precision.from_rounding(step))
        measurement = replace(measurement, distances=as_measured(named(points), measurement.precision))
        spread = sample_shapes(measurement, 2000, np.random.default_rng(0)).spreads()["alpha"]
        assert spread.least <= truth <= spread.most
        widths.append(spread.high - spread.low)
    assert 4.0 < widths[0] / widths[1] < 25.0


def test_markers_are_sampled_as_points():
    points = planted_points(4)
    precision = Precision.from_sigma(1e-4)
    samples = sample_shapes(measurement_of(points, precision, points), 1000, np.random.default_rng(0))
    assert samples.drawn == 4000
    assert np.median(samples.misfits()) < 0.02


def test_the_link_of_a_planted_shape_is_found():
    for seed in range(6):
        points = planted_points(seed)
        distances = as_measured(rounded(named(points[:4])))
        fit = fit_link(ROBOT, distances, np.random.default_rng(seed))
        assert not fit.obstacle
        assert fit.found
        d = named(fit.arm.axis_points)
        for name, lower, upper in zip(distances.names, distances.lower, distances.upper, strict=True):
            assert lower - 1e-7 <= d[name] <= upper + 1e-7


def test_a_pose_beyond_the_link_is_proven_impossible_and_one_too_near_is_not_found():
    far = as_measured({"d12": 0.058, "d34": 0.049, "d13": 0.9, "d14": 0.91, "d23": 0.85, "d24": 0.86})
    fit = fit_link(ROBOT, far, np.random.default_rng(0))
    assert not fit.found
    assert "at most 700.0 mm" in fit.obstacle
    near = as_measured({"d12": 0.058, "d34": 0.049, "d13": 0.0, "d14": 0.049, "d23": 0.058, "d24": 0.076})
    fit = fit_link(ROBOT, near, np.random.default_rng(0))
    assert not fit.found
    assert not fit.obstacle
    assert fit.beyond > 1e-3


def test_numbers_that_make_no_sense_at_all_are_still_answered():
    distances = {"d13": 0.7, "d14": 0.01, "d23": 0.35, "d24": 1.86, "d15": 0.003, "d25": 0.05}
    hardware = {"d12": 0.058, "d34": 0.049, "d35": 0.455, "d45": 0.460}
    inspection = inspect(Measurement("nonsense", ROBOT, MILLIMETRE, as_measured({**distances, **hardware})))
    assert not inspection.is_realisable
    assert inspection.samples is None
    assert inspection.spreads == {}
    assert inspection_text(inspection)
