"""Squared distances, Cayley-Menger determinants, and points that have given distances."""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from synth.errors import GeometryError
from synth.rounding import Unit, told_apart

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike

    from synth.arrays import FloatArray

# Squared distances that come from floating-point points carry rounding of a few units in the last
# place of the largest one; ten of them per point is what is cut off as "flat".
_ROUNDING = 10.0 * float(np.finfo(np.float64).eps)


class ArmDistances(NamedTuple):
    """The eight squared distances s_ij = |P_i - P_j|^2 that fix the workspace surface, m^2.

    P1, P2 lie on axis 1, P3, P4 on axis 2, and P5 is the end effector. s12 and s34 belong to the
    hardware, s35 and s45 to the rigid link; reshaping the malleable link changes the other four.
    """

    s12: float
    s13: float
    s14: float
    s23: float
    s24: float
    s34: float
    s35: float
    s45: float

    @property
    def axis_matrix(self) -> FloatArray:
        """Squared distances of P1, P2, P3, P4, shape (4, 4), m^2."""
        return np.asarray(self.matrix(0.0, 0.0)[:4, :4])

    def matrix(self, s15: ArrayLike, s25: ArrayLike) -> FloatArray:
        """Return the squared distances of all five points, shape (..., 5, 5), m^2.

        Args:
            s15: Squared distance from P1 to P5, shape (...), m^2.
            s25: Squared distance from P2 to P5, shape (...), m^2.
        """
        s = np.zeros((*np.broadcast_shapes(np.shape(s15), np.shape(s25)), 5, 5))
        # The upper triangle row by row; the last entry of each row belongs to P5.
        upper = (self.s12, self.s13, self.s14, s15, self.s23, self.s24, s25, self.s34, self.s35, self.s45)
        for (i, j), value in zip(combinations(range(5), 2), upper, strict=True):
            s[..., i, j] = s[..., j, i] = value
        return s


def squared_distances(points: ArrayLike) -> FloatArray:
    """Return the squared distances s_ij = |p_i - p_j|^2 between points.

    Args:
        points: Shape (..., n, k), m; k is the dimension of space.

    Returns:
        Symmetric with a zero diagonal, shape (..., n, n), m^2.
    """
    p = np.asarray(points, dtype=np.float64)
    return np.asarray(np.sum((p[..., :, None, :] - p[..., None, :, :]) ** 2, axis=-1))


def cayley_menger(s: ArrayLike) -> FloatArray:
    """Return the Cayley-Menger determinant D(1, ..., n) of n points.

    D = 2 (-1/2)^n det [[0, 1^T], [1, s]], the square of (n - 1)! times the volume of the simplex:
    zero for five points in space, 36 V^2 for a tetrahedron, 4 A^2 for a triangle, s_12 for two points.

    Args:
        s: Squared distances, shape (..., n, n), m^2.

    Returns:
        Shape (...), m^(2n - 2).

    Source: Clark and Rojas (2020), section II.
    """
    everyone = range(np.shape(s)[-1])
    return cayley_menger_bideterminant(s, everyone, everyone)


def cayley_menger_bideterminant(s: ArrayLike, rows: Sequence[int], columns: Sequence[int]) -> FloatArray:
    """Return the Cayley-Menger bideterminant D(i_1, ..., i_n; j_1, ..., j_n).

    As `cayley_menger`, from the squared distances between two sequences of n points. It equals the
    determinant of the inner products (p_ia - p_i1) . (p_jb - p_j1), a, b = 2, ..., n.

    Args:
        s: Squared distances of all points, shape (..., m, m), m^2.
        rows: The first sequence, as indices from 0.
        columns: The second sequence, of the same length.

    Returns:
        Shape (...), m^(2n - 2).

    Source: Thomas and Ros, "Revisiting trilateration for robot localization" (2005).
    """
    s = np.asarray(s, dtype=np.float64)
    n = len(rows)
    bordered = np.ones((*s.shape[:-2], n + 1, n + 1))
    bordered[..., 0, 0] = 0.0
    bordered[..., 1:, 1:] = s[..., np.asarray(rows)[:, None], np.asarray(columns)]
    return np.asarray(2.0 * (-0.5) ** n * np.linalg.det(bordered))


