"""The miss of a shape as residuals with their derivatives, compiled: for the peers that ask for them."""

from __future__ import annotations

import math

import numpy as np
from compiled_link import PENALTY, TUBE, UNKNOWNS, depth, follow, point, rod_depth
from compiled_miss import closest
from numba import njit

_DIFFERENCE = 1e-7  # step of the differences over the unknowns, which are of order one
_TURN = 1e-4  # rad, to either side


@njit(cache=True)
def residuals(x, k, targets):
    """Return P5 - target over sqrt(n) for each target, and all depths: shape (4 n + 4,)."""
    pose, tube, joints = np.empty(13), np.empty((TUBE, 4)), np.empty((len(targets), 2))
    follow(x, k, pose, tube)
    closest(pose, k, tube, targets, joints)
    return _rows(pose, k, tube, targets, joints)


@njit(cache=True)
def _rows(pose, k, tube, targets, joints):
    n = len(targets)
    rows = np.empty(4 * n + 4)
    scale = 1.0 / math.sqrt(n)
    for i in range(n):
        p5 = point(pose, k, joints[i, 0], joints[i, 1])
        for axis in range(3):
            rows[3 * i + axis] = scale * (p5[axis] - targets[i, axis])
    for part in range(3):
        rows[3 * n + part] = depth(pose[9 + part], k[13])
    rows[3 * n + 3] = PENALTY * pose[12]
    for i in range(n):
        rows[3 * n + 4 + i] = scale * PENALTY * rod_depth(pose, k, tube, joints[i, 1])
    return rows


@njit(cache=True)
def jacobian(x, k, targets):
    """Return the derivatives of `residuals` across the directions in which the joints are free."""
    n = len(targets)
    pose, tube, joints = np.empty(13), np.empty((TUBE, 4)), np.empty((n, 2))
    moved, moved_tube = np.empty(13), np.empty((TUBE, 4))
    follow(x, k, pose, tube)
    closest(pose, k, tube, targets, joints)
    rows = _rows(pose, k, tube, targets, joints)
    slopes = np.empty((4 * n + 4, UNKNOWNS))
    nearby = x.copy()
    for unknown in range(UNKNOWNS):
        nearby[unknown] = x[unknown] + _DIFFERENCE
        follow(nearby, k, moved, moved_tube)
        slopes[:, unknown] = (_rows(moved, k, moved_tube, targets, joints) - rows) / _DIFFERENCE
        nearby[unknown] = x[unknown]
    for i in range(n):
        theta1, theta2 = joints[i]
        here = point(pose, k, theta1, theta2)
        after, before = point(pose, k, theta1, theta2 + _TURN), point(pose, k, theta1, theta2 - _TURN)
        first = np.array([-here[1], here[0], 0.0])
        second = np.array([after[0] - before[0], after[1] - before[1], after[2] - before[2]])
        if abs(theta1 - k[9]) > k[10] - 1e-9:
            first[:] = 0.0
        else:
            first /= math.sqrt(first @ first) + 1e-300
            second -= (second @ first) * first
        if theta2 < k[11] + 1e-9 or theta2 > k[12] - 1e-9:
            second[:] = 0.0
        else:
            second /= math.sqrt(second @ second) + 1e-300
        for unknown in range(UNKNOWNS):
            column = slopes[3 * i : 3 * i + 3, unknown].copy()
            slopes[3 * i : 3 * i + 3, unknown] = (
                column - (column @ first) * first - (column @ second) * second
            )
    return slopes
