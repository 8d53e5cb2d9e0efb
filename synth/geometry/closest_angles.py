"""The closest point of a swept circle: the least of all minima of the distance along its section."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import frozen_value
from synth.geometry.trigonometric import critical_angles, root_angles, sampling_angles

if TYPE_CHECKING:
    from synth.arrays import FloatArray

_DEGREE = 4  # of the stationarity condition, below
_BLOCK = 2048  # points at a time: what they need stays in the processor's cache
_TINY = np.finfo(np.float64).tiny
_ROUNDING = 4.0 * np.finfo(np.float64).eps
_BESIDE = 1e-14  # rad


def closest_angles(
    centre: FloatArray, start: FloatArray, quarter: FloatArray, rho: FloatArray, z: FloatArray
) -> FloatArray:
    """Return the angles t at which the circle c + cos(t) s + sin(t) q, swept about z, is nearest to points.

    In the half-plane (rho, z) the surface is one closed curve (rho(t), z(t)). With A = N(t) / 2 - z z(t)
    and B = rho(t)^2 along the circle, the squared distance is a constant plus 2 A - 2 rho sqrt(B), and
    stationary only where Q = 4 A'^2 B - (rho B')^2 = 0: a trigonometric polynomial of degree 4, so at no
    more than eight angles. They separate the minima, together with the sharp turns of the curve, an even
    grid (Q may vanish everywhere, as for the centre of a circle in a plane with axis 1) and the middles
    between all these. Each minimum lies where the slope of the distance changes from falling to rising,
    and is found there within a bracket (Chandrupatla, 1997), which no multiplicity of the root can mislead.

    Args:
        centre: Its centre c, shape (3,), m.
        start: From there to where it begins, s, shape (3,), m.
        quarter: Likewise after a quarter of it, q, shape (3,), m.
        rho: Distances from axis 1, shape (n,), m.
        z: Heights, shape (n,), m.

    Returns:
        Shape (n,), rad.
    """
    section = _Section.of(centre, start, quarter)
    blocks = range(_BLOCK, len(rho), _BLOCK)
    parts = zip(np.split(rho, blocks), np.split(z, blocks), strict=True)
    return np.concatenate([_closest_in_block(section, *part) for part in parts])


@frozen_value
class _Section:
    """The curve (rho(t), z(t)) of P5(t) = c + cos(t) s + sin(t) q, with s and q of length R.

    It turns sharply, or all but does, where the circle passes close to axis 1, and at the rims of nearly
    flat tubes, where it moves hardly at all. Minima to both sides of such a place may be as close
    together as one likes: the angles `turning` keep them apart.
    """

    centre: FloatArray
    start: FloatArray
    quarter: FloatArray
    turning: FloatArray

    @classmethod
    def of(cls, centre: FloatArray, start: FloatArray, quarter: FloatArray) -> _Section:
        bare = cls(centre, start, quarter, np.empty(0))
        x, y, _, dx, dy, dz = bare.point(sampling_angles(_DEGREE))
        rims = critical_angles((x * dx + y * dy) ** 2 + (x**2 + y**2) * dz**2)
        passing = critical_angles((x**2 + y**2)[::2])
        for _ in range(2):  # Gauss and Newton: to rounding where the circle all but meets axis 1
            x, y, _, dx, dy, _ = bare.point(passing)
            step = (x * dx + y * dy) / np.maximum(dx**2 + dy**2, _TINY)
            passing = passing - np.clip(step, -1e-6, 1e-6)
        turning = np.concatenate([rims, passing - _BESIDE, passing + _BESIDE])
        return cls(centre, start, quarter, turning)

    def point(self, t: FloatArray) -> tuple[FloatArray, ...]:
        """Return x, y, z of P5 and their derivatives by t."""
        cos, sin = np.cos(t), np.sin(t)
        frame = list(zip(self.centre.tolist(), self.start.tolist(), self.quarter.tolist(), strict=True))
        return (
            *(c + (cos * s + sin * q) for c, s, q in frame),
            *(cos * q - sin * s for _, s, q in frame),
        )

    def miss(self, t: FloatArray, rho: FloatArray, z: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the distance of (rho, z) from the curve's point at t, and half its square's derivative.

        The derivative is a product of differences, each to rounding: near a root of any multiplicity its
        sign is wrong only where the point itself is right to rounding.
        """
        x, y, height, dx, dy, dz = self.point(t)
        radial = np.hypot(x, y)
        out, up = radial - rho, height - z
        return np.hypot(out, up), out * (x * dx + y * dy) / np.maximum(radial, _TINY) + up * dz


def _closest_in_block(section: _Section, rho: FloatArray, z: FloatArray) -> FloatArray:
    rho_, z_ = rho[:, None], z[:, None]
    x, y, height, dx, dy, dz = section.point(sampling_angles(_DEGREE))
    b, half_db = x**2 + y**2, x * dx + y * dy
    q = (half_db + (height - z_) * dz) ** 2 * b - (rho_ * half_db) ** 2
    shared = np.concatenate([sampling_angles(_DEGREE) - np.pi, section.turning])
    angles = np.concatenate([root_angles(q), np.broadcast_to(shared, (len(rho), len(shared)))], axis=-1)
    angles.sort(axis=-1)
    angles = np.concatenate([angles, angles[:, :1] + 2.0 * np.pi], axis=-1)
    middles = 0.5 * (angles[:, :-1] + angles[:, 1:])
    angles = np.sort(np.concatenate([angles, middles], axis=-1), axis=-1)
    misses, slopes = section.miss(angles, rho_, z_)

    # The samples decide only where there is no slope, as for a circle of no radius.
    sampled = np.argmin(misses, axis=-1)[:, None]
    best = np.take_along_axis(angles, sampled, axis=-1)[:, 0]
    least = np.take_along_axis(misses, sampled, axis=-1)[:, 0]
    falling = slopes < 0.0
    which, left = np.nonzero(falling[:, :-1] & ~falling[:, 1:])
    lower, upper, rho, z = angles[which, left], angles[which, left + 1], rho[which], z[which]
    bottoms = _roots(section, lower, upper, rho, z)
    misses = section.miss(bottoms, rho, z)[0]
    order = np.lexsort((misses, which))
    which, first = np.unique(which[order], return_index=True)
    found = order[first]
    size = np.linalg.norm(section.centre) + np.linalg.norm(section.start)
    as_near = misses[found] <= least[which] + _ROUNDING * (size + rho[found] + np.abs(z[found]))
    best[which[as_near]] = bottoms[found[as_near]]
    return best


def _roots(
    section: _Section, lower: FloatArray, upper: FloatArray, rho: FloatArray, z: FloatArray
) -> FloatArray:
    """Return where the distances of points stop falling, within brackets that nothing leads out of."""
    if not len(lower):
        return upper
    # 0.7 s to import, paid only when it is used; scipy has no types of its own.
    from scipy.optimize.elementwise import find_root  # type: ignore[import-untyped]  # noqa: PLC0415

    found = find_root(lambda *at: section.miss(*at)[1], (lower, upper), args=(rho, z))
    return np.asarray(found.x)
