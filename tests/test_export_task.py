"""The task in `solution.json`: whole, so that the file alone rebuilds and verifies the shape."""

import math
from dataclasses import replace

import numpy as np
from written import NOTHING, SOLUTION, read_back

from synth.export import solution_json
from synth.geometry import Box, Capsule, Sphere
from synth.robot import (
    Arm,
    BasePose,
    Interval,
    JointLimits,
    LinkShape,
    MalleableLink,
    RigidLink,
    Robot,
)
from synth.synthesis import Design, verify
from synth.task import Objective, Obstacle, PointTarget, Task, Topology


def solid_of(obstacle):
    """The solid of an obstacle of the file, by its contract."""
    if "box" in obstacle:
        box = obstacle["box"]
        return Box(box["center"], box["size"], box["yaw"])
    if "sphere" in obstacle:
        return Sphere(obstacle["sphere"]["center"], obstacle["sphere"]["radius"])
    capsule = obstacle["capsule"]
    return Capsule([capsule["from"], capsule["to"]], capsule["radius"])


def task_of(content):
    """The task of a solution, rebuilt from the file alone."""
    task = content["task"]
    robot, link, rigid, limits = (
        task["robot"], task["robot"]["link"], task["robot"]["rigid_link"], task["robot"]["joint_limits"]
    )  # fmt: skip
    most = math.inf if link["max_total_bend"] is None else link["max_total_bend"]
    return Task(
        task["name"],
        Robot(
            robot["name"],
            robot["d12"],
            MalleableLink(Interval(*link["length"]), link["min_bend_radius"], link["diameter"], most),
            robot["d34"],
            robot["tip_offset"],
            RigidLink(Interval(*rigid["d35"]), Interval(*rigid["d45"]), rigid["diameter"]),
            JointLimits(Interval(*limits["base"]), Interval(*limits["second"])),
        ),
        tuple(PointTarget(t["name"], t["position"], t["tolerance"], t["weight"]) for t in task["targets"]),
        BasePose(task["base"]["position"], task["base"]["yaw"]),
        task["floor"],
        Topology(task["topology"]),
        Objective(task["objective"]),
        tuple(Obstacle(each["name"], solid_of(each)) for each in task["obstacles"]),
    )


def test_the_file_alone_rebuilds_the_task_and_the_shape_and_verifies_it():
    obstacles = (
        Obstacle("shelf", Box([0.9, 0.2, 0.5], [0.1, 0.4, 0.2], 0.3)),
        Obstacle("ball", Sphere([-0.9, 0.2, 0.5], 0.05)),
        Obstacle("pipe", Capsule([[0.0, 0.9, 0.0], [0.0, 0.9, 1.0]], 0.04)),
    )
    task = replace(SOLUTION.task, obstacles=obstacles, topology=Topology.GENERAL, objective=Objective.MINIMAX)
    arm = SOLUTION.robot
    design = Design(arm, verify(task, arm))
    content = read_back(replace(SOLUTION, task=task, designs=(design,)))
    again = task_of(content)
    assert again.robot == task.robot
    arcs = content["link"]["arcs"]
    shape = LinkShape([arc["curvature"] for arc in arcs], [arc["length"] for arc in arcs])
    check = verify(
        again, Arm(again.robot, shape, content["distances"]["35"], content["distances"]["45"], again.base)
    )
    assert check.found == design.verification.found
    np.testing.assert_allclose(check.misses, design.verification.misses, atol=1e-12)
    np.testing.assert_allclose(check.clearances, design.verification.clearances, atol=1e-12)
    assert (again.topology, again.objective, again.floor_height) == (
        task.topology,
        task.objective,
        task.floor_height,
    )


def test_the_task_of_a_file_with_its_present_shape_is_whole():
    task = replace(SOLUTION.task, current=SOLUTION.robot.shape)
    content = read_back(replace(SOLUTION, task=task))
    arcs = content["task"]["current"]["arcs"]
    np.testing.assert_array_equal([arc["length"] for arc in arcs], SOLUTION.robot.shape.lengths)
    assert read_back(NOTHING)["task"]["name"] == "crates"


def test_of_very_many_targets_the_worst_are_told_of_and_the_task_is_whole(monkeypatch):
    monkeypatch.setattr(solution_json, "MOST_TARGETS", 2)
    content = read_back(SOLUTION)
    order = np.argsort(-SOLUTION.best.verification.misses / SOLUTION.task.tolerances, kind="stable")
    worst = [SOLUTION.task.targets[index].name for index in sorted(order[:2])]
    assert [target["name"] for target in content["targets"]] == worst
    assert content["targets_left_out"] == 1
    assert len(content["task"]["targets"]) == 3
    assert len(content["alternatives"][0]["targets"]) == 2
    assert len(read_back(NOTHING)["targets"]) == 2
    monkeypatch.undo()
    assert read_back(SOLUTION)["targets_left_out"] == 0
