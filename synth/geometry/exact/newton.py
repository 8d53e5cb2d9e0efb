"""Designs brought to machine precision on their targets, measured, folded and sorted.

A design is a row of five numbers (a, alpha, z0, h, R). On its circle, with t the angle about axis 2 from
the direction of the common normal, P5 has

    N0 = K + 2 a R cos(t)   and   z = z0 + h cos(alpha) - R sin(alpha) sin(t),

N0 its squared distance from the foot of the common normal on axis 1. Solved for (cos t, sin t) = (X, Y),
a target lies on the swept surface exactly if X^2 + Y^2 = 1. Unlike Gamma this is regular for
arms whose axes nearly meet, and |X^2 + Y^2 - 1| / |grad (X^2 + Y^2)| is the distance to first order.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.arrays import FloatArray

_STEPS = 12
# Two answers of one set closer than this, relative to their lengths, came from one double root.
_SAME = 1e-7
# Of least squares: the first damping; what is added to small scales, of the largest; a step, m or rad.
_FIRST_DAMPING, _LEAST_SCALE, _FARTHEST = 1e-3, 1e-3, 0.2


def polish(designs: FloatArray, rho: FloatArray, z: FloatArray, *, fixed_radius: bool) -> FloatArray:
    """Return designs after Newton's method on as many targets as they have unknowns.

    A step is kept only where it brings the worst target closer: at machine precision, or where the
    Jacobian is singular because two designs meet, a design stays where it is.

    Args:
        designs: Starts, shape (C, 5).
        rho: Distances of the n targets from axis 1, shape (C, n), m.
        z: Their heights, shape (C, n), m.
        fixed_radius: Whether R is known (n = 4) or the fifth unknown (n = 5).
    """
    unknowns = 4 if fixed_radius else 5
    residual, jacobian = _residuals(designs, rho, z)
    active = np.flatnonzero(np.isfinite(residual).all(axis=-1) & np.isfinite(jacobian).all(axis=(-1, -2)))
    designs, residual, jacobian = designs.copy(), residual[active], jacobian[active]
    for _ in range(_STEPS):
        if active.size == 0:
            break
        trial = designs[active]
        trial[:, :unknowns] -= _solved(jacobian[..., :unknowns], residual)
        after, slopes = _residuals(trial, rho[active], z[active])
        # A trial that is not finite compares as not better, and a design that stays would stay again.
        better = np.max(np.abs(after), axis=-1) < np.max(np.abs(residual), axis=-1)
        better &= np.isfinite(slopes).all(axis=(-1, -2))
        active, residual, jacobian = active[better], after[better], slopes[better]
        designs[active] = trial[better]
    return designs


def least_squares(
    designs: FloatArray,
    rho: FloatArray,
    z: FloatArray,
    weights: FloatArray,
    steps: int,
    *,
    fixed_radius: bool,
) -> FloatArray:
    """Return designs led towards the least weighted sum of squared distances, by damped Gauss-Newton steps.

    Args:
        designs: Starts, shape (C, 5).
        rho: Distances of the n targets from axis 1, shape (n,), m.
        z: Their heights, shape (n,), m.
        weights: Of the squared distances, shape (n,).
        steps: How many.
        fixed_radius: As for `polish`.
    """
    unknowns = 4 if fixed_radius else 5
    root, unit = np.sqrt(weights), np.eye(unknowns)
    damping, designs = np.full(len(designs), _FIRST_DAMPING), designs.copy()
    residual, jacobian = _residuals(designs, rho, z)
    for _ in range(steps if len(designs) else 0):
        weighted = jacobian[..., :unknowns] * root[:, None]
        transposed = weighted.transpose(0, 2, 1)
        curvature, slope = transposed @ weighted, (transposed @ (residual * root)[..., None])[..., 0]
        scale = np.einsum("cii->ci", curvature)
        scale = scale + _LEAST_SCALE * scale.max(axis=1, keepdims=True)
        step = _solved(curvature + (damping[:, None] * scale)[:, :, None] * unit, slope)
        trial = designs.copy()
        trial[:, :unknowns] -= np.clip(step, -_FARTHEST, _FARTHEST)
        after, slopes = _residuals(trial, rho, z)
        better = np.sum(weights * after**2, axis=1) < np.sum(weights * residual**2, axis=1)
        better &= np.isfinite(slopes).all(axis=(-1, -2))
        designs[better], residual[better], jacobian[better] = trial[better], after[better], slopes[better]
        damping = np.where(better, 0.2 * damping, 8.0 * damping)
    return designs


def squared_distances(designs: FloatArray, rho: FloatArray, z: FloatArray) -> FloatArray:
    """Return squared distances of n targets from designs, shape (C, 5), to first order, shape (C, n), m^2."""
    return np.asarray(_residuals(designs, rho, z)[0] ** 2)


def _solved(matrix: FloatArray, right: FloatArray) -> FloatArray:
    """Return the solutions of linear systems, shape (C, n); of least squares where one has none."""
    try:
        return np.asarray(np.linalg.solve(matrix, right[..., None])[..., 0])
    except np.linalg.LinAlgError:
        # One singular matrix stops them all, and the slower way serves them all.
        return np.asarray((np.linalg.pinv(matrix) @ right[..., None])[..., 0])


def _residuals(designs: FloatArray, rho: FloatArray, z: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return distances to first order, shape (C, n), m, and their Jacobian, shape (C, n, 5)."""
    a, alpha, z0, h, radius = np.moveaxis(designs[:, None, :], -1, 0)
    sine, cosine = np.sin(alpha), np.cos(alpha)
    x, y = _cosine_and_sine(designs, rho, z)
    along_n, along_z, height = x / (a * radius), y / (radius * sine), z - z0
    gradient = np.hypot(along_n * rho, along_n * height - along_z)
    columns = (
        -x * (1.0 / radius + x / a),
        -y * (h / radius + y * cosine / sine),
        along_z - along_n * height,
        along_z * cosine - along_n * h,
        -x / a - (x**2 + y**2) / radius,
    )
    jacobian = np.stack(columns, axis=-1) / gradient[..., None]
    return 0.5 * (x**2 + y**2 - 1.0) / gradient, jacobian


