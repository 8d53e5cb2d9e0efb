"""Surfaces that a few numbers describe, divided into cells of nearly one area.

A sphere, a tube, a torus and a disc are surfaces of revolution: bands about their axis, each divided into as
many cells as make them about square. Within a cell a straight way in the two parameters leads from its point
to any other; its length bounds how far that one is.
"""

from __future__ import annotations

import math
from enum import Enum

import numpy as np

from synth.arrays import FloatArray, GivenArray, frozen_value
from synth.checks import Checks
from synth.surfaces.cells import Cells

_TURN = 2.0 * math.pi
_LEAST_AROUND = 4  # cells of a band


class Profile(Enum):
    """Curves that a surface of revolution about z is swept by."""

    SPHERE = "sphere"
    CYLINDER = "cylinder"
    TORUS = "torus"
    DISC = "disc"


@frozen_value
class Revolved:
    """A sphere, the wall of a cylinder, a torus or a disc, about the z axis and centred at the origin.

    Attributes:
        profile: Which of these.
        radius: Its radius; of a torus that of the circle in its middle, m.
        extent: Length of a cylinder or radius of a torus's tube, m; no matter for the others.
    """

    profile: Profile
    radius: float
    extent: float = 0.0

    def __post_init__(self) -> None:
        checks = Checks(self)
        checks.is_a("profile", Profile)
        checks.number("radius", above=0.0)
        if self.profile in {Profile.CYLINDER, Profile.TORUS}:
            checks.number("extent", above=0.0)
        if self.profile is Profile.TORUS and not checks.found_in("extent") and self.extent >= self.radius:
            checks.report("extent", "the tube of a torus must be thinner than the circle that it is about")
        checks.refuse()

    @property
    def area(self) -> float:
        """Its area, m^2."""
        r, e = self.radius, self.extent
        return {
            Profile.SPHERE: 2.0 * _TURN * r**2,
            Profile.CYLINDER: _TURN * r * e,
            Profile.TORUS: _TURN**2 * r * e,
            Profile.DISC: 0.5 * _TURN * r**2,
        }[self.profile]

    @property
    def has_boundary(self) -> bool:
        """Whether it ends somewhere."""
        return self.profile in {Profile.CYLINDER, Profile.DISC}

    def boundary_distance(self, points: FloatArray) -> FloatArray:
        """Return how far points on it are from where it ends, shape (n,), m."""
        if self.profile is Profile.CYLINDER:
            return np.asarray(0.5 * self.extent - np.abs(points[:, 2]))
        if self.profile is Profile.DISC:
            return np.asarray(self.radius - np.hypot(points[:, 0], points[:, 1]))
        return np.full(len(points), math.inf)

    def cells(self, count: int) -> Cells:
        """Return about so many cells."""
        side = math.sqrt(self.area / count)
        bands = max(2, math.ceil(self._length / side))
        edges = np.linspace(0.0, self._length, bands + 1)
        middles, step = 0.5 * (edges[1:] + edges[:-1]), self._length / bands
        widest = self._widest(edges, middles)
        around = np.maximum(np.ceil(_TURN * widest / side), _LEAST_AROUND).astype(int)
        band = np.repeat(np.arange(bands), around)
        number = np.arange(len(band)) - np.repeat(np.cumsum(around) - around, around)
        angle = _TURN * (number + 0.5 * (band % 2)) / around[band]
        (rho, z), (outward, up) = (each[:, band] for each in self._curve(middles))
        cos, sin = np.cos(angle), np.sin(angle)
        half_around = 0.5 * _TURN * widest / around
        return Cells(
            np.column_stack([rho * cos, rho * sin, z]),
            np.column_stack([outward * cos, outward * sin, up]),
            (np.diff(self._area_up_to(edges)) / around)[band],
            np.hypot(0.5 * step, half_around)[band],
            self._curvatures(edges)[band],
        )

    @property
    def _length(self) -> float:
        """Length of the curve that is turned about z, m."""
        match self.profile:
            case Profile.SPHERE:
                return math.pi * self.radius
            case Profile.CYLINDER:
                return self.extent
            case Profile.TORUS:
                return _TURN * self.extent
            case _:
                return self.radius

    def _curve(self, along: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return (rho, z) and the normal in the half-plane at lengths of the curve, each (2, n)."""
        one, zero = np.ones_like(along), np.zeros_like(along)
        match self.profile:
            case Profile.SPHERE:
                normal = np.stack([np.sin(along / self.radius), np.cos(along / self.radius)])
                return self.radius * normal, normal
            case Profile.CYLINDER:
                return np.stack([self.radius * one, along - 0.5 * self.extent]), np.stack([one, zero])
            case Profile.TORUS:
                normal = np.stack([np.cos(along / self.extent), np.sin(along / self.extent)])
                return self.extent * normal + np.array([[self.radius], [0.0]]), normal
            case _:
                return np.stack([along, zero]), np.stack([zero, one])

    def _widest(self, edges: FloatArray, middles: FloatArray) -> FloatArray:
        """Return the largest rho within each band, shape (n,), m."""
        at_edges = self._curve(edges)[0][0]
        largest = np.maximum(at_edges[1:], at_edges[:-1])
        if self.profile is Profile.SPHERE:  # the equator may lie within a band
            holds = (edges[:-1] <= 0.25 * _TURN * self.radius) & (edges[1:] >= 0.25 * _TURN * self.radius)
            largest = np.where(holds, self.radius, largest)
        return np.asarray(np.maximum(largest, self._curve(middles)[0][0]))

    def _curvatures(self, edges: FloatArray) -> FloatArray:
        """Return the largest normal curvature within each band, shape (n,), 1/m."""
        bands = len(edges) - 1
        if self.profile is Profile.DISC:
            return np.zeros(bands)
        if self.profile is not Profile.TORUS:
            return np.full(bands, 1.0 / self.radius)
        # Around the axis it is cos(v) / rho, at its largest where rho is least: at an edge, or inmost.
        rho = self._curve(edges)[0][0]
        least = np.minimum(rho[1:], rho[:-1])
        inmost = 0.5 * _TURN * self.extent
        holds = (edges[:-1] <= inmost) & (edges[1:] >= inmost)
        least = np.where(holds, self.radius - self.extent, least)
        return np.asarray(np.maximum(1.0 / self.extent, np.abs(least - self.radius) / self.extent / least))

    def _area_up_to(self, along: FloatArray) -> FloatArray:
        """Return the area that the beginning of the curve sweeps, up to these lengths of it, m^2."""
        r, e = self.radius, self.extent
        match self.profile:
            case Profile.SPHERE:
                return np.asarray(_TURN * r**2 * (1.0 - np.cos(along / r)))
            case Profile.CYLINDER:
                return np.asarray(_TURN * r * along)
            case Profile.TORUS:
                return np.asarray(_TURN * (r * along + e**2 * np.sin(along / e)))
            case _:
                return np.asarray(0.5 * _TURN * along**2)


@frozen_value
class Rectangle:
    """A flat rectangle about the origin, its sides along x and y.

    Attributes:
        size: Its sides, shape (2,), m.
        has_boundary: Whether these are its own, and not only where a plane without end is cut off.
    """

    size: GivenArray
    has_boundary: bool = True

    def __post_init__(self) -> None:
        checks = Checks(self)
        checks.array("size", (2,), above=0.0)
        checks.refuse()

    @property
    def area(self) -> float:
        """Its area, m^2."""
        return float(np.prod(self.size))

    def boundary_distance(self, points: FloatArray) -> FloatArray:
        """Return how far points on it are from its sides, shape (n,), m."""
        return np.asarray((0.5 * self.size - np.abs(points[:, :2])).min(axis=1))

    def cells(self, count: int) -> Cells:
        """Return about so many cells."""
        along = np.maximum(np.ceil(self.size / math.sqrt(self.area / count)), 1).astype(int)
        steps = self.size / along
        x, y = (
            (np.arange(n) + 0.5) * step - 0.5 * side
            for n, step, side in zip(along.tolist(), steps, self.size, strict=True)
        )
        grid = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
        n = len(grid)
        points = np.column_stack([grid, np.zeros(n)])
        towards = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
        return Cells(
            points,
            np.tile([0.0, 0.0, 1.0], (n, 1)),
            np.full(n, float(np.prod(steps))),
            np.full(n, 0.5 * float(np.hypot(*steps))),
            np.zeros(n),
            points[:, None] + 0.5 * np.append(steps, 0.0) * towards,
        )
