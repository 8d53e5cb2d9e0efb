"""The oracle and the package are two implementations of one arm: they agree; and it sees what is wrong."""

from dataclasses import replace

import numpy as np
import pytest
from oracle import OracleArm, longest_rod
from planted import ROBOT, planted_arm

from synth.robot import (
    Arm,
    ArmBody,
    BasePose,
    Interval,
    LinkShape,
    RigidLink,
    RigidLinkChoices,
    clear_of_tube,
    tube_clear_of_itself,
)
from synth.synthesis.bound.impossibility import longest_rigid_link

CLOSE = 3e-5  # what the package's bounds give away, m


@pytest.fixture(params=range(6))
def arm(request):
    rng = np.random.default_rng([request.param, 4])
    base = BasePose(rng.normal(size=3), rng.uniform(-3.0, 3.0))
    return replace(planted_arm(rng), base=base)


def joints_of(rng, count):
    limits = ROBOT.joint_limits
    return rng.uniform(
        [limits.base.lower, limits.second.lower], [limits.base.upper, limits.second.upper], (count, 2)
    )


def test_both_agree_on_where_the_arm_is(arm):
    oracle, joints = OracleArm.of(arm), joints_of(np.random.default_rng(0), 50)
    assert oracle.reached(joints) == pytest.approx(arm.forward_kinematics(*joints.T), abs=1e-12)
    assert oracle.axis_points == pytest.approx(arm.axis_points, abs=1e-12)
    along = np.linspace(0.0, arm.shape.length, 40)
    centreline = arm.shape.point_at(along) + [0.0, 0.0, ROBOT.d12]
    assert oracle.centreline(along) == pytest.approx(centreline, abs=1e-12)
    off = arm.category_distances
    assert oracle.off_topology == pytest.approx(
        {"spherical": off.spherical, "puma": off.puma, "scara": off.scara}, abs=1e-9
    )


def test_both_agree_on_what_is_nearest(arm):
    targets = arm.base.to_task(np.random.default_rng(1).normal(scale=0.5, size=(12, 3)))
    oracle = OracleArm.of(arm)
    misses = oracle.misses(oracle.closest(targets), targets)
    assert misses == pytest.approx(arm.closest_joints(targets)[1], abs=1e-9)


def test_both_agree_on_the_room_it_takes_up(arm):
    oracle, body = OracleArm.of(arm), ArmBody(arm)
    assert oracle.lowest() == pytest.approx(body.lowest(), abs=1e-6)
    assert min(oracle.tube_from_itself(), 0.02) == pytest.approx(tube_clear_of_itself(body), abs=CLOSE)
    for joints in joints_of(np.random.default_rng(2), 5):
        apart = clear_of_tube(body, joints[1:])[0]
        assert min(oracle.rod_from_tube(joints), 0.02) == pytest.approx(apart, abs=CLOSE)


def test_a_planted_arm_breaks_nothing_and_each_limit_it_is_taken_beyond():
    arm = planted_arm(np.random.default_rng(7))
    assert not OracleArm.of(arm).breaches_of_shape(0.0)
    shape = arm.shape
    tight = replace(ROBOT.link, min_bend_radius=shape.min_bend_radius + 1e-3)
    straight = replace(ROBOT.link, max_total_bend=shape.total_bend - 1e-3)
    short = replace(ROBOT.link, length=Interval(0.1, shape.length - 1e-3))
    for limit, link in (("bend radius", tight), ("total bend", straight), ("link length", short)):
        breaches = OracleArm.of(replace(arm, robot=replace(ROBOT, link=link))).breaches_of_shape(0.0)
        assert [breach.limit for breach in breaches] == [limit]
        assert breaches[0].amount == pytest.approx(1e-3)
    lowest = OracleArm.of(arm).lowest()
    sunk = OracleArm.of(arm).breaches_of_shape(lowest + 1e-3)
    assert "floor: link" in {breach.limit for breach in sunk}


def test_a_rigid_link_that_is_none_of_a_catalogue_is_seen():
    links = [RigidLink(0.300, 0.305, 0.01), RigidLink(0.455, 0.460, 0.02)]
    robot = replace(ROBOT, rigid_links=RigidLinkChoices(("short", "long"), links))
    shape = planted_arm(np.random.default_rng(7)).shape
    for lengths, diameter in ((links[0], 0.01), (links[1], 0.02)):
        oracle = OracleArm.of(Arm(robot, shape, lengths.d35.lower, lengths.d45.lower))
        assert not {"d35", "d45"} & {breach.limit for breach in oracle.breaches_of_shape()}
        assert oracle.rod_radius == 0.5 * diameter
    oracle = OracleArm(robot, oracle.curvatures, oracle.lengths, 0.400, 0.460, np.zeros(3), 0.0)
    (breach,) = (each for each in oracle.breaches_of_shape() if each.limit == "d35")
    assert breach.amount == pytest.approx(0.055)


def test_joint_angles_beyond_a_limit_a_floor_and_a_solid_are_seen():
    oracle = OracleArm.of(Arm(ROBOT, LinkShape(np.zeros((1, 2)), np.array([0.6])), 0.455, 0.46))
    assert not oracle.breaches_at([1.0, np.pi], 0.0)
    assert [breach.limit for breach in oracle.breaches_at([0.0, np.pi], 0.0)] == ["joint 1"]
    assert [breach.limit for breach in oracle.breaches_at([1.0, 6.0], 0.0)] == ["joint 2", "rod in tube"]
    height = float(oracle.end_effector([1.0, np.pi])[2])
    limits = [breach.limit for breach in oracle.breaches_at([1.0, np.pi], height + 1e-3)]
    assert limits[0] == "floor: end effector"


def test_the_longest_rigid_link_of_ranges_is_the_same_by_samples():
    rigid = replace(ROBOT.rigid_link, d35=Interval(0.44, 0.46), d45=Interval(0.45, 0.47))
    robot = replace(ROBOT, rigid_link=rigid)
    assert longest_rod(robot) == pytest.approx(longest_rigid_link(robot), abs=1e-4)
