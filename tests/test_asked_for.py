"""What is asked of a shape is kept: topology, rigid link, length, floor, joint limits."""

from dataclasses import replace

import numpy as np
import pytest
from planted import ROBOT, feasible, planted_task
from solved import points

from synth.robot import Interval, MalleableLink, RigidLink
from synth.synthesis import NotFoundError, Status, solve
from synth.task import Task, Topology


@pytest.mark.parametrize(
    "topology", [Topology.PUMA, Topology.SCARA, Topology.SPHERICAL], ids=lambda t: t.value
)
def test_a_topology_asked_for_is_exact(topology):
    task, _ = planted_task(8, 4, topology)
    solution = solve(replace(task, topology=topology))
    assert solution.found
    off = solution.robot.category_distances
    assert solution.robot.category.value == topology.value
    assert getattr(off, topology.value) < 1e-6


def test_a_general_shape_asked_for_keeps_off_the_special_categories():
    task, _ = planted_task(9, 3, Topology.PUMA)
    solution = solve(replace(task, topology=Topology.GENERAL))
    assert solution.found
    assert solution.robot.category.value == "general"


def test_a_topology_that_the_targets_contradict_is_not_found():
    task = Task("two heights", ROBOT, points([0.5, 0.0, 0.3], [0.0, 0.5, 0.6]), topology=Topology.SCARA)
    solution = solve(task)
    assert solution.status is Status.BEST_EFFORT
    # A plane between the two misses one of them by at least half their distance in height.
    assert max(target.miss for target in solution.targets) >= 0.15 - 1e-6


def test_a_free_rigid_link_is_designed_within_its_intervals():
    robot = replace(ROBOT, rigid_link=RigidLink(Interval(0.35, 0.50), Interval(0.35, 0.50)))
    short = replace(ROBOT, rigid_link=RigidLink(Interval.fixed(0.38), Interval.fixed(0.385)))
    task, arm = planted_task(10, 8)
    arm = replace(arm, robot=short, d35=0.38, d45=0.385)
    rng = np.random.default_rng(0)
    reached = arm.forward_kinematics(rng.uniform(0.2, 6.0, 40), rng.uniform(1.0, 5.0, 40))
    reached = reached[reached[:, 2] > 0.0][:8]
    solution = solve(replace(task, robot=robot, targets=points(*reached)))
    assert solution.found
    assert robot.rigid_link.d35.contains(solution.robot.d35)
    assert robot.rigid_link.d45.contains(solution.robot.d45)
    assert not solve(replace(task, targets=points(*reached, tolerance=1e-4))).found


def test_a_link_of_one_length_keeps_it():
    fixed = replace(ROBOT, link=MalleableLink(Interval.fixed(0.6), 0.11))
    solution = solve(Task("one", fixed, points([0.5, 0.2, 0.4])))
    assert solution.found
    assert solution.robot.shape.length == pytest.approx(0.6, abs=1e-12)


def test_a_stiff_link_that_cannot_bend_enough_is_not_found():
    stiff = replace(ROBOT, link=MalleableLink(Interval.fixed(0.6), 5.0))
    solution = solve(Task("low", stiff, points([0.4, 0.0, 0.1])))
    assert not solution.found
    assert solution.robot.shape.min_bend_radius >= 5.0 * (1.0 - 1e-9)


def test_the_floor_is_kept_by_link_joint_and_end_effector():
    task = Task("low", ROBOT, points([0.55, 0.1, 0.03], [-0.5, 0.3, 0.05]), floor=0.02)
    solution = solve(task)
    assert solution.found
    assert feasible(solution.robot, floor=0.02 - 1e-6)
    assert all(target.reached[2] >= 0.02 - 1e-6 for target in solution.targets)
    sunk = solve(replace(task, floor=0.04))
    assert sunk.status is Status.PROVEN_IMPOSSIBLE
    assert "below the floor" in sunk.message


def test_a_floor_above_p2_leaves_no_shape_and_says_so():
    solution = solve(Task("deep", ROBOT, points([0.5, 0.0, 0.5]), floor=0.1))
    assert solution.status is Status.PROVEN_IMPOSSIBLE
    assert "below the floor" in solution.message
    assert not solution.designs
    with pytest.raises(NotFoundError):
        _ = solution.robot
    with pytest.raises(NotFoundError):
        _ = solution.targets


def test_the_joint_limits_are_kept():
    solution = solve(planted_task(12, 10)[0])
    joints = np.array([target.joints for target in solution.targets])
    assert ROBOT.joint_limits.contain(joints).all()
