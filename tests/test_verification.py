"""The independent check must be able to say no: one planted fault at a time."""

import math
from dataclasses import replace

import numpy as np
import pytest
from planted import ROBOT, arm_of, planted_task, scanned

from synth.errors import InputError
from synth.geometry import Sphere
from synth.robot import BasePose, Interval, JointLimits, LinkShape, MalleableLink, RigidLink
from synth.synthesis import verify
from synth.synthesis.check import clearances
from synth.task import Obstacle, PointTarget, Topology


@pytest.fixture(scope="module")
def planted():
    return planted_task(21, 6)


def limits_broken(task, arm):
    return {violation.limit for violation in verify(task, arm).violations}


def with_link(task, arm, **changes):
    """Return task and arm with another link; the shape stays as it is."""
    robot = replace(task.robot, link=replace(task.robot.link, **changes))
    return replace(task, robot=robot), replace(arm, robot=robot)


def test_what_was_planted_passes(planted):
    task, arm = planted
    check = verify(task, arm)
    assert check.found
    assert check.misses.max() < 1e-9
    assert check.gamma_residuals.max() < 1e-12


def test_a_target_moved_off_the_surface_is_missed_by_as_much(planted):
    task, arm = planted
    joints = arm.closest_joints(task.targets[2].position)[0]
    by_theta1, by_theta2 = arm.kinematics.velocities(joints, arm.kinematics.forward(*joints))
    normal = np.cross(by_theta1, by_theta2)
    moved = task.targets[2].position + 2e-3 * normal / np.linalg.norm(normal)
    targets = (*task.targets[:2], replace(task.targets[2], position=moved), *task.targets[3:])
    check = verify(replace(task, targets=targets), arm)
    assert check.possible
    assert not check.found
    assert check.within_tolerance == (True, True, False, True, True, True)
    assert check.misses[2] == pytest.approx(2e-3, rel=1e-2)


def test_a_link_too_long_or_too_short_breaks_its_length(planted):
    task, arm = planted
    length = arm.shape.length
    for interval in (Interval(0.1, length - 2e-6), Interval(length + 2e-6, 2.0)):
        assert limits_broken(*with_link(task, arm, length=interval)) == {"length: link"}
    assert not limits_broken(*with_link(task, arm, length=Interval.fixed(length)))


def test_a_bend_too_tight_or_too_far_breaks_its_limit(planted):
    task, arm = planted
    tight, far = arm.shape.min_bend_radius, arm.shape.total_bend
    assert limits_broken(*with_link(task, arm, min_bend_radius=tight + 2e-6)) == {"min_bend_radius"}
    assert limits_broken(*with_link(task, arm, max_total_bend=far - 2e-6)) == {"max_total_bend"}


def test_a_rigid_link_beyond_its_interval_is_noticed(planted):
    task, arm = planted
    robot = replace(ROBOT, rigid_link=RigidLink(Interval(0.3, 0.4), Interval(0.3, 0.4)))
    assert limits_broken(replace(task, robot=robot), replace(arm, robot=robot)) == {
        "length: d35",
        "length: d45",
    }


def test_joint_limits_bend_the_answer_and_are_never_exceeded(planted):
    task, arm = planted
    narrow = replace(ROBOT, joint_limits=JointLimits(Interval(1.0, 2.0), Interval(2.0, 3.0)))
    check = verify(replace(task, robot=narrow), replace(arm, robot=narrow))
    assert not check.found
    assert narrow.joint_limits.contain(check.joints).all()
    assert check.misses.max() > 0.1


def test_the_floor_counts_for_link_joint_and_end_effector():
    flat = LinkShape([[9.0, 0.0], [9.0, 0.0], [-2.0, 0.0], [0.0, 0.0]], [0.16] * 4)
    arm = arm_of(flat)
    assert ROBOT.d12 + flat.lowest() < 0.0
    task, _ = planted_task(21, 6)
    broken = limits_broken(task, arm)
    assert {"floor: link", "floor: second joint"} <= broken
    assert not limits_broken(replace(task, floor=None), arm)


def test_a_target_below_the_floor_is_not_reached_there(planted):
    _, arm = planted
    low = arm.forward_kinematics(1.0, np.linspace(1.0, 5.3, 200))
    low = low[np.argmin(low[:, 2])]
    task, _ = planted_task(21, 1)
    task = replace(task, targets=(replace(task.targets[0], position=low),), floor=float(low[2]) + 0.01)
    assert not verify(task, arm).found
    assert verify(replace(task, floor=float(low[2])), arm).within_tolerance == (True,)


