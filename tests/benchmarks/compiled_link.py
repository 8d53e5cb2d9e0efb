"""A shape of the arm, compiled: where its parts are, and what they keep clear of.

The model is that of `synth`: four equal arcs within the limits of the link, the floor, link and rigid
link clear of each other. It is written again here, on its own, because a peer that called numpy once a
shape would lose all its time there. `peers.py` compares it with `synth` before it measures.

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
_MARGIN = 2e-4  # the peers keep this far above the floor, m: their penalty gives way a little
PENALTY = 10.0
_PIECES = 8  # of each arc, and the column of the base as two more: where clearances are looked at
TUBE = ARCS * _PIECES + 3
TUBE_RADIUS = 14  # its place among the constants
_BETWEEN = 2.5e-3  # more than clearances may be less between these points, m


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
            -math.inf if task.floor_in_base is None else task.floor_in_base + _MARGIN,
            0.5 * robot.link.diameter, 0.5 * robot.rigid_link.diameter,
            math.pi * robot.link.min_bend_radius,
        ]
    )  # fmt: skip


@njit(cache=True)
def follow(x, k, pose, tube):
    """Write the shape down.

    Into pose, shape (13,): c, v, t of the circle of P5; the lowest heights of tube, P3 and P4; how deep the
    tube is inside itself. Into tube, shape (TUBE, 4): points of its centreline, and where along it they are.
    """
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
    for i in range(3):
        tube[i, 0], tube[i, 1], tube[i, 2], tube[i, 3] = 0.0, 0.0, 0.5 * i * k[4], (0.5 * i - 1.0) * k[4]
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
        for part in range(_PIECES - 1):
            on, i = turn * (part + 1) / _PIECES, 3 + arc * _PIECES + part
            up, aside = math.sin(on) / bend, 2.0 * (math.sin(0.5 * on) / bend) ** 2
            tube[i, 0] = px + (ux * kx + vx * ky) * aside + tx * up
            tube[i, 1] = py + (uy * kx + vy * ky) * aside + ty * up
            tube[i, 2] = pz + (uz * kx + vz * ky) * aside + tz * up
            tube[i, 3] = step * (arc + (part + 1) / _PIECES)
        px += ux * kx * versine + vx * ky * versine + tx * sine
        py += uy * kx * versine + vy * ky * versine + ty * sine
        pz += uz * kx * versine + vz * ky * versine + tz * sine
        lowest = min(lowest, pz)
        end = 2 + (arc + 1) * _PIECES
        tube[end, 0], tube[end, 1], tube[end, 2], tube[end, 3] = px, py, pz, step * (arc + 1)
        a, b, c = 1.0 - kx * kx * versine, -kx * ky * versine, 1.0 - ky * ky * versine
        sx, sy = kx * sine, ky * sine
        ux, vx, tx = a * ux + b * vx - sx * tx, b * ux + c * vx - sy * tx, sx * ux + sy * vx + cos * tx
        uy, vy, ty = a * uy + b * vy - sx * ty, b * uy + c * vy - sy * ty, sx * uy + sy * vy + cos * ty
        uz, vz, tz = a * uz + b * vz - sx * tz, b * uz + c * vz - sy * tz, sx * uz + sy * vz + cos * tz
    pose[0], pose[1], pose[2] = px + k[7] * ux, py + k[7] * uy, pz + k[7] * uz
    pose[3], pose[4], pose[5], pose[6], pose[7], pose[8] = vx, vy, vz, tx, ty, tz
    pose[9], pose[10], pose[11] = lowest - k[TUBE_RADIUS], pz - k[5] * uz, pz + (k[6] - k[5]) * uz
    nearest = np.inf
    for i in range(TUBE):
        for j in range(i + 1, TUBE):
            if tube[j, 3] - tube[i, 3] >= k[16]:
                nearest = min(
                    nearest,
                    (tube[i, 0] - tube[j, 0]) ** 2
                    + (tube[i, 1] - tube[j, 1]) ** 2
                    + (tube[i, 2] - tube[j, 2]) ** 2,
                )
    pose[12] = max(2.0 * k[TUBE_RADIUS] + _BETWEEN - math.sqrt(nearest), 0.0)


@njit(cache=True)
def point(pose, k, theta1, theta2):
    """Return P5 for joint angles, m."""
    sin, cos = k[8] * math.sin(theta2), k[8] * math.cos(theta2)
    x = pose[0] + sin * pose[3] - cos * pose[6]
    y = pose[1] + sin * pose[4] - cos * pose[7]
    c, s = math.cos(theta1), math.sin(theta1)
    return c * x - s * y, s * x + c * y, pose[2] + sin * pose[5] - cos * pose[8]


@njit(cache=True)
def rod_depth(pose, k, tube, theta2):
    """Return how deep the rigid link is inside the tube at an angle of joint 2, m."""
    end = tube[TUBE - 1]
    x, y, z = point(pose, k, 0.0, theta2)
    rx, ry, rz = x - end[0], y - end[1], z - end[2]
    length = math.sqrt(rx * rx + ry * ry + rz * rz)
    from_joint = 2.0 * k[TUBE_RADIUS]  # within a diameter of the second joint link and rod are the joint
    nearest = np.inf
    for i in range(TUBE):
        if tube[i, 3] <= end[3] - from_joint:
            dx, dy, dz = tube[i, 0] - end[0], tube[i, 1] - end[1], tube[i, 2] - end[2]
            along = min(max((dx * rx + dy * ry + dz * rz) / length, from_joint), length) / length
            dx, dy, dz = dx - along * rx, dy - along * ry, dz - along * rz
            nearest = min(nearest, dx * dx + dy * dy + dz * dz)
    return max(k[TUBE_RADIUS] + k[15] + _BETWEEN - math.sqrt(nearest), 0.0)


@njit(cache=True)
def depth(height, floor):
    """Return the penalty for a height, m; none without a floor."""
    return PENALTY * max(floor - height, 0.0) if floor > -np.inf else 0.0
