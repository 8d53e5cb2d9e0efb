"""By how much a shape misses a cell of a surface at most, all of it: two bounds, of which the lesser holds.

About its middle. Of a cell with the point c the arm reaches P at joint angles q, and misses c by e = c - P.
Any other point x of the cell is x = c + t + w, with t in the surface's tangent plane at c, |t| <= r, and w
along its normal, |w| <= k r^2 / 2, for a way of length r on a surface whose normal curvature is k at most.
Joints that follow t as far as it lies in the tangent plane of the workspace move P by that part of t and by a
rest which second derivatives of P5 bound, |P''| <= rho and R. So x is missed by at most

    |e| + r sin(phi) + k r^2 / 2 + (rho a^2 + 2 R a b + R b^2) r^2 / 2,

phi the angle between the two planes, a and b the largest turns of the joints for a unit of t, rho the largest
distance from axis 1 on the way; if the joints may turn so far. In any case it is missed by at most |e| + r.

Between its corners. A flat cell is the convex hull of its corners c_i, which the arm misses by e_i at joint
angles q_i. For x = sum l_i c_i let the joints stand at q = sum l_i q_i, within the limits as all q_i are. Of
P(q_i) about q the linear terms cancel in the sum, and the means of the squares are at most a quarter of the
spans' squares. So x is missed by at most

    max e_i + (rho A^2 + 2 R A B + R B^2) / 8,

A and B the spans of the q_i, rho as above. No tangent plane is asked for: the triangles of a mesh may lie at
any angle to what they were taken from, and the arm may be singular.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from synth.arrays import FloatArray
    from synth.robot import Arm, Interval
    from synth.surfaces import Cells

_STEPS = 4  # towards the corners, which are near
_DAMPING = 1e-4  # of a step, as a share of R: where the arm is singular no joint shall turn far for nothing


def largest_misses(arm: Arm, joints: FloatArray, misses: FloatArray, cells: Cells) -> FloatArray:
    """Return a bound of what is missed of each cell, shape (n,), m; see above.

    Args:
        arm: The robot in a shape.
        joints: Joint angles at the cells' points, shape (n, 2), rad.
        misses: What P5 is off these points there, shape (n,), m.
        cells: The cells.
    """
    bound = _about_middles(arm, joints, misses, cells)
    if cells.corners is None:
        return bound
    return np.minimum(bound, _between_corners(arm, joints, arm.base.to_base(cells.corners)))


def _about_middles(arm: Arm, joints: FloatArray, misses: FloatArray, cells: Cells) -> FloatArray:
    """Return the first bound, shape (n,), m."""
    kinematics, r = arm.kinematics, cells.radii
    reached = kinematics.forward(joints[:, 0], joints[:, 1])
    first, second = kinematics.velocities(joints, reached)
    normal = np.cross(first, second)
    length = np.linalg.norm(normal, axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        a, b = (np.linalg.norm(v, axis=1) / length for v in (second, first))
        cosine = np.abs(np.einsum("ni,ni->n", normal / length[:, None], cells.normals @ arm.base.rotation))
        sine = np.sqrt(np.maximum(1.0 - cosine**2, 0.0))
        rho = np.hypot(reached[:, 0], reached[:, 1]) + r + float(kinematics.radius) * b * r
        bound = misses + r * sine + 0.5 * cells.curvatures * r**2 + 0.5 * _bend(arm, rho, a * r, b * r)
        lower, upper = _limits(arm)
        spare = np.minimum(joints - lower, upper - joints)
        follows = (a * r <= spare[:, 0]) & (b * r <= spare[:, 1])
    usable = follows & np.isfinite(bound)
    return np.where(usable, np.minimum(np.where(usable, bound, 0.0), misses + r), misses + r)


def _between_corners(arm: Arm, joints: FloatArray, corners: FloatArray) -> FloatArray:
    """Return the second bound for cells with their corners in the base frame, (n, k, 3), shape (n,), m."""
    kinematics = arm.kinematics
    angles = np.repeat(joints[:, None], corners.shape[1], axis=1)
    for _ in range(_STEPS):
        angles = _nearer(arm, angles, corners)
    reached = kinematics.forward(angles[..., 0], angles[..., 1])
    off = np.linalg.norm(reached - corners, axis=-1).max(axis=1)
    span = np.ptp(angles, axis=1)
    # How far from axis 1 is a matter of joint 2 alone, which is no more than half the span from a corner.
    farthest = np.hypot(reached[..., 0], reached[..., 1]).max(axis=1)
    rho = farthest + 0.5 * float(kinematics.radius) * span[:, 1]
    return np.asarray(off + _bend(arm, rho, span[:, 0], span[:, 1]) / 8.0)


def _nearer(arm: Arm, angles: FloatArray, points: FloatArray) -> FloatArray:
    """Return joint angles after a damped step towards points in the base frame, shape (..., 2), rad."""
    reached = arm.kinematics.forward(angles[..., 0], angles[..., 1])
    first, second = arm.kinematics.velocities(angles, reached)
    damping = (_DAMPING * float(arm.kinematics.radius)) ** 2
    aa, ab, bb = (np.einsum("...i,...i", *pair) for pair in ((first, first), (first, second), (second,) * 2))
    aa, bb = aa + damping, bb + damping
    a, b = (np.einsum("...i,...i", velocity, points - reached) for velocity in (first, second))
    step = np.stack([bb * a - ab * b, aa * b - ab * a], axis=-1) / (aa * bb - ab**2)[..., None]
    return np.asarray(np.clip(angles + step, *_limits(arm)))


def _bend(arm: Arm, rho: FloatArray, a: FloatArray, b: FloatArray) -> FloatArray:
    """Return the most that the second derivative of P5 is along turns a and b of the joints, m."""
    radius = float(arm.kinematics.radius)
    return rho * a**2 + 2.0 * radius * a * b + radius * b**2


def _limits(arm: Arm) -> tuple[FloatArray, FloatArray]:
    """Return the lower and the upper joint limits, shapes (2,), rad; none where all of a turn is within them.

    A surface is covered wherever joint 1 begins to count its turn.
    """

    def open_ended(limit: Interval) -> tuple[float, float]:
        is_full = limit.upper - limit.lower >= 2.0 * math.pi
        return (-math.inf, math.inf) if is_full else (limit.lower, limit.upper)

    limits = arm.robot.joint_limits
    lower, upper = zip(open_ended(limits.base), open_ended(limits.second), strict=True)
    return np.array(lower), np.array(upper)
