"""Targets of arms known by their invariants, and how far answers of exact synthesis are from these."""

import numpy as np

from synth.geometry import arms_through_five, arms_through_four

RADIUS = 0.4545  # m, of the prototype


def targets_of(values, count, rng):
    """Return targets at random joint angles of designs, shape (S, 5): points of the circle, turned."""
    a, alpha, z0, h, radius = np.moveaxis(values[:, None], -1, 0)
    theta1, t = rng.uniform(0, 2 * np.pi, (2, len(values), count))
    x = a + radius * np.cos(t)
    y = h * np.sin(alpha) + radius * np.sin(t) * np.cos(alpha)
    z = z0 + h * np.cos(alpha) - radius * np.sin(t) * np.sin(alpha)
    c, s = np.cos(theta1), np.sin(theta1)
    return np.stack([c * x - s * y, s * x + c * y, z], axis=-1)


def random_values(rng, count):
    """Return skew arms of realistic size, in the representative that answers have."""
    return rng.uniform([0.05, 0.3, -0.3, -0.5, 0.1], [0.5, np.pi / 2, 0.6, 0.5, 0.6], (count, 5))


def half_ball(rng, sets, count, reach=1.1):
    """Return random targets above the base."""
    direction = rng.normal(size=(sets, count, 3))
    direction[..., 2] = np.abs(direction[..., 2])
    distance = reach * rng.uniform(size=(sets, count, 1)) ** (1 / 3)
    return distance * direction / np.linalg.norm(direction, axis=-1, keepdims=True)


def errors(designs, planted):
    """Return the error of the nearest answer: lengths over the longest one of the arm, and angles in rad.

    At alpha = pi/2, rounding decides which of the two ways of writing the same axis is the representative.
    """
    lengths = np.array([1, 0, 1, 1, 1], dtype=bool)
    turned = np.stack([planted, [0, np.pi, 0, 0, 0] + planted * [1, -1, 1, -1, 1]], axis=1)
    apart = np.abs(designs.values[:, :, None] - turned[:, None])
    apart[..., lengths] /= np.max(np.abs(planted[:, lengths]), axis=-1)[:, None, None, None]
    return np.min(np.nan_to_num(np.max(apart, axis=-1), nan=np.inf), axis=(-1, -2))


def through(targets, radius):
    """Ask for the designs of either kind."""
    return arms_through_five(targets) if radius is None else arms_through_four(targets, radius)
