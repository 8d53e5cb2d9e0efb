"""The joint angles that bring P5 closest to points: exact to rounding, and for a hundred thousand points.

Joint 1 turns everything about one axis, so with joint 2 at theta2 the distance to a point p is

    F(theta2)^2 = (rho - rho_p)^2 + (z - z_p)^2 + 4 rho rho_p sin^2(e / 2),

where (rho, z) are the coordinates of P5 in the half-plane of axis 1 and e is the angle by which joint 1's
limits keep P5 off the half-plane of p. P5 moves along a circle of radius R, so F has the Lipschitz
constant R: a valley of F that lies more than R times the spacing of a grid above the lowest grid point
cannot hold the minimum. What is left, mostly one valley, is searched for the root of

    d(F^2)/d(theta2) / 2 = (q - Rz(-theta1) p) . q',

q being P5 at theta1 = 0 and theta1 at its best (the envelope theorem: its own change adds nothing).

The secants are our own: `scipy.optimize.elementwise.find_root` gives the same misses to 4e-16 m, in 1.5
times the time for 50 points and 0.9 times for 20 000, but to import `scipy.optimize` takes 0.7 s, a good part
of what an easy task takes in all.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from synth.robot.hardware import into_turn, turned

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.robot.hardware import Interval, JointLimits
    from synth.robot.kinematics import Kinematics

# Over joint 2 the miss has few valleys, as it has few harmonics; a full turn's grid has a spacing of 2 deg.
_GRID = 181
# A valley may hold several where P5 passes axis 1 closely: it is looked at again, twice.
_ZOOMS = 3
_FINER = 17  # points between the neighbours of a grid point: eight times as finely
# Steps of the bracketed secant method: rounding is reached after about six, twelve at a kink.
_SECANTS = 12
_CHUNK = 4096  # points looked at together: their grid stays in the processor's cache


def closest_joints(
    kinematics: Kinematics, points: FloatArray, limits: JointLimits
) -> tuple[FloatArray, FloatArray]:
    """Return the joint angles within the limits that come closest to points, and their misses.

    Args:
        kinematics: The two joints of one shape.
        points: Points in the base frame, shape (n, 3), m; on the workspace or off it.
        limits: The joint limits.

    Returns:
        Angles (theta1, theta2), shape (n, 2), rad, and misses, shape (n,), m.
    """
    joints, misses = np.empty((len(points), 2)), np.empty(len(points))
    for first in range(0, len(points), _CHUNK):
        part = slice(first, first + _CHUNK)
        joints[part], misses[part] = _closest(kinematics, points[part], limits)
    return joints, misses


def _closest(
    kinematics: Kinematics, points: FloatArray, limits: JointLimits
) -> tuple[FloatArray, FloatArray]:
    """Return what `closest_joints` does, all points at once."""
    row, second = np.arange(len(points)), limits.second
    grid = np.linspace(second.lower, second.upper, _GRID)[None]
    bracket: tuple[FloatArray, ...] = ()
    for _ in range(_ZOOMS):
        if bracket:
            grid = bracket[0][:, None] + (bracket[2] - bracket[0])[:, None] * np.linspace(0.0, 1.0, _FINER)
        misses = _grid_misses(kinematics, grid, points[row], limits.base)
        valley, column = _valleys(row, misses, kinematics.radius * (grid[:, 1] - grid[:, 0]))
        row, grid = row[valley], np.broadcast_to(grid, misses.shape)[valley]
        beside = np.clip(column[:, None] + np.array([-1, 0, 1]), 0, grid.shape[1] - 1)
        bracket = tuple(np.take_along_axis(grid, beside, axis=1).T)
    theta2 = _bottom(kinematics, bracket, points[row], limits.base)
    joints = np.stack([kinematics.best_theta1(theta2, points[row], limits.base), theta2], axis=-1)
    distances = np.linalg.norm(kinematics.forward(joints[:, 0], joints[:, 1]) - points[row], axis=-1)
    order = np.lexsort([distances, row])
    best = order[np.searchsorted(row[order], np.arange(len(points)))]
    return joints[best], distances[best]


def _grid_misses(kinematics: Kinematics, grid: FloatArray, points: FloatArray, base: Interval) -> FloatArray:
    """Return F on grids of theta2 of shape (n, m), or (1, m) for the same one everywhere; (n, m), m."""
    x, y, z = kinematics.unturned(np.cos(grid), np.sin(grid))
    rho, rho_p = np.hypot(x, y), np.hypot(points[:, 0], points[:, 1])[:, None]
    squared = (rho - rho_p) ** 2 + (z - points[:, 2:]) ** 2
    # How far beyond joint 1's range theta1 would have to be to keep P5 in the half-plane of the point; by its
    # extreme angles most grids are nowhere beyond.
    own, half = np.arctan2(y, x), 0.5 * (base.upper - base.lower)
    low, high = own.min(axis=1), own.max(axis=1)
    wanted = np.arctan2(points[:, 1], points[:, 0])
    turn = into_turn(wanted - 0.5 * (low + high), base.middle) - base.middle
    near = np.flatnonzero(np.abs(turn) + 0.5 * (high - low) > half)
    if len(near):
        rows = near if len(own) > 1 else [0]
        beyond = np.abs(into_turn(wanted[near, None] - own[rows], base.middle) - base.middle) - half
        squared[near] += 4.0 * rho[rows] * rho_p[near] * np.sin(0.5 * np.maximum(beyond, 0.0)) ** 2
    return np.asarray(np.sqrt(squared))


def _valleys(
    row: NDArray[np.intp], misses: FloatArray, slope: FloatArray
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return in which grids, and where there, a valley lies that may hold the minimum of its point.

    Args:
        row: To which point each grid belongs, shape (k,), ascending.
        misses: F on the grids, shape (k, m), m.
        slope: By how much F can change from one point of a grid to the next, shape (k,) or (1,), m.
    """
    first = np.flatnonzero(np.diff(row, prepend=-1))
    lowest = np.minimum.reduceat(misses.min(axis=1), first)[row]
    valley = misses <= (lowest + slope)[:, None]
    valley[:, 1:] &= misses[:, 1:] < misses[:, :-1]
    valley[:, :-1] &= misses[:, :-1] <= misses[:, 1:]
    grids, columns = np.nonzero(valley)
    return grids, columns