def realise(s: ArrayLike, *, chirality: Literal[1, -1] = 1, tolerance: float = 1e-9) -> FloatArray:
    """Return points in space that have the given squared distances, placed in the base frame.

    P1 is the origin, P2 lies on +z and P3 in the half-plane x > 0, y = 0. Where points coincide or
    are in line, the first point distinct from P1 takes the place of P2, and the first one off the
    line that of P3. Distances leave a mirror image open: the first point off the plane y = 0 gets
    the sign of `chirality` as its y, which for P4 is the sign of (P2 - P1) x (P3 - P1) . (P4 - P1).

    The points come from the eigenvectors of their Gram matrix, not from one trilateration after
    another: that keeps every distance to rounding even if P3 stands on axis 1. The points themselves
    are as well determined as the distances make them; a height above a plane of the others enters
    by its square, so that one below 1e-7 of the size cannot be told from zero.

    Args:
        s: Squared distances, shape (n, n), m^2.
        chirality: Which of the two mirror images, +1 or -1.
        tolerance: How far a squared distance of the points may be from the given one, as a fraction
            of the largest. A large one yields nearby points for distances that are not quite right.

    Returns:
        Shape (n, 3), m.

    Raises:
        GeometryError: If no points in space have these distances; it says which fit no triangle, no
            tetrahedron, or need a fourth dimension.
    """
    s = np.asarray(s, dtype=np.float64)
    n = len(s)
    if s.shape != (n, n) or not np.all(np.isfinite(s)) or np.any(s < 0.0):
        raise GeometryError("Squared distances must be a square matrix of finite numbers, none below 0.")
    if np.any(s != s.T) or np.any(np.diagonal(s) != 0.0):
        raise GeometryError("Squared distances must be symmetric, and 0 from each point to itself.")

    largest = float(np.max(s))
    to_centroid = np.eye(n) - 1.0 / n
    eigenvalues, eigenvectors = np.linalg.eigh(-0.5 * to_centroid @ s @ to_centroid)
    eigenvalues[eigenvalues <= n * _ROUNDING * largest] = 0.0
    points = _in_base_frame(eigenvectors[:, -3:] * np.sqrt(eigenvalues[-3:]), chirality)

    error = float(np.max(np.abs(squared_distances(points) - s)))
    if error > tolerance * largest:
        raise GeometryError(f"No points in space have these distances: {_reason(s)}.")
    return points


def _in_base_frame(points: FloatArray, chirality: int) -> FloatArray:
    """Turn points, shape (n, k), k <= 3, into the base frame: z, x and y are chosen in this order."""
    remainder = points - points[0]
    # Noise that the square root has blown up must not choose a direction.
    noise = np.sqrt(_ROUNDING) * float(np.max(np.abs(remainder)))
    placed = np.zeros((len(points), 3))
    for coordinate in (2, 0, 1):
        lengths = np.linalg.norm(remainder, axis=1)
        off = np.flatnonzero(lengths > noise)
        if off.size == 0:
            break
        direction = remainder[off[0]] / lengths[off[0]]
        placed[:, coordinate] = remainder @ direction
        remainder = remainder - np.outer(placed[:, coordinate], direction)
    placed[:, 1] *= chirality
    return placed


def _reason(s: FloatArray) -> str:
    """Say why no points in space have these squared distances, from triangles upwards."""
    n = len(s)
    d = np.sqrt(s)
    excess, i, j, k = max(
        (float(d[i, j] - d[i, k] - d[k, j]), i, j, k) for i, j in combinations(range(n), 2) for k in range(n)
    )
    # Only a margin against rounding: that something is wrong has been established.
    margin = 1e-9
    if excess > margin * float(np.max(d)):
        told = told_apart(float(d[i, j]), float(d[i, k] + d[k, j]), Unit.M, 6)
        longer, others = (f"{float(each):.12g}" for each in told)
        return (
            f"d{i + 1}{j + 1} = {longer} m is longer than d{min(i, k) + 1}{max(i, k) + 1} + "
            f"d{min(j, k) + 1}{max(j, k) + 1} = {others} m"
        )
    lowest, four = min(_determinants(s, 4), default=(0.0, ""))
    if lowest < -margin * float(np.max(s)) ** 3:
        return f"the Cayley-Menger determinant {four} = {lowest:.3g} m^6 is negative, they fit no tetrahedron"
    _, worst, five = max(
        ((abs(value), value, name) for value, name in _determinants(s, 5)), default=(0, 0, "")
    )
    return f"any four points exist, all of them only in a fourth dimension: {five} = {worst:.3g} m^8 is not 0"


def _determinants(s: FloatArray, size: int) -> list[tuple[float, str]]:
    """Return D and its name, such as D(1,2,3,4), for all subsets of a size."""
    return [
        (float(cayley_menger(s[np.ix_(subset, subset)])), f"D({','.join(str(i + 1) for i in subset)})")
        for subset in combinations(range(len(s)), size)
    ]