@pytest.mark.parametrize(
    "topology", [Topology.SPHERICAL, Topology.PUMA, Topology.SCARA], ids=lambda t: t.value
)
def test_a_topology_is_exact_or_violated(topology):
    task, arm = planted_task(22, 3, topology)
    asked = replace(task, topology=topology)
    assert not limits_broken(asked, arm)
    shape = arm.shape
    bent = replace(arm, shape=replace(shape, curvatures=shape.curvatures + 1e-4))
    assert "topology" in limits_broken(asked, bent)
    assert "topology" in limits_broken(replace(task, topology=Topology.GENERAL), arm)


def test_a_shape_that_is_no_number_is_refused(planted):
    task, arm = planted
    with pytest.raises(InputError, match="lengths"):
        verify(task, replace(arm, shape=replace(arm.shape, lengths=arm.shape.lengths * math.nan)))


def test_the_link_of_the_preset_is_the_published_one():
    assert ROBOT.link == MalleableLink(Interval(0.55, 0.7), 0.11, 0.05, 5.0)


@pytest.mark.parametrize("moved", [BasePose([0.5, 0.0, 0.0]), BasePose([0.0, 0.0, -0.02]), BasePose(yaw=0.3)])
def test_an_arm_that_stands_elsewhere_is_never_found(planted, moved):
    """Targets that it reaches from there, and whatever the obstacles are seen from."""
    task, arm = planted
    elsewhere = replace(arm, base=moved)
    joints, _ = arm.closest_joints(task.table.positions)
    reached = elsewhere.forward_kinematics(*joints.T)
    targets = tuple(PointTarget(t.name, p, t.tolerance) for t, p in zip(task.targets, reached, strict=True))
    check = verify(replace(task, targets=targets), elsewhere)
    assert all(check.within_tolerance)
    assert not check.found
    assert {violation.limit.split(":")[0] for violation in check.violations} == {"base"}
    assert verify(replace(task, targets=targets, base=moved), elsewhere).found


def test_a_ball_on_the_link_of_an_arm_that_stands_elsewhere_is_seen(planted):
    task, arm = planted
    moved = BasePose([0.5, -0.2, 0.0], 0.4)
    elsewhere = replace(arm, base=moved)
    joints, _ = arm.closest_joints(task.table.positions)
    reached = elsewhere.forward_kinematics(*joints.T)
    targets = tuple(PointTarget(t.name, p, t.tolerance) for t, p in zip(task.targets, reached, strict=True))
    middle = arm.shape.point_at(0.5 * arm.shape.length) + arm.base_joint[1]
    c, s = np.cos(joints[0, 0]), np.sin(joints[0, 0])
    centre = moved.to_task([c * middle[0] - s * middle[1], s * middle[0] + c * middle[1], middle[2]])
    ball = Sphere(centre, 0.03)
    check = verify(replace(task, targets=targets, obstacles=(Obstacle("ball", ball),)), elsewhere)
    assert {"base: position", "base: turn"} == {v.limit for v in check.violations}
    assert not check.within_tolerance[0]  # the way there that the ball blocks is not taken
    assert verify(replace(task, targets=targets), elsewhere).within_tolerance[0]
    position, yaw = (v.sentence for v in check.violations[:2])
    assert position == "the arm stands 538.5 mm from where the task puts it"
    assert yaw == "the arm stands turned by 22.92 deg from how the task puts it"


def test_joints_that_are_to_be_kept_are_kept_within_the_tolerance_only(planted):
    task, arm = planted
    closest, _ = arm.closest_joints(task.table.positions)
    nearly = closest + np.radians([0.02, 0.0])  # some tenths of a millimetre off
    check = verify(task, arm, nearly, keep=True)
    assert np.array_equal(check.joints, nearly)
    assert check.found
    assert 1e-5 < check.misses.max() < 0.5e-3
    assert not np.array_equal(verify(task, arm, nearly).joints, nearly)
    far = verify(task, arm, closest + np.radians([2.0, 0.0]), keep=True)
    assert far.misses.max() < 1e-9


def test_many_joint_angles_are_clear_as_each_of_them_is(monkeypatch):
    task, arm = scanned(1500, noise=0.0)
    angles = np.random.default_rng(0).uniform(0.0, 2.0 * np.pi, (1500, 2))  # some of them in the arm itself
    one_by_one = clearances.clear_of_everything(task, arm, angles)
    assert 0.02 < np.mean(one_by_one) < 0.98
    monkeypatch.setattr(clearances, "_TOGETHER", 100)
    assert np.array_equal(clearances.clear_of_everything(task, arm, angles), one_by_one)
    sphere = Obstacle("ball", Sphere(arm.forward_kinematics(1.0, 3.0), 0.05))
    beside = replace(task, obstacles=(sphere,))
    of_all = clearances.Clearances.of(beside, arm, angles)
    assert np.array_equal(clearances.clear_of_everything(beside, arm, angles), of_all.clear)
    assert np.count_nonzero(of_all.clear) < np.count_nonzero(one_by_one)
