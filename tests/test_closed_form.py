"""The fast inverse kinematics against a numeric solver: anywhere, at limits, at rims, on axis 1."""

from dataclasses import replace

import numpy as np
import pytest
from planted import ROBOT, arm_of, planted_arm
from scipy.optimize import brentq, minimize_scalar

from synth.robot import Arm, BasePose, JointLimits, LinkShape
from synth.task import Topology

FAMILIES = [Topology.ANY, Topology.SPHERICAL, Topology.PUMA, Topology.SCARA]
BASE = BasePose([0.1, -0.2, 0.05], 0.7)
WITHIN = 1e-7


@pytest.fixture(params=FAMILIES, ids=lambda topology: topology.value, scope="module")
def arm(request):
    return replace(planted_arm(np.random.default_rng(7), request.param), base=BASE)


def random_joints(arm, count, seed=0):
    return np.random.default_rng(seed).uniform(*arm.joint_bounds, (count, 2))


def rims(arm):
    """Angles of joint 2 at which P5 turns back, in or out, up or down, by bisection."""

    def area(theta2):
        j = arm.jacobian([0.0, theta2])
        x, y = arm.base.to_base(arm.forward_kinematics(0.0, theta2))[:2]
        radial = np.array([x, y, 0.0]) @ (arm.base.rotation.T @ j[:, 1])
        return radial, (arm.base.rotation.T @ j[:, 1])[2]

    grid = np.linspace(arm.joint_bounds[0, 1], arm.joint_bounds[1, 1], 2001)
    found = []
    for part in (0, 1):
        values = np.array([area(theta2)[part] for theta2 in grid])
        found += [
            brentq(lambda t, k=part: area(t)[k], grid[index], grid[index + 1], xtol=1e-15)
            for index in np.flatnonzero(values[:-1] * values[1:] < 0.0)
        ]
    return np.array(found)


def numeric_miss(arm, joints, point):
    """The least miss near joint angles, by a search over joint 2 with joint 1 at its best: no derivative."""
    base = arm.base.to_base(point)

    def miss(theta2):
        x, y, z = arm.base.to_base(arm.forward_kinematics(0.0, theta2))
        return (np.hypot(x, y) - np.hypot(*base[:2])) ** 2 + (z - base[2]) ** 2

    best = minimize_scalar(miss, bracket=(joints[1] - 1e-3, joints[1] + 1e-3), tol=1e-15)
    return best.x, np.sqrt(best.fun)


def points_of(arm):
    lower, upper = arm.joint_bounds
    joints = [*random_joints(arm, 40), *random_joints(arm, 40)]
    for row, theta2 in enumerate([lower[1], upper[1]] * 10):
        joints[row][1] = theta2
    joints += [
        [theta1, theta2] for theta2 in rims(arm)[:6] for theta1 in np.linspace(*arm.joint_bounds[:, 0], 5)
    ]
    return np.array(joints)


def test_every_point_is_reached_at_the_joints_that_made_it(arm):
    joints = points_of(arm)
    points = arm.forward_kinematics(*joints.T)
    branches = arm.inverse_kinematics(points, within=WITHIN)
    assert branches.miss[:, 0].max() < 1e-9
    again = arm.forward_kinematics(branches.joints[..., 0], branches.joints[..., 1])
    off = np.linalg.norm(again - points[:, None], axis=-1)
    good = np.isfinite(branches.miss)
    np.testing.assert_allclose(off[good], branches.miss[good], atol=1e-12)
    assert good.any(axis=1).all()


def test_it_agrees_with_a_numeric_solver(arm):
    joints = points_of(arm)
    points = arm.forward_kinematics(*joints.T)
    branches = arm.inverse_kinematics(points, within=WITHIN, within_limits=False)
    for made, point, each in zip(joints, points, branches.joints, strict=True):
        theta2, least = numeric_miss(arm, made, point)
        nearest = np.abs(np.exp(1j * each[:, 1]) - np.exp(1j * theta2)).argmin()
        solved = arm.forward_kinematics(*each[nearest])
        assert np.linalg.norm(solved - point) <= least + 1e-9


def test_a_largest_miss_drops_nothing_that_misses_by_less(arm):
    joints = points_of(arm)
    points = arm.forward_kinematics(*joints.T) + np.random.default_rng(1).normal(0.0, 1e-4, (len(joints), 3))
    for options in ({}, {"within_limits": False}):
        free = arm.inverse_kinematics(points, **options)
        bound = arm.inverse_kinematics(points, within=1e-3, **options)
        for one, other in zip(free.miss, bound.miss, strict=True):
            near = np.sort(one[one < 0.9e-3])
            assert (np.sort(other)[: len(near)] <= near + 1e-9).all()


