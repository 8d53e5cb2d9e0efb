"""The joints of arms as they stand: angles that come closest to targets, and what they cannot take up."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from synth.measurement.markers.standing_arm import onto_vertical
from synth.robot import Kinematics, closest_joints, turned

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.measurement.markers.standing_arm import StandingArm

_STEPS = 8  # of `joints_following`
_FARTHEST = 0.3  # rad, of a joint in one step
_DAMPING = 1e-7  # m^2; keeps folded and stretched postures, where P5 cannot move, finite


def left_to_joints(
    arm: StandingArm, joints: FloatArray, targets: FloatArray
) -> tuple[FloatArray, FloatArray, NDArray[np.bool_]]:
    """Return misses, the velocities by which joints can lessen them, and which joints are held.

    Args:
        arm: The arm, or arms; of many each has the same targets.
        joints: Shape (..., n, 2), rad.
        targets: Shape (n, 3), m.

    Returns:
        Misses, shape (..., n, 3), m; velocities, (..., n, 3, 2), m/rad, zero for a joint that a limit
        holds; whether it does, shape (..., n, 2).
    """
    reached, velocities = arm.velocities(joints)
    miss = reached - targets
    slope = np.einsum("...ij,...i->...j", velocities, miss)
    lower = np.array([arm.limits.base.lower, arm.limits.second.lower])
    upper = np.array([arm.limits.base.upper, arm.limits.second.upper])
    held = ((joints <= lower) & (slope > 0.0)) | ((joints >= upper) & (slope < 0.0))
    return miss, np.where(held[..., None, :], 0.0, velocities), held


def joints_following(
    arm: StandingArm, joints: FloatArray, targets: FloatArray, steps: int = _STEPS
) -> FloatArray:
    """Return the joint angles that come closest to targets, near those given and within the limits.

    Args:
        arm: The arm, or arms; of many each has the same targets.
        joints: Angles to begin with, shape (n, 2) or (..., n, 2), rad.
        targets: Shape (n, 3), m.
        steps: Gauss-Newton steps.

    Returns:
        Angles, shape (..., n, 2), rad; never worse ones than those given.
    """
    lower = np.array([arm.limits.base.lower, arm.limits.second.lower])
    upper = np.array([arm.limits.base.upper, arm.limits.second.upper])
    joints = np.clip(np.broadcast_to(joints, (*arm.end.shape[:-1], *joints.shape[-2:])), lower, upper)
    best, least = joints, np.full(joints.shape[:-1], np.inf)
    for _ in range(steps + 1):
        miss, free, held = left_to_joints(arm, joints, targets)
        squared = np.einsum("...i,...i", miss, miss)
        better = squared < least
        best, least = np.where(better[..., None], joints, best), np.where(better, squared, least)
        first, second = free[..., 0], free[..., 1]
        a = np.einsum("...i,...i", first, first) + _DAMPING
        b = np.einsum("...i,...i", first, second)
        c = np.einsum("...i,...i", second, second) + _DAMPING
        f, g = np.einsum("...i,...i", first, miss), np.einsum("...i,...i", second, miss)
        step = np.stack([b * g - c * f, b * f - a * g], axis=-1) / (a * c - b * b)[..., None]
        step = np.where(held, 0.0, np.clip(step, -_FARTHEST, _FARTHEST))
        joints = np.clip(joints + step, lower, upper)
    return best


def joints_closest_to(arm: StandingArm, targets: FloatArray) -> FloatArray:
    """Return the joint angles within the limits that come closest to targets, of one arm.

    Args:
        arm: The arm.
        targets: Shape (n, 3), m.

    Returns:
        Angles, shape (n, 2), rad.
    """
    onto_z = onto_vertical(arm.direction)
    frame = turned((onto_z @ arm.frame).T, -arm.joint1).T
    centre = turned(onto_z @ (arm.centre - arm.point), -arm.joint1)
    kinematics = Kinematics(frame, centre, np.asarray(arm.radius))
    joints, _ = closest_joints(kinematics, (targets - arm.point) @ onto_z.T, arm.limits)
    return joints
