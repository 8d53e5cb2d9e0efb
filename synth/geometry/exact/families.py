"""Exact designs of the degenerate kinds, which come in families: planes, spheres and single circles.

Where the axes are parallel, P5 fills an annulus, where they meet, a band of a sphere; and a target fixes
nothing beyond the plane or the sphere but that the annulus or the band must hold it. What remains free is
here a parameter with its range.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen_value
from synth.errors import GeometryError
from synth.geometry.exact.exact_arms import TOLERANCE
from synth.geometry.invariants import Invariants

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


# Heights that differ by less, as a fraction of the targets' extent, do not tell the centre of a sphere.
_LEVEL = 1e-9
# What a parameter may be off its range, being computed itself.
_ROUNDING = 1e-12


@frozen_value
class PlaneFamily:
    """All arms with parallel axes (SCARA) through targets in one plane across axis 1.

    P5 fills the annulus |a - R| <= rho <= a + R. Free are R >= (outer - inner) / 2 and a in
    [max(outer - R, R - inner), R + inner]; swapping a and R gives the cognate.

    Attributes:
        z: Height of the plane, m.
        inner: Distance of the nearest target from axis 1, m.
        outer: Distance of the farthest target from axis 1, m.
    """

    z: float
    inner: float
    outer: float

    @property
    def smallest_radius(self) -> float:
        """Smallest R of the family, m; there is no largest."""
        return 0.5 * (self.outer - self.inner)

    def a_range(self, radius: float) -> tuple[float, float]:
        """Return the smallest and the largest a for R, m.

        Raises:
            GeometryError: If R is below `smallest_radius`.
        """
        if radius < self.smallest_radius:
            raise GeometryError(f"R = {radius:.6g} m is less than half the width of the targets' annulus.")
        return max(self.outer - radius, radius - self.inner), radius + self.inner

    def design(self, radius: float, a: float) -> Invariants:
        """Return the arm with R and a, m.

        Raises:
            GeometryError: If they are outside their ranges, so that a target is missed.
        """
        _refuse_outside("a", a, self.a_range(radius))
        return Invariants(a, 0.0, self.z, 0.0, radius)


@frozen_value
class SphereFamily:
    """All arms whose axes meet through targets on one sphere about a point of axis 1.

    With r the radius of the sphere and delta the angle of axis 2 to P5 (h = r cos(delta), R = r sin(delta)),
    P5 fills the band of the sphere between |alpha - delta| and pi - |pi - alpha - delta| from the
    direction of axis 1. Free are delta in `opening_range` and alpha in `alpha_range`; swapping the
    two gives the cognate. Seen from the centre it is the plane's annulus: arcs instead of lengths.

    Attributes:
        z0: Height of the centre, where the axes meet, m: 0 if spherical, d12 if PUMA-like.
        sphere_radius: Radius r of the sphere, m.
        first: Smallest angle of a target from the direction of axis 1, seen from the centre, rad.
        last: Largest such angle, rad.
    """

    z0: float
    sphere_radius: float
    first: float
    last: float

    @property
    def opening_range(self) -> tuple[float, float]:
        """Smallest and largest delta, rad, that some alpha in [0, pi/2] goes with."""
        half_width, quarter = 0.5 * (self.last - self.first), 0.5 * math.pi
        return max(half_width, self.last - quarter), min(math.pi - half_width, self.first + quarter)

    def openings(self, radius: float) -> tuple[float, ...]:
        """Return every delta for a known R, m, in `opening_range`: none, one or two (h > 0 and h < 0)."""
        if not 0.0 <= radius <= (1.0 + _ROUNDING) * self.sphere_radius:
            return ()
        acute = math.asin(min(radius / self.sphere_radius, 1.0))
        lower, upper = self.opening_range
        return tuple(delta for delta in dict.fromkeys((acute, math.pi - acute)) if lower <= delta <= upper)

    def alpha_range(self, opening: float) -> tuple[float, float]:
        """Return the smallest and the largest alpha for delta, rad, in [0, pi/2].

        Raises:
            GeometryError: If delta is outside `opening_range`.
        """
        _refuse_outside("delta", opening, self.opening_range)
        lower = max(self.last - opening, opening - self.first, 0.0)
        return lower, min(opening + self.first, 2.0 * math.pi - opening - self.last, 0.5 * math.pi)

    def design(self, opening: float, alpha: float) -> Invariants:
        """Return the arm with delta and alpha, rad.

        Raises:
            GeometryError: If they are outside their ranges, so that a target is missed.
        """
        _refuse_outside("alpha", alpha, self.alpha_range(opening))
        r = self.sphere_radius
        return Invariants(0.0, alpha, self.z0, r * math.cos(opening), r * math.sin(opening))


def planes_through(targets: ArrayLike, *, tolerance: float = TOLERANCE) -> PlaneFamily | None:
    """Return the arms with parallel axes through targets, or None if those are in no plane across axis 1.

    Args:
        targets: Any number of them, shape (n, 3), m.
        tolerance: Largest distance of a target from the plane, m.

    Raises:
        GeometryError: If there is no target or one is not finite.
    """
    rho, z = _half_plane(targets)
    middle = 0.5 * (z.min() + z.max())
    if z.max() - middle > tolerance:
        return None
    return PlaneFamily(float(middle), float(rho.min()), float(rho.max()))


def spheres_through(
    targets: ArrayLike, *, centre: float | None = None, tolerance: float = TOLERANCE
) -> SphereFamily | None:
    """Return the arms whose axes meet through targets, or None if those are on no sphere about axis 1.

    A sphere is linear in (z, N): N - 2 z0 z = r^2 - z0^2, solved by least squares.

    Args:
        targets: Any number of them, shape (n, 3), m; of two heights at least, unless the centre is given.
        centre: Height z0 where the axes are to meet (0: spherical, d12: PUMA-like), m; or any.
        tolerance: Largest distance of a target from the sphere, m.

    Raises:
        GeometryError: If there is no target or one is not finite.
    """
    rho, z = _half_plane(targets)
    if centre is None:
        mean = z.mean()
        n = rho**2 + (z - mean) ** 2
        variance = np.mean((z - mean) ** 2)
        if variance <= _LEVEL**2 * n.mean():
            return None
        centre = float(mean + 0.5 * np.mean(n * (z - mean)) / variance)
    distances = np.hypot(rho, z - centre)
    r = 0.5 * float(distances.min() + distances.max())
    if distances.max() - r > tolerance or r == 0.0:
        return None
    angles = np.arctan2(rho, z - centre)
    return SphereFamily(centre, r, float(angles.min()), float(angles.max()))


def circle_through(targets: ArrayLike, *, tolerance: float = TOLERANCE) -> Invariants | None:
    """Return the arm with coincident axes through targets, or None if those are on no circle about axis 1.

    Both joints then turn P5 on the same circle, and one of them is idle.

    Args:
        targets: Any number of them, shape (n, 3), m.
        tolerance: Largest difference of their distances from axis 1, or of their heights, from the mean, m.

    Raises:
        GeometryError: If there is no target or one is not finite.
    """
    rho, z = _half_plane(targets)
    radius, height = rho.mean(), z.mean()
    if max(np.abs(rho - radius).max(), np.abs(z - height).max()) > tolerance:
        return None
    return Invariants(0.0, 0.0, float(height), 0.0, float(radius))


def _half_plane(targets: ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Return the distances of targets from axis 1 and their heights, each of shape (n,), m."""
    array = np.asarray(targets, dtype=np.float64)
    if array.ndim != 2 or array.shape[0] == 0 or array.shape[1] != 3 or not np.all(np.isfinite(array)):
        raise GeometryError("Targets must be points of three finite numbers, at least one of them.")
    return np.hypot(array[:, 0], array[:, 1]), array[:, 2]


def _refuse_outside(name: str, value: float, bounds: tuple[float, float]) -> None:
    """Raise an error if a parameter is outside its range by more than rounding."""
    lower, upper = bounds
    margin = _ROUNDING * (1.0 + abs(upper))
    if not lower - margin <= value <= upper + margin:
        raise GeometryError(f"{name} = {value:.6g} is not between {lower:.6g} and {upper:.6g}.")
