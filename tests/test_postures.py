"""Postures of many shapes: what forward kinematics says of them, and that nearer ones are hard to find."""

from dataclasses import replace

import numpy as np
import pytest
from planted import ROBOT

from synth.robot import BasePose, Interval, JointLimits
from synth.synthesis.shapes import TargetsSeen
from synth.synthesis.shapes.postures import Postures, dot
from synth.synthesis.shapes.shapes import Shapes

NARROW = JointLimits(Interval(-1.0, 2.0), Interval(2.0, 4.0))


def shapes_and_aims(seed, limits=ROBOT.joint_limits, noise=0.02):
    """Shapes, and targets near the workspace of the first."""
    rng = np.random.default_rng(seed)
    shapes = Shapes.sample(replace(ROBOT, joint_limits=limits), 30, rng)
    arm = shapes.arm(0, BasePose())
    theta1 = rng.uniform(limits.base.lower, limits.base.upper, 12)
    theta2 = rng.uniform(limits.second.lower, limits.second.upper, 12)
    points = arm.forward_kinematics(theta1, theta2) + noise * rng.normal(size=(12, 3))
    return shapes, TargetsSeen(points, limits)


@pytest.mark.parametrize("limits", [ROBOT.joint_limits, NARROW])
@pytest.mark.parametrize("seed", range(3))
def test_postures_are_within_the_limits_and_where_forward_kinematics_says(seed, limits):
    shapes, aims = shapes_and_aims(seed, limits)
    postures = Postures.nearest(aims, shapes.kinematics)
    assert limits.contain(postures.joints).all()
    for index in range(0, 30, 7):
        arm = shapes.arm(index, BasePose())
        reached = arm.forward_kinematics(*postures.joints[index].T)
        squared = np.sum((reached - aims.positions) ** 2, axis=-1)
        assert np.allclose(postures.squared[index], squared, rtol=1e-9, atol=1e-14)
        _, closest = arm.closest_joints(aims.positions)
        assert (np.sqrt(postures.squared[index]) >= closest - 1e-9).all()


@pytest.mark.parametrize("seed", range(3))
def test_the_nearest_posture_is_found_for_nearly_all_targets_beside_the_workspace(seed):
    shapes, aims = shapes_and_aims(seed)
    postures = Postures.nearest(aims, shapes.take(np.arange(1)).kinematics)
    _, closest = shapes.arm(0, BasePose()).closest_joints(aims.positions)
    off = np.sqrt(postures.squared[0]) - closest
    assert np.median(off) < 1e-5
    assert np.count_nonzero(off > 1e-3) <= 1


def test_the_tangent_is_the_derivative_by_joint_2():
    shapes, aims = shapes_and_aims(5)
    kinematics, step = shapes.kinematics, 1e-6
    here = Postures.nearest(aims, kinematics)
    there = Postures.at(aims, kinematics, here.theta2 + step)
    free = (here.beyond == 0.0) & (there.beyond == 0.0)
    along, speed = here.free_tangent
    slope = (there.squared - here.squared) / step
    assert np.allclose(slope[free], (2.0 * speed * dot(along, here.miss))[free], atol=1e-5)


def test_postures_are_chosen_one_by_one():
    shapes, aims = shapes_and_aims(7)
    one = Postures.nearest(aims, shapes.kinematics)
    other = Postures.at(aims, shapes.kinematics, np.full(one.theta2.shape, 3.0))
    mask = np.random.default_rng(0).uniform(size=one.theta2.shape) < 0.5
    mixed = one.where(mask, other)
    assert np.array_equal(mixed.squared[mask], one.squared[mask])
    assert np.array_equal(mixed.joints[~mask], other.joints[~mask])


@pytest.mark.parametrize("seed", range(3))
def test_steps_of_joint_2_never_lead_away_from_a_target(seed):
    shapes, aims = shapes_and_aims(seed)
    theta2 = np.random.default_rng(seed).uniform(1.0, 5.0, (30, 12))
    start = Postures.at(aims, shapes.kinematics, theta2)
    led = Postures.led_from(aims, shapes.kinematics, theta2, never_away=True)
    assert (led.squared <= start.squared).all()
    assert (led.squared < start.squared).mean() > 0.9
