"""The arm that fits a sweep best: damped Gauss-Newton steps on seven numbers, from one start."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from synth.measurement.markers import joints_closest_to, joints_following, rotation_matrix
from synth.robot import Interval, JointLimits

if TYPE_CHECKING:
    from synth.arrays import FloatArray
    from synth.measurement.markers import StandingArm

UNKNOWNS = 7
SMALL = 1e-6  # m and rad, of the differences
_STEPS = 40
_ARRIVED = 1e-7  # m and rad
_NO_BETTER = 1e-4  # of chi-square
_ROUNDS = 6  # in which unknown joints are followed from where they are closest
_AS_CLOSE = 0.99  # of the squared misses: what is closer than this is on another branch
_ONE_TURN = JointLimits(Interval(0.0, 2.0 * math.pi), Interval(0.0, 2.0 * math.pi))
_ANY_TURN = JointLimits(Interval(-1e3, 1e3), Interval(-1e3, 1e3))


def changed(arm: StandingArm, by: FloatArray) -> StandingArm:
    """Return an arm with its circle changed, (..., 7): centre (m), rotation about it (rad), radius (m)."""
    turn = rotation_matrix(by[..., 3:6])
    frame = turn @ arm.frame
    centre = arm.centre + by[..., :3]
    return replace(
        arm, frame=frame, end=centre - np.asarray(arm.offset) * frame[..., 0], radius=arm.radius + by[..., 6]
    )


def _misses(
    arm: StandingArm, points: FloatArray, joints: FloatArray | None, near: FloatArray, steps: int = 3
) -> tuple[FloatArray, FloatArray]:
    """Return misses, shape (..., n, 3), m, and the joints there: those given, or the best near some."""
    if joints is None:
        there = joints_following(arm, near, points, steps)
        return arm.forward(there) - points, there
    return arm.forward(np.broadcast_to(joints, (*arm.end.shape[:-1], *joints.shape))) - points, joints


def fit_sweep(
    points: FloatArray, joints: FloatArray | None, arm: StandingArm, sigma: float
) -> tuple[StandingArm, FloatArray, float, FloatArray]:
    """Return the best arm near a start, its information, chi-square, and the misses of the points, m.

    Joints that are unknown are followed from where they are closest at first. Where axes are nearly parallel
    others may be closer in the end: then all is done again from there.
    """
    limits, arm = arm.limits, replace(arm, limits=_ANY_TURN)
    for _ in range(_ROUNDS):
        near = _closest(arm, points) if joints is None else joints
        arm, near = _descended(points, joints, arm, near, sigma)
        if joints is not None:
            break
        followed = np.sum((arm.forward(near) - points) ** 2)
        closest = np.sum((arm.forward(_closest(arm, points)) - points) ** 2)
        if closest > _AS_CLOSE * followed:
            break
    steps = np.vstack([np.zeros(UNKNOWNS), SMALL * np.eye(UNKNOWNS), -SMALL * np.eye(UNKNOWNS)])
    rows, _ = _misses(changed(arm, steps), points, joints, near, 8)
    slope = _slope(rows) / sigma
    information, lengths = slope @ slope.T, np.linalg.norm(rows[0], axis=-1)
    return replace(arm, limits=limits), information, float(np.sum((lengths / sigma) ** 2)), lengths


def _descended(
    points: FloatArray, joints: FloatArray | None, arm: StandingArm, near: FloatArray, sigma: float
) -> tuple[StandingArm, FloatArray]:
    """Return an arm after damped Gauss-Newton steps, and the joints there: known, or followed from some."""
    steps = np.vstack([np.zeros(UNKNOWNS), SMALL * np.eye(UNKNOWNS), -SMALL * np.eye(UNKNOWNS)])
    damping = 1e-3
    for _ in range(_STEPS):
        rows, there = _misses(changed(arm, steps), points, joints, near)
        near = there if joints is not None else there[0]
        miss, slope = rows[0].ravel() / sigma, _slope(rows) / sigma
        information, gradient = slope @ slope.T, slope @ miss
        step = -np.linalg.solve(information + damping * np.eye(UNKNOWNS) / SMALL, gradient)
        step *= min(1.0, 0.3 / max(float(np.abs(step).max()), 1e-30))
        tried = changed(arm, step)
        then, _ = _misses(tried, points, joints, near)
        before, after = float(miss @ miss), float(np.sum(then**2)) / sigma**2
        if after <= before:
            arm, damping = tried, 0.1 * damping
            # Where zeros of joints stay open the steps along them never end; what fits no better has arrived.
            if np.abs(step).max() < _ARRIVED or before - after < _NO_BETTER:
                break
        else:
            damping = 30.0 * max(damping, 1e-12)
            if damping > 1e6:
                break
    return arm, near


def _closest(arm: StandingArm, points: FloatArray) -> FloatArray:
    """Return the joints that come closest to points, whatever the limits, shape (n, 2), rad."""
    return joints_closest_to(replace(arm, limits=_ONE_TURN), points)


def _slope(rows: FloatArray) -> FloatArray:
    """Return the derivative of misses, shape (7, 3 n), from those at small changes either way."""
    ahead, behind = rows[1 : UNKNOWNS + 1], rows[UNKNOWNS + 1 :]
    return np.asarray((ahead - behind).reshape(UNKNOWNS, -1) / (2.0 * SMALL))
