"""Where the link's end should go: the nearest pose that meets the task and forgives the hand.

A pose is a displacement of the link's end, a shift and a rotation vector (6 numbers), from where it is. Its
cost is the mean square of what the targets would miss by, joints at their best, over the errors with which
a hand gets there:

    sum over targets of  |m|^2 + s^2 tr(Q) + r^2 |lever x Q|^2,

m the miss that no joint takes up, Q the directions in which no joint moves P5, s and r the errors of position
and direction: a floor, and a share of the displacement itself. The share draws the aim towards the present
pose, along every direction in which the task leaves the shape free; the floor draws it towards shapes whose
rigid link points at the targets along the surface's normal, where a tilt of axis 2 does least.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from synth.measurement import cross, joints_closest_to, joints_following, left_to_joints, rotation_between
from synth.robot import turned

if TYPE_CHECKING:
    from collections.abc import Sequence

    from synth.arrays import FloatArray
    from synth.measurement import Hand, StandingArm
    from synth.robot import Arm

_STEPS = 25
_SMALL = 1e-5  # m and rad, of the differences
_ARRIVED = 1e-5  # m and rad
_LEVER = 0.15  # m; a rotation by 1 rad is as hard for a hand as a shift by this
_NEARLY_SINGULAR = 0.02  # m/rad; P5 that a joint moves more slowly than this counts as held there
_MOST_DESIGNS = 2  # beside the present pose, near which an aim is looked for
_TOO_FAR = 0.15  # m; a shape farther away is no aim of a correction
_FARTHEST = np.repeat([0.05, 0.2], 3)  # m and rad, in one step


def _residuals(
    arm: StandingArm,
    moves: FloatArray,
    joints: FloatArray,
    targets: FloatArray,
    weights: FloatArray,
    hand: Hand,
    share: float,
    steps: int,
) -> tuple[FloatArray, FloatArray]:
    """Return residuals of the cost, (k, r), m, and the joints, (k, n, 2), of displacements (k, 6)."""
    there = arm.moved(moves)
    joints = joints_following(there, joints, targets, steps)
    miss, free, _ = left_to_joints(there, joints, targets)
    first, second = free[..., 0], free[..., 1]
    a = np.einsum("...i,...i", first, first) + _NEARLY_SINGULAR**2
    b = np.einsum("...i,...i", first, second)
    c = np.einsum("...i,...i", second, second) + _NEARLY_SINGULAR**2
    # Q = 1 - V (V^T V)^-1 V^T, of the velocities V that are free.
    inverse = np.stack([np.stack([c, -b], axis=-1), np.stack([-b, a], axis=-1)], axis=-2)
    inverse /= (a * c - b * b)[..., None, None]
    left = np.eye(3) - free @ inverse @ np.swapaxes(free, -1, -2)
    # The lever, turned with joint 1 as P5 is.
    end = there.about_axis_1(there.end[..., None, :], joints[..., 0])
    lever = miss + targets - end
    tilting = [cross(lever, left[..., k]) for k in range(3)]
    shifts = np.sqrt(np.einsum("...ii", left))
    tilts = np.sqrt(sum(np.einsum("...i,...i", each, each) for each in tilting))
    floor = np.array(hand.floor) / np.sqrt(3.0)
    spread = share / np.sqrt(3.0)
    shift_rate = np.sqrt(np.sum((weights * shifts) ** 2, axis=-1))[..., None]
    tilt_rate = np.sqrt(np.sum((weights * tilts) ** 2, axis=-1))[..., None]
    parts = [
        (weights[:, None] * miss).reshape(*miss.shape[:-2], -1),
        floor[0] * weights * shifts,
        floor[1] * weights * tilts,
        spread * shift_rate * moves[..., :3],
        spread * tilt_rate * moves[..., 3:],
    ]
    return np.concatenate(parts, axis=-1), joints


def aimed(
    arm: StandingArm,
    start: FloatArray,
    joints: FloatArray,
    targets: FloatArray,
    weights: FloatArray,
    hand: Hand,
    share: float,
) -> tuple[FloatArray, FloatArray, float]:
    """Return the best displacement of the link's end near a start.

    Args:
        arm: The arm as it stands.
        start: Displacement to begin with, shape (6,), m and rad.
        joints: Angles at the targets to begin with, shape (n, 2), rad.
        targets: Shape (n, 3), m.
        weights: Of the misses, shape (n,).
        hand: The hand.
        share: Error of the displacement as a share of itself.

    Returns:
        The displacement, the joints there, and its cost, m^2.
    """
    move, damping = start, 1e-3
    steps = np.concatenate([np.zeros((1, 6)), _SMALL * np.eye(6)])
    for _ in range(_STEPS):
        values, all_joints = _residuals(arm, move + steps, joints, targets, weights, hand, share, 3)
        joints = all_joints[0]
        slope = (values[1:] - values[0]) / _SMALL
        cost = float(values[0] @ values[0])
        normal, gradient = slope @ slope.T, slope @ values[0]
        tries = damping * np.array([0.1, 1.0, 10.0, 100.0, 1000.0])
        damped = normal + tries[:, None, None] * np.diag(np.diag(normal) + 1e-9)
        change = np.clip(-np.linalg.solve(damped, gradient[None, :, None])[..., 0], -_FARTHEST, _FARTHEST)
        tried, tried_joints = _residuals(arm, move + change, joints, targets, weights, hand, share, 5)
        costs = np.einsum("ki,ki->k", tried, tried)
        best = int(np.argmin(costs))
        if not costs[best] < cost:
            break
        move, joints, damping = move + change[best], tried_joints[best], float(tries[best])
        if np.abs(change[best]).max() < _ARRIVED or costs[best] > cost * (1.0 - 1e-4):
            cost = float(costs[best])
            break
        cost = float(costs[best])
    return move, joints, cost


def towards(arm: StandingArm, design: Arm) -> FloatArray:
    """Return the least displacement of the link's end onto a design's axis 2, turned freely about axis 1.

    Roll about axis 2 is left as it is: joint 2 takes it up.

    Args:
        arm: The arm as it stands.
        design: The design, in the base frame.

    Returns:
        Shift and rotation vector, shape (6,), m and rad.
    """
    frame, end = design.end_frame
    a = np.stack([end, _LEVER * frame[:, 0]])
    b = np.stack([arm.end, _LEVER * arm.axis])
    cross = np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    turn = float(np.arctan2(cross, np.sum(a[:, :2] * b[:, :2])))
    end, axis = turned(np.stack([end, frame[:, 0]]), turn)
    return np.concatenate([end - arm.end, rotation_between(arm.axis, axis)])


def size(move: FloatArray) -> float:
    """Return how large a displacement is, m: a rotation counts with a lever."""
    return float(np.hypot(np.linalg.norm(move[:3]), _LEVER * np.linalg.norm(move[3:])))


def best_aims(
    arm: StandingArm,
    designs: Sequence[Arm],
    joints: FloatArray,
    targets: FloatArray,
    weights: FloatArray,
    hand: Hand,
    share: float,
) -> list[tuple[float, FloatArray, FloatArray]]:
    """Return aims, the cheapest first: near the present pose, and near each design."""
    starts = [(np.zeros(6), joints)]
    moves = sorted((towards(arm, design) for design in designs), key=size)
    for move in moves[:_MOST_DESIGNS]:
        if size(move) > _TOO_FAR:
            break
        starts.append((move, joints_closest_to(arm.moved(move), targets)))
    found = [aimed(arm, move, start, targets, weights, hand, share) for move, start in starts]
    return sorted(((cost, move, there) for move, there, cost in found), key=lambda aim: aim[0])
