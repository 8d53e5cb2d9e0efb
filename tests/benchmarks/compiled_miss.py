"""The miss of a shape, compiled: what the peers minimise in `peers.py`.

For each target the nearest posture within the joint limits, found over all valleys of the miss. Where the
rigid link is in the tube there, the nearest of the others that is not.
"""

from __future__ import annotations

import math

import numpy as np
from compiled_link import PENALTY, TUBE, depth, follow, point, rod_depth
from numba import njit

_GRID = 32  # angles of joint 2 looked at before the nearest valleys are followed to their bottoms
_STEPS = 30


@njit(cache=True)
def _squared_miss(pose, k, theta2, rho, z, azimuth):
    """Return the squared distance of P5 from a target, joint 1 at its best, and that joint's angle."""
    sin, cos = k[8] * math.sin(theta2), k[8] * math.cos(theta2)
    x = pose[0] + sin * pose[3] - cos * pose[6]
    y = pose[1] + sin * pose[4] - cos * pose[7]
    height = pose[2] + sin * pose[5] - cos * pose[8]
    off = (azimuth - math.atan2(y, x) - k[9] + math.pi) % (2.0 * math.pi) - math.pi
    beyond = abs(off) - k[10]
    theta1 = k[9] + min(max(off, -k[10]), k[10])
    radial = math.sqrt(x * x + y * y)
    squared = (radial - rho) ** 2 + (height - z) ** 2
    if beyond > 0.0:
        squared += 2.0 * radial * rho * (1.0 - math.cos(beyond))
    return squared, theta1


@njit(cache=True)
def _slope(pose, k, theta2, rho, z):
    """Return half the first and second derivative of the squared miss by theta2, joint 1 free."""
    sin, cos = math.sin(theta2), math.cos(theta2)
    x = pose[0] + k[8] * (sin * pose[3] - cos * pose[6])
    y = pose[1] + k[8] * (sin * pose[4] - cos * pose[7])
    height = pose[2] + k[8] * (sin * pose[5] - cos * pose[8])
    dx = k[8] * (cos * pose[3] + sin * pose[6])
    dy = k[8] * (cos * pose[4] + sin * pose[7])
    dz = k[8] * (cos * pose[5] + sin * pose[8])
    radial = math.sqrt(x * x + y * y) + 1e-12
    by = (x * dx + y * dy) / radial
    second = (dx * dx + dy * dy + x * (pose[0] - x) + y * (pose[1] - y) - by * by) / radial
    out, up = radial - rho, height - z
    return out * by + up * dz, by * by + out * second + dz * dz + up * (pose[2] - height)


@njit(cache=True)
def _valley(pose, k, lower, upper, rho, z, azimuth):
    """Return the lowest squared miss between two angles of joint 2, and both joints there."""
    middle = 0.5 * (lower + upper)
    a, b = lower, upper
    # Newton's method on the slope, kept within a shrinking bracket.
    for _ in range(_STEPS):
        slope, curvature = _slope(pose, k, middle, rho, z)
        if slope > 0.0:
            b = middle
        else:
            a = middle
        moved = middle - slope / curvature if curvature > 0.0 else a - 1.0
        if not a < moved < b:
            moved = 0.5 * (a + b)
        done = abs(moved - middle) < 1e-9
        middle = moved
        if done:
            break
    best, theta1 = _squared_miss(pose, k, middle, rho, z, azimuth)
    angle = middle
    if abs(theta1 - k[9]) > k[10] - 0.02:
        # Near the dead zone of joint 1 the slope above is not that of the miss: golden section.
        ratio = 0.6180339887498949
        a, b = lower, upper
        left, right = b - ratio * (b - a), a + ratio * (b - a)
        at_left = _squared_miss(pose, k, left, rho, z, azimuth)[0]
        at_right = _squared_miss(pose, k, right, rho, z, azimuth)[0]
        for _ in range(_STEPS):
            if at_left < at_right:
                b, right, at_right = right, left, at_left
                left = b - ratio * (b - a)
                at_left = _squared_miss(pose, k, left, rho, z, azimuth)[0]
            else:
                a, left, at_left = left, right, at_right
                right = a + ratio * (b - a)
                at_right = _squared_miss(pose, k, right, rho, z, azimuth)[0]
        squared, turn = _squared_miss(pose, k, 0.5 * (a + b), rho, z, azimuth)
        if squared < best:
            best, theta1, angle = squared, turn, 0.5 * (a + b)
    return best, theta1, angle


