"""What to set once the link is stiff: where the base stands, and where P5 is held.

Shims and a slide move the base; two screws move P5 along axis 2 and change its distance from it. Five
numbers,
sought by damped Gauss-Newton steps so that the targets' misses, joints at their best, are least.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen, frozen_value
from synth.guide.loop.outlook import Outlook, outlook
from synth.measurement import joints_following

if TYPE_CHECKING:
    from synth.measurement import ArmFit, StandingArm
    from synth.robot import Robot
    from synth.task import Task

REACH = 30e-3  # m, either way, unless told
_STEPS = 12  # of Gauss and Newton
_ROUNDS = 3  # of these, with weights that grow with the misses
_SMALL = 1e-5  # m, of the differences
_ARRIVED = 1e-5  # m
# A setting of 10 mm must save 0.1 mm of every miss: whatever does nothing stays as it is.
_EFFORT = 0.01


@frozen_value
class Settings:
    """What to set.

    Attributes:
        base: Shift of the whole robot in its base frame, shape (3,), m.
        along: Shift of P5 along axis 2, from P3 towards P4, m.
        radius: By how much P5 is set farther from axis 2, m.
        d35: Distance of P5 from P3 afterwards, m.
        d45: Distance of P5 from P4 afterwards, m.
        arm: The arm as it stands then.
        outlook: What to expect then, with the joint angles `outlook.joints`.
    """

    base: FloatArray
    along: float
    radius: float
    d35: float
    d45: float
    arm: StandingArm
    outlook: Outlook

    def __post_init__(self) -> None:
        object.__setattr__(self, "base", frozen(self.base))


def with_settings(arm: StandingArm, settings: FloatArray) -> StandingArm:
    """Return an arm with settings, (..., 5), m: base x, y, z, P5 along axis 2, its distance from axis 2."""
    return replace(
        arm,
        point=arm.point + settings[..., :3],
        end=arm.end + settings[..., :3],
        offset=arm.offset + settings[..., 3],
        radius=arm.radius + settings[..., 4],
    )


def best_settings(
    task: Task, robot: Robot, fit: ArmFit, joints: FloatArray, *, base: float = REACH, tool: float = REACH
) -> Settings:
    """Return the settings with which the arm that was measured reaches the targets best.

    Args:
        task: What is asked.
        robot: The hardware.
        fit: The stiff arm.
        joints: Joint angles at the targets to begin with, shape (n, 2), rad.
        base: How far the base can be moved along each of its axes, m; 0 leaves it where it is.
        tool: How far P5 can be moved either way, m; 0 leaves it.
    """
    reach = np.array([base] * 3 + [tool] * 2)
    weights = task.tolerances.min() / task.tolerances
    values = np.zeros(5)
    best, least = values, np.inf
    for _ in range(_ROUNDS):
        values, joints = _least_squares(fit.arm, values, reach, joints, task.positions_in_base, weights)
        arm = with_settings(fit.arm, values)
        misses = np.linalg.norm(arm.forward(joints) - task.positions_in_base, axis=-1) / task.tolerances
        if misses.max() < least:
            best, least = values, float(misses.max())
        # Lawson (1961): weights that grow with the miss lead to the least largest one.
        weights = weights * np.sqrt(misses / misses.mean()) if misses.mean() > 1e-6 else weights
    arm = with_settings(fit.arm, best)
    joints = joints_following(arm, joints, task.positions_in_base)
    then = outlook(replace(fit, arm=arm), joints, task.positions_in_base, task.tolerances)
    from_p3 = arm.offset + robot.tip_offset
    d35, d45 = np.hypot(from_p3, arm.radius), np.hypot(robot.d34 - from_p3, arm.radius)
    return Settings(best[:3], float(best[3]), float(best[4]), float(d35), float(d45), arm, then)


def _least_squares(
    arm: StandingArm,
    values: FloatArray,
    reach: FloatArray,
    joints: FloatArray,
    targets: FloatArray,
    weights: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """Return settings within reach with the least weighted sum of squared misses, and the joints there."""

    def residuals(at: FloatArray, start: FloatArray) -> tuple[FloatArray, FloatArray]:
        there = with_settings(arm, at)
        angles = joints_following(there, start, targets, 4)
        miss = (there.forward(angles) - targets) * weights[:, None]
        return np.concatenate([miss.reshape(*at.shape[:-1], -1), _EFFORT * at], axis=-1), angles

    free, damping = reach > 0.0, 1e-4
    steps = np.vstack([np.zeros(5), _SMALL * np.eye(5)[free]])
    for _ in range(_STEPS):
        rows, angles = residuals(values + steps, joints)
        now, joints, slope = rows[0], angles[0], (rows[1:] - rows[0]) / _SMALL
        step = np.zeros(5)
        step[free] = -np.linalg.solve(slope @ slope.T + damping * np.eye(len(slope)), slope @ now)
        tried = np.clip(values + step, -reach, reach)
        then, angles = residuals(tried, joints)
        if then @ then >= now @ now:
            damping *= 10.0
            continue
        arrived = bool(np.abs(tried - values).max() < _ARRIVED)
        values, joints, damping = tried, angles, max(0.2 * damping, 1e-8)
        if arrived:
            break
    return values, joints
