"""How fast the joints may turn: in the file of a robot, the file of a solution, trajectories and exports."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from planted import planted_task
from task_texts import ROBOT, mistakes_in, write

import synth
from synth import JointRates
from synth.robot import ACCELERATION, SPEED
from synth.task import load_robot
from synth.trajectories import trajectory


@pytest.fixture(scope="module")
def solution():
    found = synth.solve(planted_task(5, 4)[0], alternatives=0)
    assert all(way.found for way in found.best.ways)
    return found


def test_the_limits_are_those_of_the_robot_unless_others_are_given(solution, tmp_path):
    rates = synth.JointRates(speeds=[1.0, 0.4], accelerations=[3.0, 2.0])
    robot = replace(solution.task.robot, joint_rates=rates)
    slow = replace(solution, task=replace(solution.task, robot=robot))
    path = trajectory(slow)
    assert (np.abs(path.velocities) <= rates.speeds + 1e-12).all()
    assert (np.abs(path.accelerations) <= rates.accelerations + 1e-12).all()
    limited = np.abs(path.velocities) > rates.speeds - 1e-9
    limited |= np.abs(path.accelerations) > rates.accelerations - 1e-9
    rests = np.abs(path.velocities).max(axis=1) < 1e-9
    assert (limited.any(axis=1) | rests).mean() > 0.99
    quick = trajectory(slow, speed=[2.0, 0.4])
    assert quick.duration <= path.duration
    assert (np.abs(quick.velocities) <= [2.0 + 1e-12, 0.4 + 1e-12]).all()
    assert trajectory(slow, speed=2.0, acceleration=5.0) == trajectory(solution, speed=2.0, acceleration=5.0)
    slow.export(tmp_path, "urdf", "xrdf")
    assert re.findall(r'velocity="([^"]+)"', (tmp_path / "robot.urdf").read_text()) == ["1.0", "0.4"]
    assert "acceleration_limits: [3.0, 2.0]" in (tmp_path / "robot.xrdf").read_text()
    for name in ("robot.urdf", "robot.xrdf"):
        nominal = next(line for line in (tmp_path / name).read_text().splitlines() if "nominal" in line)
        assert "jerk" in nominal
        assert "25 rpm" not in nominal
        assert "acceleration" not in nominal


def test_speeds_of_the_joints_are_read(tmp_path):
    text = "joint_rates: {base: {max_speed_deg_s: 90}, second: {max_acceleration_deg_s2: 180}}"
    robot = load_robot(write(tmp_path / "robot.yaml", f"{ROBOT}\n{text}\n"))
    assert robot.joint_rates == JointRates([math.pi / 2, SPEED], [ACCELERATION, math.pi])
    assert load_robot("malleable-2dof").joint_rates == JointRates()
    wrong = text.replace("90", "0").replace("max_acc", "max_ac")
    mistakes = mistakes_in(load_robot, write(tmp_path / "robot.yaml", f"{ROBOT}\n{wrong}\n"))
    assert [mistake.key for mistake in mistakes] == [
        "joint_rates.base.max_speed_deg_s",
        "joint_rates.second.max_aceleration_deg_s2",
    ]


def test_a_file_without_speeds_of_the_joints_is_of_the_published_ones(solution):
    content = synth.solution_to_json(solution)
    assert content["task"]["robot"].pop("joint_rates") == {
        "speeds": [SPEED] * 2,
        "accelerations": [ACCELERATION] * 2,
    }
    assert synth.Solution.from_json(content) == solution
    content["task"]["robot"]["joint_rates"] = {"speeds": [1.0], "accelerations": [0.0, "a"]}
    with pytest.raises(synth.InputError) as caught:
        synth.Solution.from_json(content)
    assert [mistake.key for mistake in caught.value.mistakes] == [
        "task.robot.joint_rates.speeds",
        "task.robot.joint_rates.accelerations[0]",
        "task.robot.joint_rates.accelerations[1]",
    ]
