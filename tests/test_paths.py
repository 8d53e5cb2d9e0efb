"""Paths: the curve, the bound of how far P5 strays from it, and shapes that follow it without a jump."""

import math
from dataclasses import replace

import numpy as np
import pytest
from oracle import OracleArm
from planted import ROBOT
from planted_paths import path_task, planted_path

import synth
from synth.errors import InputError
from synth.export import json_bytes, solution_to_json
from synth.geometry import Sphere
from synth.paths import Interpolation, Path
from synth.robot import JointLimits
from synth.synthesis.check import followed, verify, verify_targets
from synth.task import Obstacle
from synth.watch import Watch

CORNERS = np.array([[0.0, 0.0, 0.0], [0.3, 0.0, 0.0], [0.3, 0.1, 0.0], [0.0, 0.1, 0.2]])


def circle(radius, height, count, start=0.0, turn=2.0 * math.pi):
    angles = start + np.linspace(0.0, turn, count, endpoint=turn < 2.0 * math.pi)
    return np.column_stack([radius * np.cos(angles), radius * np.sin(angles), np.full(count, height)])


@pytest.mark.parametrize("closed", [False, True])
@pytest.mark.parametrize("interpolation", Interpolation)
def test_a_path_passes_its_waypoints_and_its_samples_stand_for_all_of_it(interpolation, closed):
    path = Path("p", CORNERS, closed, interpolation)
    assert np.abs(path.at(path.ends[:4]) - CORNERS).max() < 1e-12
    assert np.linalg.norm(path.at(path.ends[-1]) - CORNERS[0 if closed else -1]) < 1e-12
    fine = path.at(np.linspace(0.0, path.ends[-1], 20_001))
    assert path.length == pytest.approx(np.linalg.norm(np.diff(fine, axis=0), axis=1).sum(), rel=1e-4)
    away = np.linalg.norm(fine[:, None] - path.samples[None], axis=-1).min(axis=1)
    assert away.max() < 0.75 * path.length / len(path.samples)
    assert path.shares.sum() == pytest.approx(len(path.samples))
    straight = np.linalg.norm(np.diff(CORNERS, axis=0), axis=1).sum()
    assert (path.length > straight) or not (closed or interpolation is Interpolation.SPLINE)


@pytest.mark.parametrize("interpolation", Interpolation)
def test_second_derivatives_agree_with_differences(interpolation):
    path = Path("p", CORNERS, closed=True, interpolation=interpolation)
    u, step = path.parameters(50), 1e-4
    for place, row in ((0.25, 0.75), (0.75, 0.25)):
        at = (1.0 - place) * u[:-1] + place * u[1:]
        differences = (path.at(at + step) - 2.0 * path.at(at) + path.at(at - step)) / step**2
        both = path.second_derivatives(u)
        assert np.abs(row * both[:, 0] + (1.0 - row) * both[:, 1] - differences).max() < 1e-4


def test_every_mistake_of_a_path_is_told_at_once():
    with pytest.raises(InputError) as error:
        Path("p", [[0, 0, 0], [0, 0, 0], [1, 0, 0]], tolerance=-1.0, speed=0.0, interpolation="splines")
    assert [mistake.key for mistake in error.value.mistakes] == [
        "interpolation",
        "tolerance",
        "speed",
        "waypoints[1]",
    ]


def strays(arm, path, told, parts=7):
    """Return how far P5 is off where it should be, on a grid finer than the joint angles told, m."""
    oracle = OracleArm.of(arm)
    u = np.interp(told.lengths, path.lengths(fine := path.parameters(50_000)), fine)
    assert np.abs(path.at(u) - told.points).max() < 1e-6
    shares = np.arange(parts) / parts
    joints = (told.joints[:-1, None] + shares[:, None] * np.diff(told.joints, axis=0)[:, None]).reshape(-1, 2)
    along = (u[:-1, None] + shares * np.diff(u)[:, None]).ravel()
    return np.linalg.norm(oracle.reached(joints) - path.at(along), axis=-1)


@pytest.mark.parametrize("spline", [False, True])
@pytest.mark.parametrize("seed", [0, 2])
def test_a_planted_path_is_followed_without_a_jump_and_strays_by_no_more_than_told(seed, spline):
    task, _ = planted_path(seed, spline=spline, speed=0.05)
    solution = synth.solve(task, alternatives=0)
    assert solution.found
    (told,) = solution.best.verification.followed
    off = strays(solution.robot, task.paths[0], told)
    assert off.max() <= told.largest <= 1.1 * off.max()
    assert told.largest <= told.tolerance
    assert np.abs(np.diff(told.joints, axis=0)).max() < 0.1
    assert solution.robot.robot.joint_limits.contain(told.joints).all()
    assert told.lengths[-1] == pytest.approx(task.paths[0].length, rel=1e-5)
    assert told.times[-1] == pytest.approx(told.lengths[-1] / 0.05)
    assert "followed in one go" in str(solution)
    assert "point 7" not in str(solution)


ALL_ROUND = replace(ROBOT, joint_limits=JointLimits())


def round_arm(seed=2):
    """Return an arm whose joints turn all round, and radius, height and angle of a point that it reaches."""
    arm = replace(planted_path(seed)[1], robot=ALL_ROUND)
    point = arm.forward_kinematics(0.0, 2.5)
    return arm, math.hypot(point[0], point[1]), point[2], math.atan2(point[1], point[0])


