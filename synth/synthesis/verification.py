"""The independent check: plain numpy and forward kinematics, through no expression of the solver.

Only this module may say that a target is reached or that a shape respects the limits.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, compared_by_value, frozen
from synth.checks import refuse_unless
from synth.robot import Arm, ArmBody
from synth.rounding import Unit, rounded_up, told_apart
from synth.synthesis.room import LENGTH_SLACK, Room, chosen_joints
from synth.task import Task, Topology

if TYPE_CHECKING:
    from synth.robot import BasePose, Interval

_ANGLE_SLACK = 1e-6  # what rounding may do, rad


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


@compared_by_value
@dataclass(frozen=True, eq=False)
class Verification:
    """What a shape really does for a task.

    Attributes:
        joints: Best joint angles (theta1, theta2) for each target, shape (n, 2), rad.
        reached: P5 at these angles in the task frame, shape (n, 3), m.
        misses: Distance of P5 from each target, shape (n,), m.
        within_tolerance: Whether each target is reached, shape (n,).
        gamma_residuals: |Gamma(P5)| over the sum of its terms' magnitudes, shape (n,): that P5 lies
            on the published surface, too; about 1e-12.
        clearances: How far the arm at least keeps from the obstacles at each target, shape (n,), m;
            no more than 0.1 m is looked for, and without obstacles it is infinite.
        violations: Limits that the shape breaks; empty for a shape that the hardware can take.
        unseen: How many more targets are asked for that were not looked at, for lack of time: with any, no
            shape counts as found.
    """

    joints: FloatArray
    reached: FloatArray
    misses: FloatArray
    within_tolerance: tuple[bool, ...]
    gamma_residuals: FloatArray
    clearances: FloatArray
    violations: tuple[Violation, ...]
    unseen: int = 0

    @property
    def possible(self) -> bool:
        """Whether the hardware can take the shape."""
        return not self.violations

    @property
    def found(self) -> bool:
        """Whether the shape is possible and reaches every target within its tolerance."""
        return self.possible and all(self.within_tolerance) and not self.unseen


def verify(task: Task, arm: Arm, joints: FloatArray | None = None, *, keep: bool = False) -> Verification:
    """Check a shape against a task.

    Everything is seen from the base of the arm, and from nowhere else; an arm that stands elsewhere than
    the task says breaks a limit by that alone.

    Args:
        task: The task.
        arm: The robot in the shape.
        joints: Joint angles to consider beside the closest ones and the branches of the inverse
            kinematics, shape (n, 2), rad: at the closest point the arm may be in the way of something.
        keep: Whether the arm shall stand at these angles wherever they reach the target within its
            tolerance, and clear of everything, though others come nearer.

    Returns:
        The misses by forward kinematics and every limit that is broken.
    """
    refuse_unless("task", task, Task)
    refuse_unless("arm", arm, Arm)
    chosen, sunk, room = chosen_joints(task, arm, joints, keep=keep)
    reached = arm.forward_kinematics(chosen[:, 0], chosen[:, 1])
    blocked = sunk | ~room.clear
    misses = np.linalg.norm(reached - task.table.positions, axis=-1)
    within = (misses <= task.tolerances) & ~blocked
    return Verification(
        joints=frozen(chosen),
        reached=frozen(reached),
        misses=frozen(misses),
        within_tolerance=tuple(bool(value) for value in within),
        gamma_residuals=frozen(arm.surface.residual(arm.base.to_base(reached))),
        clearances=frozen(room.from_obstacles.min(axis=(-2, -1), initial=math.inf)),
        violations=(
            *_base_violations(task.base, arm.base),
            *_length_violations(arm),
            *_bend_violations(arm),
            *_joint_violations(arm, chosen),
            *_floor_violations(task, arm, arm.base.to_base(reached)[:, 2]),
            *_topology_violations(task, arm),
            *_obstacle_violations(task, room),
            *_self_violations(task, room),
        ),
    )


def _exceeds(limit: str, value: float, bound: float, slack: float, sentence: str) -> list[Violation]:
    """Return a violation if `value` is above `bound`; NaN violates everything."""
    if value <= bound + slack:
        return []
    return [Violation(limit, value - bound, sentence)]


def _outside(interval: Interval, values: FloatArray | float) -> float:
    """Return how far the worst of the values is outside the interval; negative for all inside."""
    return float(np.max(np.maximum(interval.lower - values, values - interval.upper), initial=-math.inf))


def _base_violations(asked: BasePose, stands: BasePose) -> list[Violation]:
    moved = float(np.linalg.norm(stands.position - asked.position))
    turned = abs(math.remainder(stands.yaw - asked.yaw, 2.0 * math.pi))
    return [
        *_exceeds(
            "base: position", moved, 0.0, LENGTH_SLACK,
            f"the arm stands {1e3 * moved:.4g} mm from where the task puts it",
        ),
        *_exceeds(
            "base: yaw", turned, 0.0, _ANGLE_SLACK,
            f"the arm stands turned by {math.degrees(turned):.4g} deg from how the task puts it",
        ),
    ]  # fmt: skip


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
            "max_total_bend", shape.total_bend, link.max_total_bend, _ANGLE_SLACK,
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
            name, worst, 0.0, _ANGLE_SLACK,
            f"the {name} would have to turn {rounded_up(worst, Unit.DEG, 2)} deg beyond its limit",
        )  # fmt: skip
    return violations


def _floor_violations(task: Task, arm: Arm, end_effector: FloatArray) -> list[Violation]:
    if task.floor is None:
        return []
    body = ArmBody(arm)
    heights = {
        "link": body.lowest(),
        "second joint": float(arm.axis_points[2:, 2].min()),
        "end effector": float(np.min(end_effector, initial=math.inf)) - body.rod_radius,
    }
    violations = []
    for part, height in heights.items():
        depth = task.floor - height
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
            amount, slack = off.scara, _ANGLE_SLACK
        case Topology.GENERAL:
            amount, slack = float(arm.category.value != "general"), 0.0
        case Topology.ANY:
            return []
    return _exceeds(
        "topology", amount, 0.0, slack, f"the shape is not {task.topology.value}, which the task asks for"
    )


def _obstacle_violations(task: Task, room: Room) -> list[Violation]:
    """Check that tube and rod keep clear of the obstacles at each target: one violation for each."""
    violations = []
    least = room.from_obstacles.min(axis=(-2, -1), initial=math.inf)
    for index in np.flatnonzero(~(least >= -LENGTH_SLACK)).tolist():
        clearances = room.from_obstacles[index]
        worst, part = np.unravel_index(np.argmin(clearances), clearances.shape)
        obstacle, depth = task.obstacles[worst].name, -float(clearances[worst, part])
        violations += _exceeds(
            f"obstacle: {obstacle}", depth, 0.0, LENGTH_SLACK,
            f"at {task.table.names[index]} the {('malleable', 'rigid')[part]} link would be "
            f"{rounded_up(depth, digits=2)} mm inside {obstacle}",
        )  # fmt: skip
    return violations


def _self_violations(task: Task, room: Room) -> list[Violation]:
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
