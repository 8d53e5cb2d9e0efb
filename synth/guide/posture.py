"""The posture in which the operator holds the arm while bending its link."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from synth.robot import ArmBody, clear_of_obstacles, clear_of_tube

if TYPE_CHECKING:
    from synth.arrays import FloatArray
    from synth.robot import Arm, Interval
    from synth.task import Task

_STRAIGHT_ON = math.pi  # rad: joint 2 with the rigid link straight on from the malleable one
_STEP = 5.0  # deg, between the angles that are tried
# Angles are told in tenths of a degree. So they are tenths: what is printed is what everything stands at, and
# no joint is told an angle just beyond its limit.
_DIGITS = 1
_ROUNDING = 1e-9  # deg


@dataclass(frozen=True)
class HoldPosture:
    """Joint angles to hold while the link is bent.

    Attributes:
        joint1: Angle of joint 1, within its limits, rad.
        joint2: Angle of joint 2, within its limits, rad.
        clear: Whether the arm in its new shape is clear there of the obstacles, the floor and itself.
    """

    joint1: float
    joint2: float
    clear: bool


def hold_posture(task: Task, arm: Arm) -> HoldPosture:
    """Return a posture that the joints can take and in which the arm, once bent, is clear of everything.

    Joint 2 is straight on if that can be, else as near to it as can be. Joint 1 is at 0 if that can be, else
    as near as can be to the middle of its range. If no posture that is tried is clear, it is the first of
    them, and says so.

    Args:
        task: The task, for its obstacles and floor.
        arm: The robot in the shape aimed at.
    """
    limits = task.robot.joint_limits
    first = _by_distance(limits.base, limits.base.middle)
    if limits.base.contains(0.0):
        first = np.concatenate([[0.0], first])
    seconds = _by_distance(limits.second, _STRAIGHT_ON)
    body = ArmBody(arm)
    for second in seconds[_clear_by_itself(task, body, seconds)]:
        joints = np.column_stack([first, np.full(len(first), second)])
        clearances = clear_of_obstacles(body, joints, task.solids).min(axis=(1, 2), initial=math.inf)
        clear = np.flatnonzero(clearances >= body.clear)
        if len(clear):
            return HoldPosture(float(first[clear[0]]), float(second), clear=True)
    return HoldPosture(float(first[0]), float(seconds[0]), clear=False)


def _clear_by_itself(task: Task, body: ArmBody, seconds: FloatArray) -> FloatArray:
    """Return at which angles of joint 2 the rigid link is clear of the floor and of the malleable one."""
    clear = clear_of_tube(body, seconds) >= body.clear
    if task.floor_in_base is not None:
        heights = body.arm.kinematics.forward(0.0, seconds)[:, 2] - body.rod_radius
        clear &= heights >= task.floor_in_base + body.clear
    return np.asarray(clear)


def _by_distance(interval: Interval, wanted: float) -> FloatArray:
    """Return angles all over an interval in tenths of a degree, the nearest to the one wanted first, rad."""
    lower, upper = (math.degrees(limit) for limit in (interval.lower, interval.upper))
    first, last = math.ceil(10.0 * lower - _ROUNDING) / 10.0, math.floor(10.0 * upper + _ROUNDING) / 10.0
    if first > last:  # there is no tenth in so narrow a range
        return np.array([interval.middle])
    nearest = min(max(round(math.degrees(wanted), _DIGITS), first), last)
    below = np.arange(nearest, first - _ROUNDING, -_STEP)
    above = np.arange(nearest, last + _ROUNDING, _STEP)[1:]
    angles = np.radians(np.concatenate([below, above]).round(_DIGITS))
    ordered = angles[np.argsort(np.abs(angles - wanted), kind="stable")]
    return np.asarray(np.clip(ordered, interval.lower, interval.upper))