def test_beside_the_workspace_no_turn_of_a_joint_comes_nearer(arm):
    joints = random_joints(arm, 60)
    points = arm.forward_kinematics(*joints.T) + np.random.default_rng(4).normal(0.0, 0.02, (60, 3))
    together = arm.inverse_kinematics(points, within_limits=False)
    for point, angles, misses in zip(points, together.joints, together.miss, strict=True):
        alone = arm.inverse_kinematics(point, within_limits=False)
        np.testing.assert_allclose(alone.miss, misses, rtol=1e-6)
        for branch, miss in zip(angles[np.isfinite(misses)], misses[np.isfinite(misses)], strict=True):
            assert np.linalg.norm(arm.forward_kinematics(*branch) - point) == pytest.approx(miss, abs=1e-12)
        if arm.manipulability(angles[0]) < 0.02:  # at a rim the few steps come near, not to the end
            continue
        for shift in np.array([[1e-3, 0.0], [0.0, 1e-3]]):
            for sign in (1.0, -1.0):
                moved = arm.forward_kinematics(*(angles[0] + sign * shift))
                assert np.linalg.norm(moved - point) > misses[0] - 1e-9


def test_points_on_axis_1_are_reached():
    arm = Arm(ROBOT, LinkShape([[0.0, 0.0]], [0.6]), 0.455, 0.455, BASE)
    point = arm.forward_kinematics(0.0, np.pi)
    for options in ({}, {"within_limits": False}):
        branches = arm.inverse_kinematics([point, point], within=1e-6, **options)
        assert branches.miss[:, 0].max() < 1e-9
        theta1, theta2 = branches.joints[0, 0]
        np.testing.assert_allclose(arm.forward_kinematics(theta1, theta2), point, atol=1e-9)


def test_points_off_the_workspace_have_no_branch(arm):
    points = arm.forward_kinematics(*random_joints(arm, 200).T) + [0.0, 0.0, 3.0]
    assert np.isinf(arm.inverse_kinematics(points, within=1e-3).miss).all()


def test_limits_drop_branches_only_if_asked():
    arm = planted_arm(np.random.default_rng(7), Topology.PUMA)
    free = replace(arm, robot=replace(ROBOT, joint_limits=JointLimits()))
    points = free.forward_kinematics(*random_joints(free, 500).T)
    limited = arm.inverse_kinematics(points, within=WITHIN)
    everywhere = arm.inverse_kinematics(points, within=WITHIN, within_limits=False)
    assert np.isfinite(everywhere.miss).all()  # the axes meet: two branches each
    inside = arm.robot.joint_limits.contain(everywhere.joints)
    assert np.isfinite(limited.miss).sum() == inside.sum()
    assert 0 < inside.sum() < inside.size


def test_shapes_of_points_are_kept(arm):
    points = arm.forward_kinematics(*random_joints(arm, 12).T)
    one = arm.inverse_kinematics(points[0], within=WITHIN)
    assert one.joints.shape == (2, 2)
    many = arm.inverse_kinematics(points.reshape(3, 4, 3), within=WITHIN)
    assert many.joints.shape == (3, 4, 2, 2)
    np.testing.assert_allclose(many.joints[0, 0], one.joints, rtol=1e-15)  # math and numpy round on their own
    assert arm.inverse_kinematics(np.empty((0, 3)), within=WITHIN).miss.shape == (0, 2)
    assert arm_of(arm.shape).inverse_kinematics(points[0], within=1.0).reaching(1.0).ndim == 2


def test_one_point_and_one_posture_are_answered_as_many_are(arm):
    joints = points_of(arm)
    points = arm.forward_kinematics(*joints.T)
    many = arm.inverse_kinematics(points, within=WITHIN)
    for index, point in enumerate(points):
        one = arm.inverse_kinematics(point, within=WITHIN)
        reached = np.isfinite(many.miss[index])
        np.testing.assert_array_equal(np.isfinite(one.miss), reached)
        np.testing.assert_allclose(one.joints[reached], many.joints[index][reached], atol=1e-6)
        np.testing.assert_allclose(one.miss[reached], many.miss[index][reached], atol=1e-12)
    for (theta1, theta2), point in zip(joints, arm.forward_kinematics(*joints.T), strict=True):
        np.testing.assert_allclose(arm.forward_kinematics(theta1, theta2), point, atol=1e-15)
        np.testing.assert_allclose(arm.forward_kinematics([theta1], theta2), [point], atol=1e-15)


@pytest.mark.parametrize("bad", [np.nan, np.inf, 1e200])
@pytest.mark.filterwarnings("ignore:invalid value:RuntimeWarning", "ignore:overflow:RuntimeWarning")
def test_what_is_no_point_has_no_branch_and_is_no_exception(arm, bad):
    assert not np.isfinite(arm.inverse_kinematics([0.5, bad, 0.1], within=WITHIN).miss).any()
    assert np.isnan(arm.forward_kinematics(bad, 1.0)[0]) == (not np.isfinite(bad))