@njit(cache=True)
def _grid(pose, k, width):
    """Return rho, z and azimuth of P5 along joint 2, and room for the squared misses, shape (_GRID, 4)."""
    grid = np.empty((_GRID, 4))
    for j in range(_GRID):
        sin, cos = k[8] * math.sin(k[11] + j * width), k[8] * math.cos(k[11] + j * width)
        x = pose[0] + sin * pose[3] - cos * pose[6]
        y = pose[1] + sin * pose[4] - cos * pose[7]
        grid[j, 0], grid[j, 1] = math.sqrt(x * x + y * y), pose[2] + sin * pose[5] - cos * pose[8]
        grid[j, 2] = math.atan2(y, x) + k[9]
    return grid


@njit(cache=True)
def _look(grid, k, rho, z, azimuth):
    """Write the squared misses along joint 2 into the grid and return the least."""
    least = np.inf
    for j in range(_GRID):
        squared = (grid[j, 0] - rho) ** 2 + (grid[j, 1] - z) ** 2
        beyond = abs((azimuth - grid[j, 2] + math.pi) % (2.0 * math.pi) - math.pi) - k[10]
        if beyond > 0.0:
            squared += 2.0 * grid[j, 0] * rho * (1.0 - math.cos(beyond))
        grid[j, 3] = squared
        least = min(least, squared)
    return least


@njit(cache=True)
def closest(pose, k, tube, targets, joints):
    """Write the best joints of each target into joints, shape (n, 2); return the sum of squared misses.

    Depths of the rigid link in the tube count, squared, so that a clear posture goes first.
    """
    width = (k[12] - k[11]) / (_GRID - 1)
    speed = 0.5 * k[8] * width  # how far P5 is at most from the nearest point of the grid
    grid = _grid(pose, k, width)
    total = 0.0
    for i in range(len(targets)):
        rho, z = math.hypot(targets[i, 0], targets[i, 1]), targets[i, 2]
        azimuth = math.atan2(targets[i, 1], targets[i, 0])
        least = _look(grid, k, rho, z, azimuth)
        reach = (math.sqrt(least) + speed) ** 2
        best, theta1, theta2 = np.inf, 0.0, 0.0
        for _ in range(2):
            for j in range(_GRID):
                here = grid[j, 3]
                before = grid[j - 1, 3] if j > 0 else np.inf
                after = grid[j + 1, 3] if j < _GRID - 1 else np.inf
                if here <= before and here < after and here <= reach:
                    lower, upper = k[11] + max(j - 1, 0) * width, k[11] + min(j + 1, _GRID - 1) * width
                    squared, turn, angle = _valley(pose, k, lower, upper, rho, z, azimuth)
                    if here < squared:  # at an end of the joint's range
                        squared, turn = _squared_miss(pose, k, k[11] + j * width, rho, z, azimuth)
                        angle = k[11] + j * width
                    if squared < best:
                        squared += (PENALTY * rod_depth(pose, k, tube, angle)) ** 2
                    if squared < best:
                        best, theta1, theta2 = squared, turn, angle
            if best <= reach:
                break
            reach = np.inf  # the rigid link is in the tube there: look at all valleys
        joints[i, 0], joints[i, 1] = theta1, theta2
        total += best
    return total


@njit(cache=True)
def cost(x, k, targets):
    """Return the mean squared miss, m^2, plus the penalty for what is below the floor."""
    pose, tube, joints = np.empty(13), np.empty((TUBE, 4)), np.empty((len(targets), 2))
    follow(x, k, pose, tube)
    total = closest(pose, k, tube, targets, joints) / len(targets) + (PENALTY * pose[12]) ** 2
    for part in range(9, 12):
        total += depth(pose[part], k[13]) ** 2
    return total


@njit(cache=True)
def costs(columns, k, targets):
    """Return the cost of many shapes at once, x as columns, shape (9, N)."""
    values = np.empty(columns.shape[1])
    for i in range(columns.shape[1]):
        values[i] = cost(np.ascontiguousarray(columns[:, i]), k, targets)
    return values


@njit(cache=True)
def misses(x, k, targets):
    """Return the miss of each target, shape (n,), m."""
    pose, tube, joints = np.empty(13), np.empty((TUBE, 4)), np.empty((len(targets), 2))
    follow(x, k, pose, tube)
    closest(pose, k, tube, targets, joints)
    values = np.empty(len(targets))
    for i in range(len(targets)):
        p5 = point(pose, k, joints[i, 0], joints[i, 1])
        values[i] = math.sqrt(
            (p5[0] - targets[i, 0]) ** 2 + (p5[1] - targets[i, 1]) ** 2 + (p5[2] - targets[i, 2]) ** 2
        )
    return values
