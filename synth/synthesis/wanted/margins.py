"""How far a shape keeps from the limits of the hardware, and how far it should.

At its limit a joint stops, a link tears or buckles, an arm grazes: whatever a hand then does wrong goes one
way only. So a shape some way off its limits is worth more than a miss that is smaller than the tolerance.
"""

from __future__ import annotations

import math
from dataclasses import astuple, dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from synth.robot import Interval, JointLimits

if TYPE_CHECKING:
    from synth.arrays import FloatArray
    from synth.robot import Arm, Robot
    from synth.task import Task

# What should be left.
_JOINT = math.radians(5.0)  # of a joint, at each limit
_LENGTH = 5e-3  # m, of the link's length
_BEND = 0.05  # of bend radius and total bend, as a share
_CLEARANCE = 5e-3  # m, to obstacles
_DIRECTION = 0.5  # of the tolerance of a direction: the rest is for the hand
_PART_OF_RANGE = 0.25  # of a narrow range, at each end no more than this
_ROUNDING = 1e-6  # of a margin


@dataclass(frozen=True)
class Margins:
    """Distances from limits, the least over all targets; where there is no limit, infinite.

    Attributes:
        joint1: Of theta1 from its limits, rad.
        joint2: Of theta2 from its limits, rad.
        length: Of the link's length from its limits, m; infinite if it is fixed.
        bend_radius: Of the smallest bend radius above its limit, m.
        total_bend: Of the total bend below its limit, rad.
        clearance: Of the arm from obstacles at the targets, m; at most 0.1 m is reported.
    """

    joint1: float
    joint2: float
    length: float
    bend_radius: float
    total_bend: float
    clearance: float

    @classmethod
    def of(cls, arm: Arm, joints: FloatArray, clearances: FloatArray) -> Margins:
        """Return the margins of an arm at joint angles, shape (n, 2), rad, with clearances there, (n,), m."""
        link, limits = arm.robot.link, arm.robot.joint_limits
        length = np.array([arm.shape.length])
        return cls(
            _inside(limits.base, joints[:, 0]),
            _inside(limits.second, joints[:, 1]),
            math.inf if link.length.is_fixed else _inside(link.length, length),
            arm.shape.min_bend_radius - link.min_bend_radius,
            link.max_total_bend - arm.shape.total_bend,
            float(np.min(clearances, initial=math.inf)),
        )

    @classmethod
    def wanted(cls, robot: Robot) -> Margins:
        """Return the margins that a shape of a robot should have."""
        link, limits = robot.link, robot.joint_limits
        bend = link.max_total_bend
        return cls(
            _at_most(_JOINT, limits.base),
            _at_most(_JOINT, limits.second),
            _at_most(_LENGTH, link.length),
            _BEND * link.min_bend_radius,
            _BEND * bend if bend < math.inf else 0.0,
            _CLEARANCE,
        )

    def shortfall(self, wanted: Margins) -> float:
        """Return what is missing of the margins wanted, each as a share of it from 0 to 1, summed."""
        pairs = zip(astuple(self), astuple(wanted), strict=True)
        return sum(_missing(have, should) for have, should in pairs)


def joint_shortfalls(robot: Robot, joints: FloatArray) -> FloatArray:
    """Return what postures, shape (..., 2), rad, miss of the margins of the joints, shape (...)."""
    missing = np.zeros(joints.shape[:-1])
    limits = robot.joint_limits
    for interval, angles in ((limits.base, joints[..., 0]), (limits.second, joints[..., 1])):
        should = _at_most(_JOINT, interval)
        have = np.minimum(angles - interval.lower, interval.upper - angles)
        missing += np.clip(1.0 - have / max(should, 1e-12), 0.0, 1.0)
    return missing


def drawn_in(task: Task, *, joints: bool = True, link: bool = True) -> Task:
    """Return a task of a robot whose limits are drawn in by the margins: what keeps them has margins.

    Tube and rod are thicker by the clearance on all sides; directions of arrival are asked for more strictly.

    Args:
        task: The task.
        joints: Whether the ranges of the joints are.
        link: Whether the limits of the link are.
    """
    robot, margins = task.robot, Margins.wanted(task.robot)
    if joints:
        limits = robot.joint_limits
        narrow = JointLimits(_shrunk(limits.base, margins.joint1), _shrunk(limits.second, margins.joint2))
        robot = replace(robot, joint_limits=narrow)
    if link:
        gentle = replace(
            robot.link,
            length=_shrunk(robot.link.length, margins.length),
            min_bend_radius=robot.link.min_bend_radius + margins.bend_radius,
            max_total_bend=robot.link.max_total_bend - margins.total_bend,
            diameter=robot.link.diameter + 2.0 * margins.clearance,
        )
        rigid = replace(robot.rigid_link, diameter=robot.rigid_link.diameter + 2.0 * margins.clearance)
        robot = replace(robot, link=gentle, rigid_link=rigid)
    table = task.table
    if joints and link and table.approaches is not None:
        stricter = table.approaches * np.array([1.0, 1.0, 1.0, _DIRECTION])
        table = replace(table, approaches=stricter)
    return replace(task, robot=robot, targets=table)


def _missing(have: float, should: float) -> float:
    """Return which share of a margin is missing."""
    if should <= 0.0 or have >= (1.0 - _ROUNDING) * should:
        return 0.0
    return min(1.0 - have / should, 1.0)


def _at_most(margin: float, interval: Interval) -> float:
    return min(margin, _PART_OF_RANGE * (interval.upper - interval.lower))


def _shrunk(interval: Interval, margin: float) -> Interval:
    return Interval(interval.lower + margin, interval.upper - margin)


def _inside(interval: Interval, values: FloatArray) -> float:
    """Return how far all of the values are inside an interval."""
    return float(np.min(np.minimum(values - interval.lower, interval.upper - values)))