def _bottom(
    kinematics: Kinematics,
    bracket: tuple[FloatArray, ...],
    points: FloatArray,
    base: Interval,
) -> FloatArray:
    """Return theta2 at the bottoms of valleys, shape (k,), rad; each between the ends of its bracket."""
    v, t = kinematics.frame[:, 1], kinematics.frame[:, 2]
    azimuth = np.arctan2(points[:, 1], points[:, 0])

    def slope(theta2: FloatArray) -> FloatArray:
        cos, sin = np.cos(theta2), np.sin(theta2)
        x, y, z = kinematics.unturned(cos, sin)
        theta1 = np.clip(into_turn(azimuth - np.arctan2(y, x), base.middle), base.lower, base.upper)
        there = turned(points, -theta1)
        off = (x - there[:, 0], y - there[:, 1], z - there[:, 2])
        across, along = (sum(part * axis[i] for i, part in enumerate(off)) for axis in (v, t))
        return np.asarray(kinematics.radius * (cos * across + sin * along))

    lower, middle, upper = bracket
    at_lower, at_middle, at_upper = slope(lower), slope(middle), slope(upper)
    falls = at_middle < 0.0
    lower, at_lower = np.where(falls, middle, lower), np.where(falls, at_middle, at_lower)
    upper, at_upper = np.where(falls, upper, middle), np.where(falls, at_upper, at_middle)
    # No root where the minimum is an end of joint 2's range: there the middle is that end.
    has_root = (at_lower < 0.0) & (at_upper > 0.0)
    moved = np.zeros(len(middle))  # the side moved last: -1 the lower, 1 the upper
    for _ in range(_SECANTS):
        # Anderson and Bjoerck (1973): a secant, where the side that stays twice counts less.
        rise = np.where(has_root, at_upper - at_lower, 1.0)
        between = np.clip(lower - at_lower * (upper - lower) / rise, lower, upper)
        value = slope(between)
        falls = value < 0.0
        side = np.where(falls, -1.0, 1.0)
        replaced = np.where(falls, at_lower, at_upper)
        lessened = 1.0 - value / np.where(replaced == 0.0, 1.0, replaced)
        part = np.where(side == moved, np.where(lessened > 0.0, lessened, 0.5), 1.0)
        lower, at_lower = np.where(falls, between, lower), np.where(falls, value, part * at_lower)
        upper, at_upper = np.where(falls, upper, between), np.where(falls, part * at_upper, value)
        moved = side
    return np.where(has_root, between, middle)
