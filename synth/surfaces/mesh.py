"""Surfaces of triangles, and of points alone."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, GivenArray, GivenArrayOrNone, frozen, frozen_value, given
from synth.checks import Checks
from synth.surfaces.cells import Cells

if TYPE_CHECKING:
    from numpy.typing import NDArray

_SPLIT_AT_MOST = 300  # parts of one edge
_MORE = 1.2  # times as many cells as asked for, at most
_SPACING = 1e-3  # of points along a boundary, as a share of the mesh's size


@frozen_value
class TriangleMesh:
    """Triangles; those of no area do not count.

    Attributes:
        corners: Corners of each, anticlockwise as seen from outside, shape (m, 3, 3), m.
    """

    corners: GivenArray
    has_boundary = True

    def __post_init__(self) -> None:
        checks = Checks(self)
        if checks.array("corners", (None, 3, 3)):
            doubled = np.linalg.norm(self._crossed(self.corners), axis=1)
            flat = doubled <= 1e-12 * np.square(self.corners - self.corners[:, :1]).sum(axis=(1, 2))
            object.__setattr__(self, "corners", frozen(self.corners[~flat]))
            if not len(self.corners):
                checks.report("corners", "must hold a triangle that has an area, but holds none")
        checks.refuse()

    @staticmethod
    def _crossed(corners: FloatArray) -> FloatArray:
        return np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])

    @cached_property
    def face_areas(self) -> FloatArray:
        """Area of each triangle, shape (m,), m^2."""
        return np.asarray(0.5 * np.linalg.norm(self._crossed(self.corners), axis=1))

    @property
    def area(self) -> float:
        """Its area, m^2."""
        return float(self.face_areas.sum())

    def cells(self, count: int) -> Cells:
        """Return about so many cells, no fewer than triangles: each triangle is divided into equal ones."""
        parts = self._parts(count)
        normals = self._crossed(self.corners) / (2.0 * self.face_areas[:, None])
        pieces, owners = [], []
        for number in np.unique(parts).tolist():
            chosen = np.flatnonzero(parts == number)
            shares = _shares(number)
            pieces.append(np.einsum("sck,mkx->mscx", shares, self.corners[chosen]).reshape(-1, 3, 3))
            owners.append(np.repeat(chosen, len(shares)))
        owner, corners = np.concatenate(owners), np.concatenate(pieces)
        from_middle = self.corners - self.corners.mean(axis=1, keepdims=True)
        radii = np.linalg.norm(from_middle, axis=2).max(axis=1) / parts
        areas = (self.face_areas / parts**2)[owner]
        flat = np.zeros(len(owner))
        return Cells(corners.mean(axis=1), normals[owner], areas, radii[owner], flat, corners)

    def _parts(self, count: int) -> NDArray[np.intp]:
        """Return into how many parts to divide the sides of each triangle, shape (m,)."""
        side = math.sqrt(self.area / count)
        while True:
            parts = np.clip(np.ceil(np.sqrt(self.face_areas) / side), 1, _SPLIT_AT_MOST).astype(int)
            if int(np.sum(parts**2)) <= _MORE * max(count, len(parts)):
                return parts
            side *= 1.1

    def boundary_distance(self, points: FloatArray) -> FloatArray:
        """Return how far points on it are from edges of one triangle only, shape (n,), m, to a thousandth."""
        from scipy.spatial import cKDTree  # type: ignore[import-untyped]  # noqa: PLC0415

        if not len(self.boundary):
            return np.full(len(points), math.inf)
        size = float(np.ptp(self.corners.reshape(-1, 3), axis=0).max())
        lengths = np.linalg.norm(self.boundary[:, 1] - self.boundary[:, 0], axis=1)
        number = np.ceil(lengths / (_SPACING * size)).astype(int) + 1
        edge = np.repeat(np.arange(len(number)), number)
        share = (np.arange(len(edge)) - np.repeat(np.cumsum(number) - number, number)) / (number - 1)[edge]
        start, end = self.boundary[edge, 0], self.boundary[edge, 1]
        return np.asarray(cKDTree(start + share[:, None] * (end - start)).query(points)[0])

    @cached_property
    def boundary(self) -> FloatArray:
        """Edges that belong to one triangle only, shape (k, 2, 3), m; corners as near as rounding are one."""
        flat = self.corners.reshape(-1, 3)
        grid = 1e-7 * max(float(np.ptp(flat, axis=0).max()), 1e-12)
        _, corner = np.unique(np.round(flat / grid).astype(np.int64), axis=0, return_inverse=True)
        ends = corner.reshape(-1, 3)
        edges = np.stack([ends, np.roll(ends, -1, axis=1)], axis=-1).reshape(-1, 2)
        where = np.stack([self.corners, np.roll(self.corners, -1, axis=1)], axis=2).reshape(-1, 2, 3)
        _, first, counts = np.unique(np.sort(edges, axis=1), axis=0, return_index=True, return_counts=True)
        return np.asarray(where[first[counts == 1]])


@frozen_value
class Scan:
    """Points of a surface, which is not known between them.

    Attributes:
        points: The points, shape (n, 3), m.
        areas: What each stands for, shape (n,); all alike by default.
    """

    points: GivenArray
    areas: GivenArrayOrNone = given(default=None)
    has_boundary = False

    def __post_init__(self) -> None:
        checks = Checks(self)
        if checks.array("points", (None, 3)) and not len(self.points):
            checks.report("points", "must hold a point, but holds none")
        if self.areas is not None:
            checks.array("areas", (len(self.points),), above=0.0)
        checks.refuse()

    def boundary_distance(self, points: FloatArray) -> FloatArray:
        """Return that no boundary is known: infinity, shape (n,)."""
        return np.full(len(points), math.inf)

    def cells(self, count: int) -> Cells:  # noqa: ARG002 - there are as many points as there are
        """Return the points, as if each were a cell."""
        n = len(self.points)
        areas = np.ones(n) if self.areas is None else self.areas
        return Cells(self.points, np.full((n, 3), np.nan), areas, np.full(n, math.inf), np.zeros(n))


def _shares(parts: int) -> NDArray[np.float64]:
    """Return the barycentric corners of the equal triangles that one is divided into, (parts^2, 3, 3)."""
    i, j = (each.ravel() for each in np.meshgrid(np.arange(parts), np.arange(parts), indexing="ij"))
    upright, turned = i + j < parts, i + j < parts - 1
    a, b = (
        np.concatenate([at[upright, None] + own, at[turned, None] + 1 - own]) / parts
        for at, own in ((i, np.array([0, 1, 0])), (j, np.array([0, 0, 1])))
    )
    return np.stack([1.0 - a - b, a, b], axis=-1)
