"""How precisely a shape must be held: what an error of axis 2 does to the misses of the targets."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from synth.robot import turned
from synth.synthesis import Displacements, TargetsSeen, displaced, rotations

if TYPE_CHECKING:
    from synth.arrays import FloatArray
    from synth.robot import Arm
    from synth.synthesis import Design
    from synth.task import Task

# A miss below this has no direction but that of rounding: the surface's normal takes its place.
_ON_THE_SURFACE = 1e-6  # m
_AT_A_LIMIT = 1e-6  # rad
_WHOLE_TURN = 2.0 * math.pi - 1e-9  # rad
# A tilt that turns P5 along the surface is bounded by nothing in first order; nobody is off by more than
# this, and a first order says nothing of it.
_NO_RATE = 1e-12  # m/rad
LARGEST_TILT = math.radians(10.0)
# The first order is tried: errors of the size that it allows are made smaller by the share of the slack that
# they take, again and again.
_DIRECTIONS = 96  # of the errors
_TRIED_TARGETS = 100  # on which they are tried: those that are lost first
_TRIALS = 4
_NO_SLACK = 1e-12  # m
# Velocities of P5 this nearly parallel are those of the rim of the workspace, which P5 can leave in two
# directions; on a circle of 0.5 m it begins 0.03 mm inside the rim.
_NEARLY_SINGULAR = 1e-2


@dataclass(frozen=True)
class ShapeTolerance:
    """How far axis 2 may be off before a target is reached no more, for a shape that reaches them all.

    Each number is the size of the smallest error that, alone and in its worst direction, brings some
    target now within its tolerance to the edge of it, with joints 1 and 2 free to make the best of the
    new shape (near the posture they have now). Both effects are linear to first order, so an error of
    both kinds is harmless if each is at most half of its number. Where errors of that size, tried in many
    directions, lose a target all the same, the numbers are smaller. Both are NaN if a target is missed.

    Attributes:
        position: Shift of axis 2, its direction kept, m. No first order here: a shift by d moves the
            whole workspace surface by d, hence position = min (tolerance - miss).
        position_target: Name of the target that is lost first, or empty.
        direction: Tilt of axis 2 about the link's end, rad; to first order, and at most 10 deg.
        direction_target: Name of the target that is lost first, or empty.
    """

    position: float = math.nan
    position_target: str = ""
    direction: float = math.nan
    direction_target: str = ""


def shape_tolerance(task: Task, design: Design) -> ShapeTolerance:
    """Return how precisely axis 2 must stand for a shape that reaches every target to do so.

    Args:
        task: What is asked.
        design: The shape and its misses. That the end effector stays above the floor is not counted.
    """
    check, arm = design.verification, design.arm
    if not check.found:
        return ShapeTolerance()
    slack = task.tolerances - check.misses
    within = np.argsort(slack, kind="stable")
    rates = tilt_rates(arm, task.table.positions, check.joints)
    bounds = np.minimum(slack / np.maximum(rates, _NO_RATE), LARGEST_TILT)
    tilted = int(within[bounds[within].argmin()])
    first = int(within[0])
    position, direction = _tried(task, design, float(slack[first]), float(bounds[tilted]))
    return ShapeTolerance(position, task.targets[first].name, direction, task.targets[tilted].name)


def _tried(task: Task, design: Design, position: float, direction: float) -> tuple[float, float]:
    """Return errors of axis 2 no larger than these, m and rad, that lose no target in any direction tried."""
    check, arm = design.verification, design.arm
    slack = task.tolerances - check.misses
    barely = np.argsort(slack, kind="stable")[:_TRIED_TARGETS]
    aims = TargetsSeen.from_base(task, arm.base, barely)
    rows = task.table.approaches
    room = np.ones(len(slack)) if rows is None else np.nan_to_num(rows[:, 3] - check.astray, nan=1.0)
    angles = np.linspace(0.0, 2.0 * math.pi, _DIRECTIONS, endpoint=False)[:, None]
    across = np.cos(angles) * arm.end_frame[0][:, 1] + np.sin(angles) * arm.end_frame[0][:, 2]
    around = np.random.default_rng(0).normal(size=(_DIRECTIONS, 3))
    around /= np.linalg.norm(around, axis=1, keepdims=True)

    def used(shifts: FloatArray, turns: FloatArray) -> float:
        """Return the largest share of its slack that an error takes from a target."""
        there = displaced(arm, aims, Displacements(shifts, turns))
        lost = (there.misses - check.misses[barely]) / np.maximum(slack[barely], _NO_SLACK)
        beside = there.astray / np.maximum(arm.circle.radius * room[barely], _NO_SLACK)
        return float(max(lost.max(), np.where(there.astray > 0.0, 1.0 + beside, 0.0).max()))

    for _ in range(_TRIALS):
        share = used(position * around, np.broadcast_to(np.eye(3), (_DIRECTIONS, 3, 3)))
        position /= max(share, 1.0)
    for _ in range(_TRIALS):
        share = used(np.zeros((_DIRECTIONS, 3)), rotations(direction * across))
        direction /= max(share, 1.0)
    return position, direction


def tilt_rates(arm: Arm, targets: FloatArray, joints: FloatArray) -> FloatArray:
    """Return the rates at which the misses of targets grow with a tilt of axis 2 in the worst direction.

    At joint 1 = 0, a tilt w (rad, across axis 2) about the link's end p moves P5 by w x (P5 - p). Of
    this only the part along the miss counts, n = (P5 - target) / |P5 - target|, because the joints are
    already where they make the miss least (envelope theorem): d miss / dw = (P5 - p) x n. Where the
    miss is zero, n may be any unit vector across the velocities that the joints can still give P5: the
    normal of the surface inside, a half-plane at a joint limit or the rim.

    Args:
        arm: The robot in its shape.
        targets: The targets in the task frame, shape (n, 3), m.
        joints: Their joint angles (theta1, theta2) with the least misses, shape (n, 2), rad.

    Returns:
        max |(P5 - p) x n . w| over unit tilts w across axis 2 and all such n, shape (n,), m/rad.
    """
    end_effectors = arm.kinematics.forward(0.0, joints[:, 1])
    away = end_effectors - turned(arm.base.to_base(targets), -joints[:, 0])
    misses = np.linalg.norm(away, axis=1)
    off = misses > _ON_THE_SURFACE
    among = np.empty((len(targets), 3, 3))  # projections onto all such n
    among[off] = _dyads(away[off] / misses[off, None])
    among[~off] = _unmoved(arm, end_effectors[~off], joints[~off])
    rotation, end = arm.end_frame
    tilted = np.cross(
        rotation[:, 1:].T, (end_effectors - end)[:, None]
    )  # about the two directions across axis 2
    along = tilted @ among
    first, second = np.square(along).sum(axis=2).T
    # The larger singular value of two rows, by their squares and their product.
    apart = np.hypot(0.5 * (first - second), np.einsum("ni,ni->n", along[:, 0], along[:, 1]))
    return np.asarray(np.sqrt(0.5 * (first + second) + apart))


def _unmoved(arm: Arm, end_effectors: FloatArray, joints: FloatArray) -> FloatArray:
    """Return projections onto the directions, at joint 1 = 0, in which no joint can move P5.

    Args:
        arm: The robot in its shape.
        end_effectors: P5 at theta1 = 0 in the base frame, shape (n, 3), m.
        joints: Joint angles, which tell whether a joint is at a limit, shape (n, 2), rad.

    Returns:
        The projections, shape (n, 3, 3); of rank 1 where the surface is regular and the joints are free.
    """
    limits = arm.robot.joint_limits
    about_axis_1 = np.cross([0.0, 0.0, 1.0], end_effectors)
    about_axis_2 = np.cross(arm.circle.axis, end_effectors - arm.circle.centre)
    velocities = np.stack([about_axis_1, about_axis_2], axis=1)
    for joint, interval in enumerate((limits.base, limits.second)):
        if interval.upper - interval.lower < _WHOLE_TURN:  # a range of a whole turn has ends, but no limits
            inside = (
                np.abs(joints[:, joint] - interval.middle)
                <= 0.5 * (interval.upper - interval.lower) - _AT_A_LIMIT
            )
            velocities[~inside, joint] = 0.0
    _, singular, directions = np.linalg.svd(velocities)
    moved = singular > _NEARLY_SINGULAR * singular.max(axis=1, initial=0.0, keepdims=True)
    return np.asarray(np.eye(3) - np.einsum("nk,nki,nkj->nij", moved, directions[:, :2], directions[:, :2]))


def _dyads(directions: FloatArray) -> FloatArray:
    """Return projections onto unit vectors, shape (n, 3), as (n, 3, 3)."""
    return directions[:, :, None] * directions[:, None]
