"""Forward and inverse kinematics of shapes, the degenerate families among them."""

import math
from dataclasses import replace

import numpy as np
import pytest
from planted import ROBOT, arm_of, planted_arm, random_shape

from synth.robot import Arm, BasePose, Interval, JointLimits, LinkShape
from synth.task import Topology

FREE = replace(ROBOT, joint_limits=JointLimits())
FAMILIES = [Topology.ANY, Topology.SPHERICAL, Topology.PUMA, Topology.SCARA]


@pytest.fixture(params=FAMILIES, ids=lambda topology: topology.value, scope="module")
def arm(request):
    return planted_arm(np.random.default_rng(7), request.param)


def joints_within_limits(arm, count, seed=0):
    rng, limits = np.random.default_rng(seed), arm.robot.joint_limits
    theta1 = rng.uniform(limits.base.lower, limits.base.upper, count)
    theta2 = rng.uniform(limits.second.lower, limits.second.upper, count)
    return np.column_stack([theta1, theta2])


def test_forward_kinematics_follow_the_written_convention():
    # P5 = Rz(theta1) [c + R (-cos(theta2) t - sin(theta2) (u x t))], term by term.
    arm = arm_of(random_shape(np.random.default_rng(1)))
    rotation, p = arm.shape.end_frame()
    p = p + [0.0, 0.0, 0.058]
    u, t = rotation[:, 0], rotation[:, 2]
    p3 = p - 0.0245 * u
    along = (0.455**2 - 0.460**2 + 0.049**2) / (2 * 0.049)
    centre, radius = p3 + along * u, math.sqrt(0.455**2 - along**2)
    for theta1, theta2 in joints_within_limits(arm, 20):
        circle = centre + radius * (-np.cos(theta2) * t - np.sin(theta2) * np.cross(u, t))
        cos, sin = np.cos(theta1), np.sin(theta1)
        expected = np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]]) @ circle
        np.testing.assert_allclose(arm.forward_kinematics(theta1, theta2), expected, atol=1e-14)
    np.testing.assert_allclose(arm.axis_points[2:], [p3, p3 + 0.049 * u], atol=1e-14)


def test_a_straight_link_has_its_rigid_link_straight_on_at_180_degrees():
    arm = arm_of(LinkShape([[0.0, 0.0]], [0.6]))
    straight, folded = arm.forward_kinematics(0.0, [np.pi, 0.0])
    assert straight[2] == pytest.approx(0.058 + 0.6 + arm.circle.radius)
    assert folded[2] == pytest.approx(0.058 + 0.6 - arm.circle.radius)


def test_the_end_effector_keeps_its_distances(arm):
    joints = joints_within_limits(arm, 50)
    points = arm.forward_kinematics(0.0, joints[:, 1])
    np.testing.assert_allclose(np.linalg.norm(points - arm.axis_points[2], axis=1), 0.455, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(points - arm.axis_points[3], axis=1), 0.460, atol=1e-12)


def test_inverse_kinematics_brings_back_the_joints(arm):
    joints = joints_within_limits(arm, 300)
    branches = arm.inverse_kinematics(arm.forward_kinematics(joints[:, 0], joints[:, 1]))
    off = np.abs(branches.joints - joints[:, None]).max(axis=-1)
    np.testing.assert_allclose(off.min(axis=-1), 0.0, atol=2e-6)
    assert branches.miss[:, 0].max() < 1e-9


def test_every_branch_reaches_its_point_and_respects_the_limits(arm):
    joints = joints_within_limits(arm, 300)
    points = arm.forward_kinematics(joints[:, 0], joints[:, 1])
    branches = arm.inverse_kinematics(points)
    reached = arm.forward_kinematics(branches.joints[..., 0], branches.joints[..., 1])
    finite = np.isfinite(branches.miss)
    np.testing.assert_allclose(
        np.linalg.norm(reached - points[:, None], axis=-1)[finite], branches.miss[finite], atol=1e-15
    )
    assert arm.robot.joint_limits.contain(branches.joints[finite]).all()


