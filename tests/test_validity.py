"""What a planner asks of an arm: Jacobian, manipulability, bounds, validity; in numpy, in CasADi and in C."""

import ctypes
import shutil
import subprocess
from dataclasses import replace

import casadi as ca
import numpy as np
import pytest
from planted import ROBOT, planted_arm, planted_task
from planted_obstacles import brute_curves, planted_with_obstacles

import synth
from synth.errors import InputError
from synth.geometry import Sphere
from synth.robot import (
    Arm,
    ArmBody,
    BasePose,
    LinkShape,
    clear_of_tube,
    keeps_clear,
    tube_clear_of_itself,
)
from synth.synthesis import Design, Solution, Status, Timing, verify

BASE = BasePose([0.1, -0.2, 0.05], 0.7)


@pytest.fixture(scope="module")
def arm():
    return replace(planted_arm(np.random.default_rng(3)), base=BASE)


def random_joints(arm, count, seed=0):
    return np.random.default_rng(seed).uniform(*arm.joint_bounds, (count, 2))


def test_the_jacobian_is_the_derivative_of_the_end_effector(arm):
    joints, step = random_joints(arm, 50), 1e-6
    jacobian = arm.jacobian(joints)
    assert jacobian.shape == (50, 3, 2)
    for joint in range(2):
        shift = step * np.eye(2)[joint]
        ahead, behind = (arm.forward_kinematics(*(joints + sign * shift).T) for sign in (1.0, -1.0))
        np.testing.assert_allclose(jacobian[..., joint], (ahead - behind) / (2 * step), atol=1e-8)


def test_manipulability_is_the_area_of_unit_velocities(arm):
    joints = random_joints(arm, 50)
    j = arm.jacobian(joints)
    area = np.sqrt(np.linalg.det(np.swapaxes(j, -1, -2) @ j))
    np.testing.assert_allclose(arm.manipulability(joints), area, rtol=1e-9)
    straight = Arm(ROBOT, LinkShape([[0.0, 0.0]], [0.6]), 0.455, 0.455)
    assert arm.manipulability([1.0, 2.0]) > 1e-4
    assert straight.manipulability([1.0, np.pi]) < 1e-12  # P5 on axis 1


def test_bounds_are_the_joint_limits(arm):
    limits = arm.robot.joint_limits
    np.testing.assert_array_equal(arm.joint_bounds[:, 0], [limits.base.lower, limits.base.upper])
    np.testing.assert_array_equal(arm.joint_bounds[:, 1], [limits.second.lower, limits.second.upper])


def test_casadi_agrees_with_numpy(arm):
    function = synth.casadi_kinematics(arm)
    for joints in random_joints(arm, 20):
        p5, jacobian = function(joints)
        np.testing.assert_allclose(np.array(p5).ravel(), arm.forward_kinematics(*joints), atol=1e-14)
        np.testing.assert_allclose(np.array(jacobian), arm.jacobian(joints), atol=1e-14)
    symbols = ca.SX.sym("q", 2)
    assert function(symbols)[0].shape == (3, 1)


@pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler")
def test_the_c_code_agrees_with_numpy(arm, tmp_path):
    source, library = tmp_path / "kinematics.c", tmp_path / "kinematics.so"
    source.write_text(synth.kinematics_c_code(arm))
    subprocess.run(["cc", "-O1", "-shared", "-fPIC", "-o", library, source, "-lm"], check=True)  # noqa: S607
    function = ctypes.CDLL(str(library)).kinematics
    pointer = ctypes.POINTER(ctypes.c_double)
    for joints in random_joints(arm, 5):
        given, p5, jacobian = (ctypes.c_double * 2)(*joints), (ctypes.c_double * 3)(), (ctypes.c_double * 6)()
        results = (pointer * 2)(ctypes.cast(p5, pointer), ctypes.cast(jacobian, pointer))
        assert function((pointer * 1)(ctypes.cast(given, pointer)), results, None, None, 0) == 0
        np.testing.assert_allclose(list(p5), arm.forward_kinematics(*joints), atol=1e-14)
        np.testing.assert_allclose(np.reshape(list(jacobian), (2, 3)).T, arm.jacobian(joints), atol=1e-14)