def _cosine_and_sine(designs: FloatArray, rho: FloatArray, z: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return X and Y of the targets of each design, shape (..., n).

    N0 - K is taken about the centre of the circle: of nearly parallel axes, whose common normal is far away,
    z0 and h would only leave the rounding of their squares.
    """
    a, alpha, z0, h, radius = np.moveaxis(designs[..., None, :], -1, 0)
    lift = h * np.cos(alpha)
    z = z - (z0 + lift)
    excess = rho**2 + z * (z + 2.0 * lift) - (a**2 + (h * np.sin(alpha)) ** 2 + radius**2)
    return excess / (2.0 * a * radius), -z / (radius * np.sin(alpha))


def misses(designs: FloatArray, rho: FloatArray, z: FloatArray) -> FloatArray:
    """Return how far the worst target is from the circle swept about axis 1, at most, shape (...), m.

    It is the distance in the half-plane (rho, z) to the point of the circle at atan2(Y, X), computed from
    its coordinates and not from N: an upper bound of the true distance, and equal to it to second order.

    Args:
        designs: Shape (..., 5).
        rho: Distances of the targets from axis 1, shape (..., n), m.
        z: Their heights, shape (..., n), m.
    """
    x, y = _cosine_and_sine(designs, rho, z)
    length = np.hypot(x, y)
    cosine, sine = x / length, y / length
    a, alpha, z0, h, radius = np.moveaxis(designs[..., None, :], -1, 0)
    outwards = np.hypot(a + radius * cosine, h * np.sin(alpha) + radius * sine * np.cos(alpha))
    upwards = z0 + h * np.cos(alpha) - radius * np.sin(alpha) * sine
    return np.asarray(np.max(np.hypot(outwards - rho, upwards - z), axis=-1))


def folded(designs: FloatArray) -> FloatArray:
    """Return the representative of designs, shape (..., 5): a, R >= 0, alpha <= pi/2, and h >= 0 at pi/2.

    Axis 2 may be turned round, (alpha, h) into (pi - alpha, -h); and Newton's method does not know that
    lengths are positive.
    """
    a, alpha, z0, h, radius = np.moveaxis(designs, -1, 0)
    reversed_ = np.cos(alpha) < 0.0
    h = np.where(reversed_, -h, h)
    alpha = np.abs(np.arctan2(np.sin(alpha), np.cos(alpha)))
    alpha = np.where(reversed_, np.pi - alpha, alpha)
    h = np.where(alpha == 0.5 * np.pi, np.abs(h), h)
    return np.stack([np.abs(a), alpha, z0, h, np.abs(radius)], axis=-1)


def sorted_without_twins(designs: FloatArray) -> tuple[FloatArray, NDArray[np.intp]]:
    """Return designs, shape (S, k, 5), by rising a, with nan for twins and last; and their order, (S, k)."""
    lengths = designs[..., [0, 2, 3, 4]]
    scale = np.max(np.abs(lengths), axis=-1)[..., None, None]
    numbers = np.concatenate([lengths, designs[..., 1:2]], axis=-1)
    apart = np.abs(numbers[..., :, None, :] - numbers[..., None, :, :])
    apart[..., :4] /= scale
    twins = np.tril(np.max(apart, axis=-1) < _SAME, k=-1).any(axis=-1)
    designs = np.where(twins[..., None], np.nan, designs)
    order = np.argsort(designs[..., 0], axis=-1)
    return np.take_along_axis(designs, order[..., None], axis=-2), order
