"""The arm that stands there: the same kinematics as the arm that was planned, wherever it stands."""

import numpy as np
import pytest
from planted import ROBOT, planted_arm
from standing import standing

from synth.measurement import StandingArm, joints_closest_to, joints_following, rotation_matrix
from synth.measurement.markers.standing_arm import FREEDOMS

LIMITS = ROBOT.joint_limits


def postures(rng, count):
    return np.column_stack(
        [
            rng.uniform(LIMITS.base.lower, LIMITS.base.upper, count),
            rng.uniform(LIMITS.second.lower, LIMITS.second.upper, count),
        ]
    )


@pytest.mark.parametrize("seed", range(5))
def test_as_planned_it_has_the_kinematics_of_the_plan(seed):
    rng = np.random.default_rng(seed)
    arm, joints = planted_arm(rng), postures(rng, 20)
    planned = arm.forward_kinematics(joints[:, 0], joints[:, 1])
    assert np.allclose(StandingArm.of(arm, rng.uniform(1.0, 5.0)).forward(joints), planned, atol=1e-13)


def test_a_rotation_matrix_is_a_rotation_about_its_vector():
    vectors = np.random.default_rng(0).normal(size=(50, 3))
    matrices = rotation_matrix(vectors)
    assert np.allclose(matrices @ np.swapaxes(matrices, -1, -2), np.eye(3), atol=1e-14)
    assert np.allclose(np.einsum("nij,nj->ni", matrices, vectors), vectors)
    angle = np.linalg.norm(vectors, axis=1)
    assert np.allclose(np.trace(matrices, axis1=1, axis2=2), 1.0 + 2.0 * np.cos(angle))


def test_velocities_are_differences():
    rng = np.random.default_rng(1)
    _, arm = standing(1)
    arm = arm.displaced(rng.normal(size=FREEDOMS) * 0.05)
    joints = postures(rng, 12)
    reached, velocities = arm.velocities(joints)
    assert np.allclose(reached, arm.forward(joints), atol=1e-14)
    for joint in range(2):
        step = 1e-6 * np.eye(2)[joint]
        difference = (arm.forward(joints + step) - arm.forward(joints - step)) / 2e-6
        assert np.allclose(velocities[..., joint], difference, atol=1e-8)


@pytest.mark.parametrize("seed", range(5))
def test_closest_and_following_find_the_joints_of_reached_points(seed):
    rng = np.random.default_rng(seed)
    _, arm = standing(seed)
    arm = arm.displaced(rng.normal(size=FREEDOMS) * 0.02)
    joints = postures(rng, 10)
    points = arm.forward(joints)
    assert np.linalg.norm(arm.forward(joints_closest_to(arm, points)) - points, axis=1).max() < 1e-8
    near = np.clip(joints + rng.normal(size=joints.shape) * 0.03, joints.min() - 1.0, None)
    assert np.linalg.norm(arm.forward(joints_following(arm, near, points)) - points, axis=1).max() < 1e-5


def test_following_is_as_good_as_the_search_over_all_joints_for_points_off_the_surface():
    rng = np.random.default_rng(3)
    _, arm = standing(3)
    joints = postures(rng, 30)
    points = arm.forward(joints) + rng.normal(size=(30, 3)) * 3e-3
    found, best = joints_following(arm, joints, points), joints_closest_to(arm, points)
    misses = [np.linalg.norm(arm.forward(each) - points, axis=1) for each in (found, best)]
    assert np.mean(misses[0] <= misses[1] + 1e-6) > 0.9
    assert (found >= [LIMITS.base.lower, LIMITS.second.lower]).all()
    assert (found <= [LIMITS.base.upper, LIMITS.second.upper]).all()


def test_many_arms_at_once_are_each_of_them():
    rng = np.random.default_rng(4)
    _, arm = standing(4)
    by = rng.normal(size=(6, FREEDOMS)) * 0.02
    joints = postures(rng, 5)
    points = arm.forward(joints)
    together = arm.displaced(by)
    for k in range(6):
        alone = arm.displaced(by[k])
        assert np.allclose(
            together.forward(np.broadcast_to(joints, (6, 5, 2)))[k], alone.forward(joints), atol=1e-14
        )
        assert np.allclose(
            joints_following(together, joints, points)[k], joints_following(alone, joints, points), atol=1e-9
        )
