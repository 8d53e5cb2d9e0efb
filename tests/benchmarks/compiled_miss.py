"""The miss of a shape, compiled: what the peers minimise in `peers.py`.

The model is that of `synth`: four equal arcs within the limits of the link, the joints within theirs, the
floor. It is written again here, on its own and for numba, because a peer that called numpy once a shape
would lose all its time there. `tests/benchmarks/peers.py` compares it with `synth` before it measures.

Unknowns x, shape (9,): the curvatures of the arcs in units of the largest one, then the link's length in m.
Every x stands for a shape that the link can take: what is beyond a limit is moved onto it first.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numba import njit

if TYPE_CHECKING:
    from synth.task import Task

ARCS = 4
UNKNOWNS = 2 * ARCS + 1
_GRID = 32  # angles of joint 2 looked at before the nearest valleys are followed to their bottoms
_STEPS = 30
_MARGIN = 2e-4  # the peers keep this far above the floor, m: their penalty gives way a little
_PENALTY = 10.0


def bounds(task: Task) -> tuple[np.ndarray, np.ndarray]:
    """Return the box of the unknowns."""
    length = task.robot.link.length
    return (
        np.array([-1.0] * (2 * ARCS) + [length.lower]),
        np.array([1.0] * (2 * ARCS) + [length.upper]),
    )


def constants(task: Task) -> np.ndarray:
    """Return what the compiled functions need to know of the task beside its targets."""
    robot, limits = task.robot, task.robot.joint_limits
    offset, radius = robot.end_effector_circle(robot.rigid_link.d35.lower, robot.rigid_link.d45.lower)
    return np.array(
        [
            robot.link.max_curvature, robot.link.length.lower, robot.link.length.upper,
            robot.link.max_total_bend, robot.d12, robot.tip_offset, robot.d34, float(offset), float(radius),
            limits.base.middle, limits.base.upper - limits.base.middle,
            limits.second.lower, limits.second.upper,
            -math.inf if task.floor is None else task.floor + _MARGIN,
        ]
    )  # fmt: skip


@njit(cache=True)
def follow(x, k, pose):
    """Write c, v, t of the circle of P5 and the lowest heights of link, P3 and P4 into pose, shape (12,)."""
    length = min(max(x[8], k[1]), k[2])
    shrink = np.empty(ARCS)
    total = 0.0
    for arc in range(ARCS):
        bend = math.hypot(x[2 * arc], x[2 * arc + 1])
        shrink[arc] = 1.0 / max(bend, 1.0)
        total += bend * shrink[arc]
    whole = k[0] / max(total * length * k[0] / ARCS / k[3], 1.0)
    px, py, pz = 0.0, 0.0, k[4]
    ux, uy, uz, vx, vy, vz, tx, ty, tz = 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0
    step = length / ARCS
    lowest = pz
    for arc in range(ARCS):
        kx, ky = x[2 * arc] * shrink[arc] * whole, x[2 * arc + 1] * shrink[arc] * whole
        bend = math.sqrt(kx * kx + ky * ky + 1e-16)
        turn = bend * step
        cos, sine = math.cos(turn), math.sin(turn) / bend
        versine = 2.0 * (math.sin(0.5 * turn) / bend) ** 2
        # The height is a sinusoid of the arc length: its lowest point is at an end or in between.
        sideways = (uz * kx + vz * ky) / bend
        low = math.atan2(-tz, sideways) % (2.0 * math.pi)
        if low < turn:
            lowest = min(lowest, pz + (sideways * (1.0 - math.cos(low)) + tz * math.sin(low)) / bend)
        px += ux * kx * versine + vx * ky * versine + tx * sine
        py += uy * kx * versine + vy * ky * versine + ty * sine
        pz += uz * kx * versine + vz * ky * versine + tz * sine
        lowest = min(lowest, pz)
        a, b, c = 1.0 - kx * kx * versine, -kx * ky * versine, 1.0 - ky * ky * versine
        sx, sy = kx * sine, ky * sine
        ux, vx, tx = a * ux + b * vx - sx * tx, b * ux + c * vx - sy * tx, sx * ux + sy * vx + cos * tx
        uy, vy, ty = a * uy + b * vy - sx * ty, b * uy + c * vy - sy * ty, sx * uy + sy * vy + cos * ty
        uz, vz, tz = a * uz + b * vz - sx * tz, b * uz + c * vz - sy * tz, sx * uz + sy * vz + cos * tz
    pose[0], pose[1], pose[2] = px + k[7] * ux, py + k[7] * uy, pz + k[7] * uz
    pose[3], pose[4], pose[5], pose[6], pose[7], pose[8] = vx, vy, vz, tx, ty, tz
    pose[9], pose[10], pose[11] = lowest, pz - k[5] * uz, pz + (k[6] - k[5]) * uz


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
def closest(pose, k, targets, joints):
    """Write the best joints of each target into joints, shape (n, 2); return the sum of squared misses."""
    grid = np.empty((_GRID, 4))
    width = (k[12] - k[11]) / (_GRID - 1)
    speed = 0.5 * k[8] * width  # how far P5 is at most from the nearest point of the grid
    for j in range(_GRID):
        sin, cos = k[8] * math.sin(k[11] + j * width), k[8] * math.cos(k[11] + j * width)
        x = pose[0] + sin * pose[3] - cos * pose[6]
        y = pose[1] + sin * pose[4] - cos * pose[7]
        grid[j, 0], grid[j, 1] = math.sqrt(x * x + y * y), pose[2] + sin * pose[5] - cos * pose[8]
        grid[j, 2] = math.atan2(y, x) + k[9]
    total = 0.0
    for i in range(len(targets)):
        rho, z = math.hypot(targets[i, 0], targets[i, 1]), targets[i, 2]
        azimuth = math.atan2(targets[i, 1], targets[i, 0])
        least = np.inf
        for j in range(_GRID):
            squared = (grid[j, 0] - rho) ** 2 + (grid[j, 1] - z) ** 2
            beyond = abs((azimuth - grid[j, 2] + math.pi) % (2.0 * math.pi) - math.pi) - k[10]
            if beyond > 0.0:
                squared += 2.0 * grid[j, 0] * rho * (1.0 - math.cos(beyond))
            grid[j, 3] = squared
            least = min(least, squared)
        reach = (math.sqrt(least) + speed) ** 2
        best, theta1, theta2 = np.inf, 0.0, 0.0
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
                    best, theta1, theta2 = squared, turn, angle
        joints[i, 0], joints[i, 1] = theta1, theta2
        total += best
    return total


@njit(cache=True)
def depth(height, floor):
    """Return the penalty for a height, m; none without a floor."""
    return _PENALTY * max(floor - height, 0.0) if floor > -np.inf else 0.0


@njit(cache=True)
def cost(x, k, targets):
    """Return the mean squared miss, m^2, plus the penalty for what is below the floor."""
    pose, joints = np.empty(12), np.empty((len(targets), 2))
    follow(x, k, pose)
    total = closest(pose, k, targets, joints) / len(targets)
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
def point(pose, k, theta1, theta2):
    """Return P5 for joint angles, m."""
    sin, cos = k[8] * math.sin(theta2), k[8] * math.cos(theta2)
    x = pose[0] + sin * pose[3] - cos * pose[6]
    y = pose[1] + sin * pose[4] - cos * pose[7]
    c, s = math.cos(theta1), math.sin(theta1)
    return c * x - s * y, s * x + c * y, pose[2] + sin * pose[5] - cos * pose[8]


@njit(cache=True)
def misses(x, k, targets):
    """Return the miss of each target, shape (n,), m."""
    pose, joints = np.empty(12), np.empty((len(targets), 2))
    follow(x, k, pose)
    closest(pose, k, targets, joints)
    values = np.empty(len(targets))
    for i in range(len(targets)):
        p5 = point(pose, k, joints[i, 0], joints[i, 1])
        values[i] = math.sqrt(
            (p5[0] - targets[i, 0]) ** 2 + (p5[1] - targets[i, 1]) ** 2 + (p5[2] - targets[i, 2]) ** 2
        )
    return values
