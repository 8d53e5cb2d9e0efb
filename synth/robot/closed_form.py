"""The inverse kinematics of one arm in closed form, for very many points: what a planner asks without end.

Height z and squared distance N = |P5|^2 from P1 do not depend on joint 1, and are linear in
w = (cos theta2, sin theta2); see `Kinematics.branches`. What depends on the arm alone is computed once here;
a point then costs four arctangents and some dozens of products.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator

    from synth.arrays import FloatArray
    from synth.robot.hardware import JointLimits
    from synth.robot.kinematics import Kinematics

_N = TypeVar("_N", bound=Any)  # a number, or an array of them
_TURN = 2.0 * math.pi
_EXACT = 1e-13  # of the reach: what rounding leaves of a miss
_SAME = 1e-5  # rad; branches nearer than this are one, met twice
_LIMIT_SLACK = 1e-9  # rad
_STEPS, _TINY = 6, 1e-18
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

    def forward(self, theta1: Any, theta2: Any) -> FloatArray:
        """Return P5 in the base frame for joint angles, shape (...), rad; of shape (..., 3), m."""
        if isinstance(theta1, float) and isinstance(theta2, float) and math.isfinite(theta1 + theta2):
            return np.array(self._turned(theta1, theta2, math))
        x, y, z = self._turned(np.asarray(theta1, dtype=float), np.asarray(theta2, dtype=float), np)
        return np.stack(np.broadcast_arrays(x, y, z), axis=-1)

    def _turned(self, theta1: _N, theta2: _N, of: Any) -> tuple[_N, _N, _N]:
        """Return x, y and z of P5, m, for numbers or arrays; `of` as in `_pairs`."""
        x, y, z = self._unturned(of.cos(theta2), of.sin(theta2))
        cos, sin = of.cos(theta1), of.sin(theta1)
        return cos * x - sin * y, sin * x + cos * y, z

    def _unturned(self, cos: _N, sin: _N) -> tuple[_N, _N, _N]:
        """Return x, y and z of P5 at joint 1 = 0, m, for cosine and sine of joint 2."""
        (xc, xs), (yc, ys), (zc, zs) = self._across
        cx, cy, cz = self._centre
        return cx + xc * cos + xs * sin, cy + yc * cos + ys * sin, cz + zc * cos + zs * sin

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
            beyond = (joints < self._lower) | (joints > self._upper)
            misses[beyond[..., 0] | beyond[..., 1]] = math.inf
        other = misses[:, 1] < misses[:, 0]
        if other.any():
            joints[other], misses[other] = joints[other, ::-1], misses[other, ::-1]
        same = np.abs(joints[:, 0] - joints[:, 1]) < _SAME
        misses[same[:, 0] & same[:, 1], 1] = math.inf
        return joints, misses

    def _fill(self, points: FloatArray, within: float, joints: FloatArray, misses: FloatArray) -> None:
        """Put the branches of some points into arrays."""
        # One point is worked out in plain numbers: arrays of one entry cost ten times as much.
        alone = len(points) == 1 and math.isfinite(points.sum())
        x, y, z = points[0].tolist() if alone else points.T
        rho2 = x * x + y * y
        along = self._by_height * z + self._by_squared * (rho2 + z * z) + self._constant
        first = min(max(along, -1.0), 1.0) if alone else np.minimum(np.maximum(along, -1.0), 1.0)
        pairs = self._pairs(x, y, z, first, math if alone else np)
        for branch, (theta1, theta2, miss) in enumerate(pairs):
            joints[:, branch, 0], joints[:, branch, 1], misses[:, branch] = theta1, theta2, miss
        on_axis = rho2 <= (_EXACT * self._reach) ** 2
        if on_axis if alone else on_axis.any():  # where any theta1 does
            joints[np.atleast_1d(on_axis), :, 0] = self._middles[0]
        self._polish(points, within, joints, misses)
        misses[misses > within] = math.inf

    def _pairs(self, x: _N, y: _N, z: _N, first: _N, of: Any) -> Iterator[tuple[_N, _N, _N]]:
        """Yield both branches, theta1, theta2 and the miss of each, of points in numbers or in arrays.

        Args:
            x: Of the points, m; likewise y and z.
            y: See x.
            z: See x.
            first: Share of w along the first singular vector.
            of: Where the functions of such numbers are: math or numpy.
        """
        (r00, r01), (r10, r11) = self._right
        second, rho = of.sqrt((1.0 - first) * (1.0 + first)), of.sqrt(x * x + y * y)
        for share in (second, -second):  # along the second singular vector, of either sign
            cos, sin = r00 * first + r10 * share, r01 * first + r11 * share
            there_x, there_y, there_z = self._unturned(cos, sin)
            out, up = of.sqrt(there_x * there_x + there_y * there_y) - rho, there_z - z
            theta1 = of.atan2(there_x * y - there_y * x, there_x * x + there_y * y)
            yield (
                _into_turn(theta1, self._middles[0], of),
                _into_turn(of.atan2(sin, cos), self._middles[1], of),
                of.sqrt(out * out + up * up),
            )

    def _polish(self, points: FloatArray, within: float, joints: FloatArray, misses: FloatArray) -> None:
        """Bring back the digits that the square root loses near a rim, and those of points beside it."""
        # A point that is off by d is within sqrt(d times the reach) of where the root puts it.
        promising = within + 4.0 * math.sqrt(within * self._reach) + 1e-6 * self._reach
        rough = (misses > _EXACT * self._reach) & (misses <= promising)
        which, branch = np.nonzero(rough)
        if len(points) == 1 and math.isfinite(points.sum()):
            for one in branch.tolist():
                theta1, theta2 = joints[0, one].tolist()
                x, y, z = points[0].tolist()
                misses[0, one], *joints[0, one] = min(self._steps(theta1, theta2, x, y, z, math))
        elif len(which):
            (theta1, theta2), (x, y, z) = joints[which, branch].T, points[which].T
            tried = np.array(list(self._steps(theta1, theta2, x, y, z, np)))
            best = tried[tried[:, 0].argmin(axis=0), :, np.arange(len(which))]
            misses[which, branch], joints[which, branch] = best[:, 0], best[:, 1:]
        for joint, middle in enumerate(self._middles):
            joints[which, branch, joint] = _into_turn(joints[which, branch, joint], middle)

    def _steps(self, theta1: _N, theta2: _N, x: _N, y: _N, z: _N, of: Any) -> Iterator[tuple[_N, _N, _N]]:
        """Yield miss, theta1 and theta2 from one Gauss-Newton step to the next; arguments as in `_pairs`."""
        (xc, xs), (yc, ys), (zc, zs) = self._across
        for _ in range(_STEPS + 1):
            px, py, pz = self._turned(theta1, theta2, of)
            off_x, off_y, off_z = px - x, py - y, pz - z
            yield of.sqrt(off_x * off_x + off_y * off_y + off_z * off_z), theta1, theta2
            # By theta1 P5 moves along (-py, px, 0), by theta2 along the tangent of its circle.
            cos, sin, cos1, sin1 = of.cos(theta2), of.sin(theta2), of.cos(theta1), of.sin(theta1)
            flat_x, flat_y, tz = xs * cos - xc * sin, ys * cos - yc * sin, zs * cos - zc * sin
            tx, ty = cos1 * flat_x - sin1 * flat_y, sin1 * flat_x + cos1 * flat_y
            # The 2x2 normal equations; a tiny diagonal keeps singular postures finite.
            a, b, c = px * px + py * py + _TINY, px * ty - py * tx, tx * tx + ty * ty + tz * tz + _TINY
            f, g = px * off_y - py * off_x, tx * off_x + ty * off_y + tz * off_z
            det = a * c - b * b
            det = 0.5 * (det + abs(det)) + 1e-30
            theta1 = theta1 - _at_most_half((c * f - b * g) / det)
            theta2 = theta2 - _at_most_half((a * g - b * f) / det)


def _at_most_half(step: _N) -> Any:
    """Return steps cut to half a radian: of numbers or arrays, so by absolute values."""
    return 0.5 * (abs(step + 0.5) - abs(step - 0.5))


def _into_turn(angle: _N, middle: float, of: Any = np) -> Any:
    """Return angles moved by whole turns to within half a turn of `middle`, rad."""
    return angle - _TURN * of.floor((angle - middle) * (1.0 / _TURN) + 0.5)
