"""The inverse kinematics of one arm in closed form, for very many points: what a planner asks without end.

Height z and squared distance N = |P5|^2 from P1 do not depend on joint 1, and are linear in
w = (cos theta2, sin theta2); see `Kinematics.branches`. What depends on the arm alone is computed once here;
a point then costs four arctangents and some dozens of products.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from synth.arrays import FloatArray
    from synth.robot.hardware import JointLimits
    from synth.robot.kinematics import Kinematics

_TURN = 2.0 * math.pi
_EXACT = 1e-13  # of the reach: what rounding leaves of a miss
_SAME = 1e-5  # rad; branches nearer than this are one, met twice
_LIMIT_SLACK = 1e-9  # rad
_TOGETHER = 4096  # points, so that their arrays stay in the cache


class ClosedForm:
    """The closed form for one arm.

    Args:
        kinematics: Its joints.
        limits: Their ranges; angles are given in the turn about the middle of each.
    """

    def __init__(self, kinematics: Kinematics, limits: JointLimits) -> None:
        self._kinematics = kinematics
        self._middles = limits.base.middle, limits.second.middle
        self._lower = np.array([limits.base.lower, limits.second.lower]) - _LIMIT_SLACK
        self._upper = np.array([limits.base.upper, limits.second.upper]) + _LIMIT_SLACK
        centre, radius = kinematics.centre, float(kinematics.radius)
        # P5 at joint 1 = 0 is centre + across w.
        across = radius * np.stack([-kinematics.frame[:, 2], kinematics.frame[:, 1]], axis=-1)
        squared = float(centre @ centre)
        scale = 0.5 / math.sqrt(squared + radius**2)
        left, singular, right = np.linalg.svd(np.stack([across[2], 2.0 * scale * centre @ across]))
        size = max(float(singular[0]), 1e-300)
        # The share of w along the first singular vector is by_height z + by_squared N + constant.
        self._by_height = float(left[0, 0]) / size
        self._by_squared = float(left[1, 0]) * scale / size
        self._constant = -self._by_height * float(centre[2]) - self._by_squared * (squared + radius**2)
        self._right, self._across, self._centre = right.tolist(), across.tolist(), centre.tolist()
        self._reach = math.sqrt(squared) + radius

    def branches(
        self, points: FloatArray, within: float, *, within_limits: bool
    ) -> tuple[FloatArray, FloatArray]:
        """Return the joint angles that bring P5 to points, the better branch first.

        Args:
            points: Points in the base frame, shape (n, 3), m.
            within: Largest miss of a branch, m.
            within_limits: Whether branches beyond the joint limits are dropped.

        Returns:
            Angles, shape (n, 2, 2), rad, and misses, shape (n, 2), m; infinite where a branch is dropped.
        """
        joints, misses = np.empty((len(points), 2, 2)), np.empty((len(points), 2))
        for start in range(0, len(points), _TOGETHER):
            some = slice(start, start + _TOGETHER)
            self._fill(points[some], within, joints[some], misses[some])
        if within_limits:
            misses[((joints < self._lower) | (joints > self._upper)).any(axis=-1)] = math.inf
        other = misses[:, 1] < misses[:, 0]
        if other.any():
            joints[other], misses[other] = joints[other, ::-1], misses[other, ::-1]
        same = np.abs(joints[:, 0] - joints[:, 1]).max(axis=-1) < _SAME
        misses[same, 1] = math.inf
        return joints, misses

    def _fill(self, points: FloatArray, within: float, joints: FloatArray, misses: FloatArray) -> None:
        """Put the branches of some points into arrays."""
        x, y, z = points.T
        from_axis = x * x + y * y
        along = self._by_height * z + self._by_squared * (from_axis + z * z) + self._constant
        first = np.minimum(np.maximum(along, -1.0), 1.0)
        second = np.sqrt((1.0 - first) * (1.0 + first))
        rho = np.sqrt(from_axis)
        (r00, r01), (r10, r11) = self._right
        (xc, xs), (yc, ys), (zc, zs) = self._across
        cx, cy, cz = self._centre
        share = np.empty((2, len(points)))  # along the second singular vector, of either sign
        share[0], share[1] = second, -second
        cos, sin = r00 * first + r10 * share, r01 * first + r11 * share
        there_x, there_y = cx + xc * cos + xs * sin, cy + yc * cos + ys * sin
        out, up = np.sqrt(there_x * there_x + there_y * there_y) - rho, cz + zc * cos + zs * sin - z
        misses[:] = np.sqrt(out * out + up * up).T
        theta1 = np.arctan2(there_x * y - there_y * x, there_x * x + there_y * y)
        joints[..., 0] = _into_turn(theta1, self._middles[0]).T
        joints[..., 1] = _into_turn(np.arctan2(sin, cos), self._middles[1]).T
        on_axis = rho <= _EXACT * self._reach
        if on_axis.any():  # where any theta1 does
            joints[on_axis, :, 0] = self._middles[0]
        self._polish(points, within, joints, misses)
        misses[misses > within] = math.inf

    def _polish(self, points: FloatArray, within: float, joints: FloatArray, misses: FloatArray) -> None:
        """Bring back the digits that the square root loses near a rim, and those of points beside it."""
        # A point that is off by d is within sqrt(d times the reach) of where the root puts it.
        promising = within + 4.0 * math.sqrt(within * self._reach) + 1e-6 * self._reach
        rough = (misses > _EXACT * self._reach) & (misses <= promising)
        which, branch = np.nonzero(rough)
        if not len(which):
            return
        better = self._kinematics.polished(joints[which, branch], points[which])
        reached = self._kinematics.forward(better[:, 0], better[:, 1])
        for joint, middle in enumerate(self._middles):
            joints[which, branch, joint] = _into_turn(better[:, joint], middle)
        misses[which, branch] = np.linalg.norm(reached - points[which], axis=-1)


def _into_turn(angle: FloatArray, middle: float) -> FloatArray:
    """Return angles moved by whole turns to within half a turn of `middle`, rad."""
    return np.asarray(angle - _TURN * np.rint((angle - middle) * (1.0 / _TURN)))