def test_a_jump_of_joint_1_is_no_way_however_near_the_points_are():
    arm, radius, height, zero = round_arm()
    seam = circle(radius, height, 200, start=zero - 0.99 * math.pi, turn=1.98 * math.pi)
    across = circle(radius, height, 200, start=zero + 0.5 * math.pi, turn=math.pi)
    all_round = Path("p", circle(radius, height, 200), closed=True)
    for path, met in ((Path("p", seam), True), (Path("p", across), False), (all_round, False)):
        task = path_task("t", ALL_ROUND, path)
        assert verify_targets(task, arm).found  # by its samples alone
        assert verify(task, arm).found is met
        told = followed(task, arm, path, Watch())
        assert told.met is met
        if not met:
            assert "the joints would have to jump from (" in told.sentence
            assert len(told.breaks) == 2
    # Joint 1 stands in its seam: theta1 is -pi and pi.
    opposite = radius * np.array([-math.cos(zero), -math.sin(zero)])
    assert np.linalg.norm(told.breaks[:, :2] - opposite, axis=1).max() < 0.1 * radius


@pytest.mark.parametrize("closed", [False, True])
def test_a_path_out_of_reach_is_not_followed_and_nothing_breaks(closed):
    arm, radius, height, _ = round_arm()
    path = Path("far", circle(4.0 * radius, height, 8), closed=closed)
    told = followed(path_task("t", ALL_ROUND, path), arm, path, Watch())
    assert not told.met
    assert "it is not reached all along" in told.sentence


def test_what_stands_between_two_samples_of_a_path_is_seen():
    arm, radius, height, zero = round_arm()
    path = Path("p", circle(radius, height, 40, start=zero, turn=math.pi))
    task = path_task("t", ALL_ROUND, path)
    between = 0.5 * (path.samples[60] + path.samples[61])
    outwards = between * [1.0, 1.0, 0.0] / np.linalg.norm(between[:2])
    away = 0.5 * ALL_ROUND.rigid_link.diameter + 0.0003
    bead = Obstacle("bead", Sphere(between + away * outwards, 0.0005))
    blocked = replace(task, obstacles=[bead])
    assert followed(task, arm, path, Watch()).met
    assert verify_targets(blocked, arm).found
    assert not followed(blocked, arm, path, Watch()).met


def test_a_path_across_the_dead_zone_is_met_by_a_link_turned_about_axis_1_or_refused_with_the_reason():
    arm, radius, height, zero = round_arm()
    middle = 0.5 * (ROBOT.joint_limits.base.lower + ROBOT.joint_limits.base.upper) + math.pi
    path = Path("arc", circle(radius, height, 60, start=zero + middle - 0.4, turn=0.8))
    task = path_task("t", ROBOT, path)
    assert not verify(task, replace(arm, robot=ROBOT)).found
    solution = synth.solve(task, alternatives=0)
    assert solution.found
    assert solution.best.verification.followed[0].met
    wide = Path("round", circle(radius, height, 60), closed=True)
    refused = synth.solve(path_task("t", ROBOT, wide), time_limit=5.0, alternatives=0)
    assert not refused.found
    assert "would have to jump" in refused.message or "joint 1 turned farther" in refused.message


def test_a_task_of_two_paths_and_a_target_comes_back_from_its_file(tmp_path):
    task, arm = planted_path(2)
    (tmp_path / "line.csv").write_text(
        "x,y,z\n" + "".join("{:.9g},{:.9g},{:.9g}\n".format(*(1e3 * p)) for p in task.paths[0].waypoints[::8])
    )
    point = (1e3 * arm.forward_kinematics(1.0, 2.5)).tolist()
    (tmp_path / "task.yaml").write_text(
        "synth: 1\nlength_unit: mm\nrobot: malleable-2dof\nfloor: null\n"
        f"targets: [{{position: {point}, tolerance: 2}}]\n"
        "path:\n  - {name: there, csv: line.csv, interpolation: Spline, tolerance: 2, speed: 50}\n"
        f"  - {{waypoints: {(1e3 * task.paths[0].waypoints[:40:4]).tolist()}, tolerance: 2}}\n"
    )
    read = synth.load_task(tmp_path / "task.yaml")
    assert [path.name for path in read.paths] == ["there", "path 2"]
    assert read.is_of_its_own.tolist() == [True] + [False] * (len(read.targets) - 1)
    solution = synth.solve(read, alternatives=0)
    assert solution.found
    (tmp_path / "solution.json").write_bytes(json_bytes(solution_to_json(solution)))
    again = synth.load_solution(tmp_path / "solution.json")
    assert again.task == solution.task
    assert again == solution


@pytest.mark.parametrize("seed", [4, 5])
def test_a_path_of_measured_waypoints_is_followed_where_a_shape_follows_it_within_its_tolerance(seed):
    """The shape of the least sum of squares strays a fifteenth more than it may, the planted one less."""
    task, planted = planted_path(seed, spline=True)
    (path,) = task.paths
    waypoints = path.waypoints + np.random.default_rng([seed, 5]).normal(0.0, 1e-3, path.waypoints.shape)
    tolerance = {4: 2.87e-3, 5: 2.53e-3}[seed]
    measured = path_task("measured", task.robot, replace(path, waypoints=waypoints, tolerance=tolerance))
    assert synth.verify(measured, planted).found
    solution = synth.solve(measured)
    assert solution.found
    assert synth.verify(measured, solution.best.arm).found