@pytest.mark.parametrize("topology", FAMILIES, ids=lambda topology: topology.value)
def test_two_branches_where_the_axes_meet_or_are_parallel_and_one_elsewhere(topology):
    arm = replace(planted_arm(np.random.default_rng(3), topology), robot=FREE)
    joints = joints_within_limits(arm, 100)
    branches = arm.inverse_kinematics(arm.forward_kinematics(joints[:, 0], joints[:, 1]))
    reaching = (branches.miss < 1e-10).sum(axis=-1)
    expected = 1 if topology is Topology.ANY else 2
    assert np.all(reaching == expected)


def test_closest_joints_find_points_of_the_workspace(arm):
    joints = joints_within_limits(arm, 100)
    _, misses = arm.closest_joints(arm.forward_kinematics(joints[:, 0], joints[:, 1]))
    assert misses.max() < 1e-9


def test_closest_joints_are_not_beaten_by_a_dense_grid(arm):
    rng = np.random.default_rng(5)
    points = rng.uniform([-0.9, -0.9, 0.0], [0.9, 0.9, 0.9], (40, 3))
    joints, misses = arm.closest_joints(points)
    assert arm.robot.joint_limits.contain(joints).all()
    reached = arm.forward_kinematics(joints[:, 0], joints[:, 1])
    np.testing.assert_allclose(np.linalg.norm(reached - points, axis=1), misses, atol=1e-15)
    limits = arm.robot.joint_limits
    theta1 = np.linspace(limits.base.lower, limits.base.upper, 400)
    theta2 = np.linspace(limits.second.lower, limits.second.upper, 400)
    grid = arm.forward_kinematics(theta1[:, None], theta2).reshape(-1, 3)
    for point, miss in zip(points, misses, strict=True):
        assert miss <= np.linalg.norm(grid - point, axis=1).min() + 1e-9


def test_a_point_in_the_dead_zone_of_joint_1_is_missed(arm):
    inside = arm.forward_kinematics(0.0, 2.0)  # joint 1 turns from 10 to 350 deg
    rho = np.hypot(inside[0], inside[1])
    _, miss = arm.closest_joints(inside)
    assert 0.0 < miss <= 2.0 * rho * math.sin(math.radians(5.0)) + 1e-9
    other_branch = arm.inverse_kinematics(inside).reaching()
    assert np.all(np.abs(other_branch[:, 0] % (2 * np.pi)) > math.radians(10.0) - 1e-9)


def test_the_base_pose_moves_everything_alike(arm):
    base = BasePose([0.3, -0.2, 0.1], 0.7)
    moved = replace(arm, base=base)
    points = arm.forward_kinematics([1.0, 2.0], [1.5, 3.0])
    np.testing.assert_allclose(moved.forward_kinematics([1.0, 2.0], [1.5, 3.0]), base.to_task(points))
    np.testing.assert_allclose(base.to_base(base.to_task(points)), points, atol=1e-15)
    branches = moved.inverse_kinematics(base.to_task(points))
    assert branches.miss[:, 0].max() < 1e-9


def test_the_workspace_lies_on_gamma_and_keeps_its_invariants_and_category(arm):
    joints = joints_within_limits(arm, 50)
    points = arm.forward_kinematics(joints[:, 0], joints[:, 1])
    assert arm.surface.residual(points).max() < 1e-12
    assert arm.circle.distance(points).max() < 1e-9
    again = Arm(arm.robot, arm.shape, arm.d35, arm.d45, BasePose([1.0, 2.0, 3.0], 0.4))
    assert again.invariants == arm.invariants


def test_planted_families_have_their_category():
    for topology in FAMILIES[1:]:
        arm = planted_arm(np.random.default_rng(11), topology)
        assert arm.category.value == topology.value


def test_the_end_effector_circle_of_a_flat_triangle_has_no_radius():
    offset, radius = ROBOT.end_effector_circle(0.5, 0.549)
    assert radius == pytest.approx(0.0, abs=1e-7)
    assert offset == pytest.approx(-0.5 - ROBOT.tip_offset)


def test_joint_limits_contain_their_ends():
    limits = JointLimits(Interval(0.0, 1.0), Interval(-1.0, 1.0))
    joints = np.array([[0.0, -1.0], [1.0, 1.0], [1.1, 0.0], [0.5, -1.2]])
    assert limits.contain(joints).tolist() == [True, True, False, False]