def _gap(task, body, joints):
    """How far samples of tube and rod keep from the obstacles and the floor at a posture, m."""
    tube, rod = brute_curves(body.arm, joints)
    gaps = [0.1]
    for obstacle in task.obstacles:
        gaps.append(obstacle.solid.distance(tube).min() - body.tube_radius)
        gaps.append(obstacle.solid.distance(rod).min() - body.rod_radius)
    if task.floor_in_base is not None:
        gaps.append(body.arm.base.to_base(rod)[:, 2].min() - body.rod_radius - task.floor_in_base)
    return min(gaps)


@pytest.mark.parametrize("scene", ["window", "shelf", "crate"])
def test_clear_postures_are_clear_by_samples_and_the_others_are_not(scene):
    task, arm, _ = planted_with_obstacles(scene, 2)
    joints = random_joints(arm, 400, 1)
    solids = [obstacle.solid for obstacle in task.obstacles]
    clear = keeps_clear(arm, joints, solids, floor=task.floor_in_base)
    assert 0 < clear.sum() < len(clear)
    body = ArmBody(arm)
    gaps = np.array([_gap(task, body, each) for each in joints])
    gaps = np.minimum(gaps, clear_of_tube(body, joints[:, 1]))
    assert (gaps[clear] > -2e-6).all()
    assert (gaps[~clear] < 1e-3).all()


def test_postures_beyond_the_limits_are_not_valid(arm):
    lower, upper = arm.joint_bounds
    middle = 0.5 * (lower + upper)
    wrong = middle + 1.01 * np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]]) * (upper - middle)
    assert not keeps_clear(arm, wrong).any()
    assert keeps_clear(arm, np.empty((0, 2))).shape == (0,)
    assert keeps_clear(arm, middle).shape == ()


def test_a_solid_about_the_base_leaves_nothing_free_and_a_floor_too_high_neither(arm):
    joints = random_joints(arm, 30)
    far = Sphere([5.0, 5.0, 5.0], 0.1)
    assert keeps_clear(arm, joints, [far]).any()
    assert not keeps_clear(arm, joints, [far, Sphere(BASE.position + [0.0, 0.0, 0.1], 0.2)]).any()
    assert not keeps_clear(arm, joints, floor=2.0).any()


def test_a_tube_through_itself_is_never_clear():
    arm = Arm(ROBOT, LinkShape([[9.0, 0.0]], [0.7]), 0.455, 0.460)
    bent = replace(arm, robot=replace(ROBOT, link=replace(ROBOT.link, diameter=0.2)))
    assert tube_clear_of_itself(ArmBody(bent)) < 0.0
    assert not keeps_clear(bent, random_joints(arm, 20)).any()


def test_a_solution_asks_with_all_that_its_task_names():
    task, arm, joints = planted_with_obstacles("window", 2)
    check = verify(task, arm)
    solution = Solution(task, Status.FOUND, "", (), 0, (Design(arm, check),), 0, Timing(0.0, 0.0, 0.0, 0.0))
    assert solution.clear(check.joints).all()
    assert solution.clear(joints).shape == (len(joints),)
    wall = [obstacle.solid for obstacle in task.obstacles]
    grid = random_joints(arm, 300)
    np.testing.assert_array_equal(
        solution.clear(grid), keeps_clear(arm, grid, wall, floor=task.floor_in_base)
    )


def test_a_preset_is_loaded_by_its_name_and_cannot_be_changed():
    assert synth.load_robot("malleable-2dof") is synth.PRESETS["malleable-2dof"]
    with pytest.raises(TypeError):
        synth.PRESETS["malleable-2dof"] = ROBOT
    with pytest.raises(InputError):
        keeps_clear(planted_task(1, 1)[0], [0.0, 0.0])
