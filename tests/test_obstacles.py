"""Tasks with obstacles: found where planted, clear along the whole curve, refused where they cannot be."""

from dataclasses import replace

import numpy as np
import pytest
from oracle import OracleArm
from planted import ROBOT, planted_task
from planted_obstacles import SCENES, planted_with_obstacles

from synth.geometry import Box, Sphere
from synth.robot import Arm, BasePose
from synth.synthesis import Status, solve, verify
from synth.synthesis.nlp.planes import ROD, separations
from synth.task import Obstacle


@pytest.mark.parametrize("scene", SCENES)
@pytest.mark.parametrize("seed", range(3))
def test_planted_arms_are_found_and_keep_clear(scene, seed):
    task, planted, joints = planted_with_obstacles(scene, seed)
    assert verify(task, planted, joints).found
    solution = solve(task)
    assert solution.found
    found = np.array([target.joints for target in solution.targets])
    solids = [obstacle.solid for obstacle in task.obstacles]
    assert OracleArm.of(solution.robot).clearance(found, solids) >= -1e-6


def test_an_obstacle_on_the_planted_arm_is_seen_and_gone_around():
    task, arm = planted_task(7, 3)
    joints, _ = arm.closest_joints(task.positions_in_base)
    middle = arm.shape.point_at(0.6 * arm.shape.length) + [0, 0, ROBOT.d12]
    theta1 = joints[0, 0]
    c, s = np.cos(theta1), np.sin(theta1)
    middle = np.array([c * middle[0] - s * middle[1], s * middle[0] + c * middle[1], middle[2]])
    task = replace(task, obstacles=(Obstacle("ball", Sphere(middle, 0.03)),))
    check = verify(task, arm, joints)
    assert not check.found
    assert check.clearances[0] == pytest.approx(-0.055, abs=1e-4)
    (violation,) = [v for v in check.violations if "target 1" in v.sentence]
    assert violation.sentence == "at target 1 the malleable link would be 55.02 mm inside ball"
    solution = solve(task)
    assert solution.found
    found = np.array([target.joints for target in solution.targets])
    assert OracleArm.of(solution.robot).clearance(found, [task.obstacles[0].solid]) >= -1e-6


def test_a_target_in_an_obstacle_is_impossible():
    task, _ = planted_task(3, 4)
    box = Box(task.positions_in_base[2], np.array([0.1, 0.2, 0.04]), 0.3)
    solution = solve(replace(task, obstacles=(Obstacle("crate", box),)))
    assert solution.status is Status.PROVEN_IMPOSSIBLE
    assert solution.reasons == (
        "target 3 is in crate: there the end effector would be at least 20.0 mm inside",
    )


def test_a_base_in_an_obstacle_is_impossible():
    task, _ = planted_task(3, 4)
    obstacle = Obstacle("table", Box(np.zeros(3), np.array([0.2, 0.2, 0.13])))
    solution = solve(replace(task, obstacles=(obstacle,)))
    assert solution.status is Status.PROVEN_IMPOSSIBLE
    assert solution.reasons[0] == "the link starts at P2, at least 6.9 mm inside table"


def test_planes_leave_the_obstacle_behind_them_and_the_arm_before_them():
    task, arm, joints = planted_with_obstacles("window", 0)
    planes = separations(task, arm, joints, itself=True)
    assert any(plane.piece == ROD for plane in planes)
    for plane in planes:
        assert np.linalg.norm(plane.normal) == pytest.approx(1)
        if plane.other is None:
            behind = [plane.offset - solid.support(plane.normal) for solid in task.solids]
            assert min(np.abs(behind)) < 1e-12


def test_obstacles_stand_in_the_task_frame():
    """A task moved as a whole, base and all, has the same answer."""
    task, arm, joints = planted_with_obstacles("shelf", 1)
    base = BasePose(np.array([0.4, -0.3, 0.2]), 0.8)
    targets = tuple(replace(t, position=base.to_task(t.position)) for t in task.targets)
    # The solid as seen from the frame whose own pose seen from the base is the base's inverse.
    obstacles = tuple(
        replace(o, solid=o.solid.seen_from(base.to_base(np.zeros(3)), base.rotation.T))
        for o in task.obstacles
    )
    moved = replace(task, base=base, targets=targets, obstacles=obstacles)
    there = Arm(arm.robot, arm.shape, arm.d35, arm.d45, base)
    assert verify(moved, there, joints).clearances == pytest.approx(
        verify(task, arm, joints).clearances, abs=1e-9
    )
