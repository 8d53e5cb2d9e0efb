"""Limits that a shape breaks, each as a sentence."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from synth.robot import Arm, ArmBody
from synth.rounding import Unit, rounded_up, told_apart
from synth.synthesis.check.approaches import ANGLE_SLACK
from synth.synthesis.check.clearances import LENGTH_SLACK, Clearances
from synth.task import Task, Topology

if TYPE_CHECKING:
    from synth.arrays import FloatArray
    from synth.robot import Interval


@dataclass(frozen=True)
class Violation:
    """A limit that a shape breaks.

    Attributes:
        limit: Name of the limit.
        amount: By how much, in the unit that the sentence names.
        sentence: What is wrong, for the user.
    """

    limit: str
    amount: float
    sentence: str


def violations(
    task: Task, arm: Arm, joints: FloatArray, reached: FloatArray, room: Clearances
) -> tuple[Violation, ...]:
    """Return every limit that a shape breaks.

    Args:
        task: The task.
        arm: The robot in the shape.
        joints: Joint angles for each target, shape (n, 2), rad.
        reached: P5 at these angles in the task frame, shape (n, 3), m.
        room: The room about the arm there.
    """
    return (
        *_base_violations(task, arm),
        *_length_violations(arm),
        *_bend_violations(arm),
        *_joint_violations(arm, joints),
        *_floor_violations(task, arm, arm.base.to_base(reached)[:, 2]),
        *_topology_violations(task, arm),
        *_obstacle_violations(task, arm, room),
        *_self_violations(task, room),
    )


def _exceeds(limit: str, value: float, bound: float, slack: float, sentence: str) -> list[Violation]:
    """Return a violation if `value` is above `bound`; NaN violates everything."""
    if value <= bound + slack:
        return []
    return [Violation(limit, value - bound, sentence)]


def _outside(interval: Interval, values: FloatArray | float) -> float:
    """Return how far the worst of the values is outside the interval; negative for all inside."""
    return float(np.max(np.maximum(interval.lower - values, values - interval.upper), initial=-math.inf))


def _base_violations(task: Task, arm: Arm) -> list[Violation]:
    asked, stands = task.base, arm.base
    moved = float(np.linalg.norm(stands.position - asked.position))
    turned = stands.turned_from(asked)
    violations = [
        *_exceeds(
            "base: position", moved, 0.0, LENGTH_SLACK,
            f"the arm stands {1e3 * moved:.4g} mm from where the task puts it",
        ),
        *_exceeds(
            "base: turn", turned, 0.0, ANGLE_SLACK,
            f"the arm stands turned by {math.degrees(turned):.4g} deg from how the task puts it",
        ),
    ]  # fmt: skip
    if task.places is not None and not task.places.contains(asked):
        sentence = "the base stands where the task does not allow it"
        violations.append(Violation("base: place", math.inf, sentence))
    return violations


def _length_violations(arm: Arm) -> list[Violation]:
    robot, violations = arm.robot, []
    for name, interval, value in (
        ("link", robot.link.length, arm.shape.length),
        ("d35", robot.rigid_link.d35, arm.d35),
        ("d45", robot.rigid_link.d45, arm.d45),
    ):
        violations += _exceeds(
            f"length: {name}", _outside(interval, value), 0.0, LENGTH_SLACK,
            _of_its_limits(f"the length of {name} would have to be", value, interval),
        )  # fmt: skip
    return violations


def _of_its_limits(would: str, value: float, interval: Interval) -> str:
    limit = interval.upper if value > interval.upper else interval.lower
    told, bound = told_apart(value, limit, digits=2)
    return f"{would} {told} mm; {bound} mm is its {'upper' if value > limit else 'lower'} limit"


def _bend_violations(arm: Arm) -> list[Violation]:
    link, shape = arm.robot.link, arm.shape
    return [
        *_exceeds(
            "min_bend_radius", link.min_bend_radius, shape.min_bend_radius, LENGTH_SLACK,
            "the link would need a bend radius of {} mm; {} mm is its limit".format(
                *told_apart(shape.min_bend_radius, link.min_bend_radius)),
        ),
        *_exceeds(
            "max_total_bend", shape.total_bend, link.max_total_bend, ANGLE_SLACK,
            "the link would have to bend by {} deg in all; {} deg is its limit".format(
                *told_apart(shape.total_bend, link.max_total_bend, Unit.DEG)),
        ),
    ]  # fmt: skip


def _joint_violations(arm: Arm, joints: FloatArray) -> list[Violation]:
    limits = arm.robot.joint_limits
    violations = []
    for name, interval, angles in (
        ("base joint", limits.base, joints[:, 0]),
        ("second joint", limits.second, joints[:, 1]),
    ):
        worst = _outside(interval, angles)
        violations += _exceeds(
            name, worst, 0.0, ANGLE_SLACK,
            f"the {name} would have to turn {rounded_up(worst, Unit.DEG, 2)} deg beyond its limit",
        )  # fmt: skip
    return violations


def _floor_violations(task: Task, arm: Arm, end_effector: FloatArray) -> list[Violation]:
    floor = task.lowest_from(arm.base)
    if floor == -math.inf:
        return []
    body = ArmBody(arm)
    heights = {
        "link": body.lowest(),
        "second joint": float(arm.axis_points[2:, 2].min()),
        "end effector": float(np.min(end_effector, initial=math.inf)) - body.rod_radius,
    }
    violations = []
    for part, height in heights.items():
        depth = floor - height
        violations += _exceeds(
            f"floor: {part}", depth, 0.0, LENGTH_SLACK,
            f"the {part} would be {rounded_up(depth, digits=2)} mm below the floor",
        )  # fmt: skip
    return violations


def _topology_violations(task: Task, arm: Arm) -> list[Violation]:
    """Check the category asked for: axes that meet to 1e-6 m, or are parallel to 1e-6 rad."""
    off = arm.category_distances
    match task.topology:
        case Topology.SPHERICAL:
            amount, slack = off.spherical, LENGTH_SLACK
        case Topology.PUMA:
            amount, slack = off.puma, LENGTH_SLACK
        case Topology.SCARA:
            amount, slack = off.scara, ANGLE_SLACK
        case Topology.GENERAL:
            amount, slack = float(arm.category.value != "general"), 0.0
        case Topology.ANY:
            return []
    return _exceeds(
        "topology", amount, 0.0, slack, f"the shape is not {task.topology.value}, which the task asks for"
    )


def _obstacle_violations(task: Task, arm: Arm, room: Clearances) -> list[Violation]:
    """Check that tube and rod keep clear of the obstacles at each target: one violation for each."""
    violations = []
    least = room.from_obstacles.min(axis=(-2, -1), initial=math.inf)
    for index in np.flatnonzero(~(least >= -LENGTH_SLACK)).tolist():
        clearances = room.from_obstacles[index]
        worst, part = np.unravel_index(np.argmin(clearances), clearances.shape)
        obstacle, depth = task.obstacles_from(arm.base)[worst].name, -float(clearances[worst, part])
        violations += _exceeds(
            f"obstacle: {obstacle}", depth, 0.0, LENGTH_SLACK,
            f"at {task.table.names[index]} the {('malleable', 'rigid')[part]} link would be "
            f"{rounded_up(depth, digits=2)} mm inside {obstacle}",
        )  # fmt: skip
    return violations


def _self_violations(task: Task, room: Clearances) -> list[Violation]:
    violations = _exceeds(
        "itself", -room.tube_from_itself, 0.0, LENGTH_SLACK,
        f"the malleable link would be {rounded_up(-room.tube_from_itself, digits=2)} mm inside itself "
        "or the base",
    )  # fmt: skip
    for index in np.flatnonzero(~(room.rod_from_tube >= -LENGTH_SLACK)).tolist():
        name, depth = task.table.names[index], -float(room.rod_from_tube[index])
        violations += _exceeds(
            "itself", depth, 0.0, LENGTH_SLACK,
            f"at {name} the rigid link would be {rounded_up(depth, digits=2)} mm inside the malleable one",
        )  # fmt: skip
    return violations
