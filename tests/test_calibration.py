"""The arm from a sweep of its end effector: as sure as it says, and refused where the sweep is too small."""

import numpy as np
import pytest
from planted import ROBOT, planted_arm
from standing import SIGMA, standing

from synth.geometry import SweptCircle
from synth.measurement import StandingArm
from synth.measurement.calibration import calibrate

LIMITS = ROBOT.joint_limits


def sweep(rng, count, share=1.0):
    width = LIMITS.second.upper - LIMITS.second.lower
    lower = rng.uniform(LIMITS.second.lower, LIMITS.second.upper - share * width)
    first = rng.uniform(
        LIMITS.base.lower, LIMITS.base.lower + share * (LIMITS.base.upper - LIMITS.base.lower), count
    )
    return np.column_stack([first, rng.uniform(lower, lower + share * width, count)])


def surface_off(found, true):
    """Return the distance of the true surface from the one found, root mean square by area, m."""
    second = np.linspace(LIMITS.second.lower, LIMITS.second.upper, 181)
    points = true.forward(np.column_stack([np.full(181, np.pi), second]))
    circle = SweptCircle(found.centre, found.axis, float(found.radius))
    weights = np.hypot(points[:, 0], points[:, 1])
    return np.sqrt(np.sum(weights * circle.distance(points) ** 2) / weights.sum())


def swept(seed, known, *, count=200, share=1.0, noise=SIGMA):
    rng = np.random.default_rng([seed, 7])
    wanted, true = standing(seed)
    joints = sweep(rng, count, share)
    points = true.forward(joints) + noise * rng.normal(size=(count, 3))
    return calibrate(points, joints if known else None, wanted, SIGMA), true


@pytest.mark.parametrize("known", [True, False])
def test_exact_points_give_the_exact_surface(known):
    found, true = swept(1, known, count=60, noise=0.0)
    assert surface_off(found.arm, true) < 1e-7
    assert found.refusal == ""


@pytest.mark.parametrize(("known", "most"), [(True, 0.05e-3), (False, 0.1e-3)])
def test_two_hundred_points_give_the_surface_as_well_as_promised(known, most):
    off, told = [], []
    for seed in range(12 if known else 6):
        found, true = swept(seed, known)
        assert found.refusal == ""
        off.append(surface_off(found.arm, true))
        told.append(found.surface_rms)
    assert max(off) < most
    assert 0.6 < np.sqrt(np.mean(np.square(off)) / np.mean(np.square(told))) < 1.5


def test_a_quarter_of_the_range_without_joint_angles_is_refused():
    found, _ = swept(0, known=False, share=0.25)
    assert "does not determine the surface" in found.refusal
    assert "of its 254 deg" in found.refusal


def test_too_few_points_are_refused():
    assert "too few" in swept(0, known=True, count=6)[0].refusal


def test_outliers_are_left_out():
    rng = np.random.default_rng(0)
    wanted, true = standing(3)
    joints = sweep(rng, 80)
    points = true.forward(joints) + SIGMA * rng.normal(size=(80, 3))
    points[[5, 50]] += [0.02, 0.0, 0.01]
    found = calibrate(points, joints, wanted, SIGMA)
    assert np.flatnonzero(~found.used).tolist() == [5, 50]
    assert surface_off(found.arm, true) < 0.2e-3


def test_points_of_something_else_are_refused():
    wanted, _ = standing(3)
    points = np.random.default_rng(0).uniform(-0.5, 0.5, (60, 3))
    assert calibrate(points, None, wanted, SIGMA).refusal


def test_the_covariance_of_the_invariants_is_what_happens():
    wanted, true = standing(2)
    joints = sweep(np.random.default_rng(0), 100)
    drawn, told = [], None
    for seed in range(40):
        rng = np.random.default_rng(seed)
        found = calibrate(true.forward(joints) + SIGMA * rng.normal(size=(100, 3)), joints, wanted, SIGMA)
        five = found.invariants
        drawn.append([five.a, five.alpha, five.z0, five.h, five.R])
        told = found.invariants_covariance
    ratio = np.std(drawn, axis=0, ddof=1) / np.sqrt(np.diag(told))
    assert (ratio > 0.6).all()
    assert (ratio < 1.5).all()


def off_its_place(seed, share):
    """Return where an arm should stand, where it does, and points of a sweep over a part of joint 2."""
    rng = np.random.default_rng([seed, 23])
    wanted = StandingArm.of(planted_arm(rng), LIMITS.base.middle)
    shift, turn = (each / np.linalg.norm(each) for each in rng.normal(size=(2, 3)))
    true = wanted.moved(np.concatenate([10e-3 * shift, np.radians(4.0) * turn]))
    low, high = np.transpose([[each.lower, each.upper] for each in (LIMITS.base, LIMITS.second)])
    high[1] = low[1] + share * (high[1] - low[1])
    points = true.forward(rng.uniform(low, high, (200, 2)))
    return wanted, true, points + SIGMA * rng.normal(size=points.shape)


def test_joints_that_are_followed_onto_the_wrong_branch_are_found_again():
    # Axes some 6 deg apart: as the arm turns beneath a point, another angle of joint 2 becomes the closest.
    wanted, true, points = off_its_place(33, 1.0)
    found = calibrate(points, None, wanted, SIGMA)
    assert not found.refusal
    assert surface_off(found.arm, true) < 0.1e-3


def test_a_short_sweep_that_another_arm_fits_as_well_is_refused():
    # Axes that nearly meet: two sheets a millimetre apart, of which each point takes the nearer one.
    wanted, true, points = off_its_place(10, 0.25)
    found = calibrate(points, None, wanted, SIGMA)
    assert surface_off(found.arm, true) > 0.3e-3
    assert "does not determine the surface" in found.refusal
