"""Planted tasks with one limit taken just beyond what they need, so that it blocks them."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from planted import ROBOT, feasible, planted_arm

from synth.geometry import Sphere
from synth.robot import Arm, ArmBody, Interval, LinkShape, clear_of_tube
from synth.task import Obstacle, PointTarget, Task

if TYPE_CHECKING:
    from collections.abc import Callable

TOLERANCE = 0.5e-3


def _task(arm: Arm, joints: np.ndarray, **changes: object) -> Task:
    points = arm.forward_kinematics(*joints.T)
    targets = tuple(PointTarget(f"target {i + 1}", p, TOLERANCE) for i, p in enumerate(points))
    return Task("blocked", arm.robot, targets, **changes)


def _joints(rng: np.random.Generator, arm: Arm, count: int) -> np.ndarray:
    """Return joint angles within the limits at which P5 is above the floor and the rod off the tube."""
    limits = arm.robot.joint_limits
    joints = np.column_stack(
        [rng.uniform(i.lower, i.upper, 60 * count) for i in (limits.base, limits.second)]
    )
    free = (arm.forward_kinematics(*joints.T)[:, 2] > 0.03) & (clear_of_tube(ArmBody(arm), joints[:, 1]) > 0)
    return joints[free][:count]


def _bent(rng: np.random.Generator, gentleness: float, tightness: float) -> Arm:
    """Return a feasible arm with the bends of its five arcs between two shares of the largest curvature."""
    while True:
        bends = rng.uniform(gentleness, tightness, 5) * ROBOT.link.max_curvature
        turns = rng.uniform(0, 2 * np.pi) + np.cumsum(rng.normal(scale=0.6, size=5))
        curvatures = bends[:, None] * np.column_stack([np.cos(turns), np.sin(turns)])
        length = rng.uniform(ROBOT.link.length.lower, ROBOT.link.length.upper)
        arm = Arm(ROBOT, LinkShape(curvatures, np.full(5, length / 5)), 0.455, 0.46)
        if feasible(arm):
            return arm


def too_short(rng: np.random.Generator) -> Task:
    """The link's end is nearly as far from P2 as the link is long; the robot's is 4 mm shorter."""
    arm = _bent(rng, 0.0, 0.1)
    chord = float(np.linalg.norm(arm.shape.end_frame()[1]))
    link = replace(ROBOT.link, length=Interval(0.3, chord - 4e-3))
    return replace(_task(arm, _joints(rng, arm, 8)), robot=replace(ROBOT, link=link))


def too_stiff(rng: np.random.Generator) -> Task:
    """The link is bent as tight as it can everywhere; the robot's least radius is 8 mm larger."""
    arm = _bent(rng, 0.97, 1.0)
    link = replace(ROBOT.link, min_bend_radius=0.118, length=Interval(0.55, arm.shape.length + 0.02))
    return replace(_task(arm, _joints(rng, arm, 8)), robot=replace(ROBOT, link=link))


def too_little_bend(rng: np.random.Generator) -> Task:
    """The link turns far in one plane; the robot's may bend 8 deg less in all."""
    arm = _bent(rng, 0.4, 0.8)
    frame, _ = arm.shape.end_frame()
    # No curve from the vertical to the tangent at the end turns less than the angle between them.
    least = float(np.arccos(np.clip(frame[2, 2], -1, 1)))
    link = replace(ROBOT.link, max_total_bend=min(arm.shape.total_bend, least + 0.3) - np.radians(8))
    return replace(_task(arm, _joints(rng, arm, 8)), robot=replace(ROBOT, link=link))


def joint_1_too_short(rng: np.random.Generator) -> Task:
    """The targets need a range of joint 1 that is 6 deg wider than it is."""
    arm = planted_arm(rng)
    joints = _joints(rng, arm, 8)
    low, high = joints[:, 0].min() + np.radians(3), joints[:, 0].max() - np.radians(3)
    limits = replace(ROBOT.joint_limits, base=Interval(low, high))
    return replace(_task(arm, joints), robot=replace(ROBOT, joint_limits=limits))


def joint_2_too_short(rng: np.random.Generator) -> Task:
    """The targets need a range of joint 2 that is 6 deg wider than it is.

    Where the range lies does not matter: the link may end in any direction across axis 2.
    """
    arm = planted_arm(rng)
    joints = _joints(rng, arm, 8)
    second = Interval(joints[:, 1].min() + np.radians(3), joints[:, 1].max() - np.radians(3))
    limits = replace(ROBOT.joint_limits, second=second)
    return replace(_task(arm, joints), robot=replace(ROBOT, joint_limits=limits))


def floor_too_high(rng: np.random.Generator) -> Task:
    """The lowest target is 5 mm below the floor, or the link would be."""
    arm = planted_arm(rng)
    task = _task(arm, _joints(rng, arm, 8))
    return replace(task, floor=min(float(task.positions_in_base[:, 2].min()) + 5e-3, ROBOT.d12 - 1e-3))


def obstacle_in_the_way(rng: np.random.Generator) -> Task:
    """A ball is in the way of the rod at the first target, or about the target, 5 mm too large."""
    arm = planted_arm(rng)
    joints = _joints(rng, arm, 8)
    task, body = _task(arm, joints), ArmBody(arm)
    share, theta1 = rng.choice([0.6, 1.0]), joints[0, 0]
    point = body.rod(np.array([share * body.rod_length]), joints[:1, 1])[0]
    c, s = np.cos(theta1), np.sin(theta1)
    point = np.array([c * point[0] - s * point[1], s * point[0] + c * point[1], point[2]])
    direction = rng.normal(size=3)
    centre = point + 0.03 * direction / np.linalg.norm(direction)
    return replace(task, obstacles=(Obstacle("ball", Sphere(centre, 0.035)),))


BLOCKED = {
    "link length": too_short,
    "bend radius": too_stiff,
    "total bend": too_little_bend,
    "joint 1": joint_1_too_short,
    "joint 2": joint_2_too_short,
    "floor": floor_too_high,
    "obstacle: ball": obstacle_in_the_way,
}


def with_others_relaxed(task: Task, limit: str) -> Task:
    """Return the task with all limits but one relaxed by some percent, some degrees, a centimetre."""
    link, limits = task.robot.link, task.robot.joint_limits
    some = {
        "link length": {"length": Interval(0.97 * link.length.lower, 1.03 * link.length.upper)},
        "bend radius": {"min_bend_radius": 0.97 * link.min_bend_radius},
        "total bend": {"max_total_bend": 1.04 * link.max_total_bend},
    }
    link = replace(link, **{k: v for name, each in some.items() if name != limit for k, v in each.items()})
    few = np.radians(4)
    ranges = {"joint 1": ("base", limits.base), "joint 2": ("second", limits.second)}
    limits = replace(
        limits,
        **{k: Interval(i.lower - few, i.upper + few) for name, (k, i) in ranges.items() if name != limit},
    )
    floor = task.floor_height
    if limit != "floor" and floor is not None:
        floor -= 0.01
    return replace(task, robot=replace(task.robot, link=link, joint_limits=limits), floor=floor)


def blocked_task(limit: str, seed: int, found: Callable[[Task], bool]) -> Task:
    """Return a task that one limit blocks: not found as it is, nor with the other limits relaxed a little."""
    rng = np.random.default_rng([seed, list(BLOCKED).index(limit)])
    while True:
        task = BLOCKED[limit](rng)
        if not found(task) and not found(with_others_relaxed(task, limit)):
            return task
