"""The points in space whose distances are nearest to measured ones."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Literal

import numpy as np

from synth.arrays import FloatArray, frozen, frozen_value
from synth.errors import GeometryError
from synth.geometry import realise, squared_distances
from synth.measurement.distances.relaxation import nearest_gram
from synth.sentences import SentenceEnum

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.measurement.distances.measured import MeasuredDistances

_ROUNDING = 1e-8  # m; what the arithmetic may add to a distance, far below any measurement
# A distance beyond its bounds weighs as if it were this many times as precise: it then stays beyond
# by 1e-8 of the sum of the forces that push it there. A local search that must keep stiff distances
# creeps along a curved valley, so that softer ones come first; but near flat points, where a height
# enters by its square, the convex problem's own solution is the better start. Both are tried.
_STIFFEST = 1e4
_SCHEDULES = ((_STIFFEST,), (1.0, 1e2, _STIFFEST))


class Fit(SentenceEnum):
    """How well points in space fit measured distances."""

    AS_GIVEN = "as_given", "points in space have exactly these distances"
    WITHIN_BOUNDS = "within_bounds", "points in space have distances within the bounds of these"
    NOT_FOUND = "not_found", "no points in space were found whose distances keep the bounds"
    IMPOSSIBLE = "impossible", "no points in any space have distances that keep the bounds"


@frozen_value
class Nearest:
    """Points in space, and how far their distances are from the measured ones.

    Attributes:
        measured: The distances that were measured.
        points: P1, P2, ..., placed as `synth.geometry.realise` does, shape (n, 3), m.
        distances: Their distances, for the pairs of `measured`, shape (m,), m.
        fit: Whether they keep the bounds. `IMPOSSIBLE` comes from the convex problem and holds for all
            points there are; `NOT_FOUND` from a local search, and with four points is never met.
    """

    measured: MeasuredDistances
    points: FloatArray
    distances: FloatArray
    fit: Fit

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", frozen(self.points))
        object.__setattr__(self, "distances", frozen(self.distances))

    @property
    def is_realisable(self) -> bool:
        """Whether the points keep all bounds."""
        return self.fit in {Fit.AS_GIVEN, Fit.WITHIN_BOUNDS}

    @property
    def residuals(self) -> FloatArray:
        """By how much each distance is longer than measured, shape (m,), m."""
        return np.asarray(self.distances - self.measured.values)

    @property
    def beyond(self) -> FloatArray:
        """By how much each distance is beyond its bounds, at least 0, shape (m,), m."""
        measured = self.measured
        outside = np.maximum(measured.lower - self.distances, self.distances - measured.upper)
        return np.asarray(np.maximum(outside, 0.0))

    @property
    def within(self) -> NDArray[np.bool_]:
        """Whether each distance keeps its bounds, shape (m,)."""
        return np.asarray(self.beyond <= _ROUNDING)


def nearest_realisable(measured: MeasuredDistances, *, chirality: Literal[1, -1] = 1) -> Nearest:
    """Return the points in space whose distances are nearest to measured ones.

    They minimise the sum of ((|P_i - P_j| - d_ij) / sigma_ij)^2 among points that keep the bounds. First
    in any number of dimensions, where the problem is convex; then brought to three by dropping the
    smallest eigenvalues of the Gram matrix and a local search from there. Four points need no more than
    three, and then the result is the best there is. For more it is the best of several starts.

    Where no points keep the bounds, or none are found, the nearest without these bounds are returned.

    Args:
        measured: The distances; pairs may be missing, but every point needs one.
        chirality: Which of the two mirror images, as in `synth.geometry.realise`.

    Raises:
        GeometryError: If a point has no distance to any other.
        SolverError: If the convex solver gives no answer.
    """
    if set(range(measured.count)) - set(measured.pairs.ravel().tolist()):
        raise GeometryError("Every point needs a measured distance to another one.")
    gram = nearest_gram(measured)
    if gram is None:
        return _unbounded(measured, Fit.IMPOSSIBLE, chirality)
    found = _nearest(measured, measured, gram, chirality)
    if found.within.all():
        return found
    return _unbounded(measured, Fit.NOT_FOUND, chirality)


def _unbounded(measured: MeasuredDistances, fit: Fit, chirality: Literal[1, -1]) -> Nearest:
    """Return the nearest points where the bounds cannot be kept; what is known still is."""
    gram = nearest_gram(measured, bounded=False)
    if gram is None:
        raise GeometryError("The distances that are known, and not measured, fit no points at all.")
    return replace(_nearest(measured, measured.unbounded(), gram, chirality), fit=fit)


def _nearest(
    measured: MeasuredDistances, bounded: MeasuredDistances, gram: FloatArray, chirality: Literal[1, -1]
) -> Nearest:
    """Return the best points in space found from a Gram matrix, with the bounds of `bounded`."""
    results = [_polished(bounded, start, how) for start in _starts(gram) for how in _SCHEDULES]
    costs = [float(np.sum(_residuals(bounded, points)[0] ** 2)) for points in results]
    points = realise(squared_distances(results[int(np.argmin(costs))]), chirality=chirality)
    i, j = measured.pairs.T
    distances = np.linalg.norm(points[i] - points[j], axis=1)
    unchanged = np.max(np.abs(distances - measured.values)) <= _ROUNDING
    return Nearest(measured, points, distances, Fit.AS_GIVEN if unchanged else Fit.WITHIN_BOUNDS)


def _starts(gram: FloatArray) -> list[FloatArray]:
    """Return points in space near a Gram matrix of more dimensions, each of shape (n, 3).

    What the fourth dimension held may belong on either side of the others: so each point is also
    reflected in the plane that fits the others best.
    """
    eigenvalues, eigenvectors = np.linalg.eigh(gram)
    points = eigenvectors[:, -3:] * np.sqrt(np.maximum(eigenvalues[-3:], 0.0))
    starts = [points]
    for k in range(len(points) if len(points) > 4 else 0):
        others = np.delete(points, k, axis=0)
        centre = others.mean(axis=0)
        normal = np.linalg.svd(others - centre)[2][-1]
        reflected = points.copy()
        reflected[k] -= 2.0 * np.dot(points[k] - centre, normal) * normal
        starts.append(reflected)
    return starts


def _polished(measured: MeasuredDistances, start: FloatArray, stiffnesses: tuple[float, ...]) -> FloatArray:
    """Return the points of the local minimum near a start, shape (n, 3), m."""
    # 1 s to import, paid only when it is used; scipy has no types of its own.
    from scipy.optimize import least_squares  # type: ignore[import-untyped]  # noqa: PLC0415

    points = start
    for stiffness in stiffnesses:
        solution = least_squares(
            lambda x, stiffness=stiffness: _residuals(measured, x.reshape(start.shape), stiffness)[0],
            points.ravel(),
            jac=lambda x, stiffness=stiffness: _residuals(measured, x.reshape(start.shape), stiffness)[1],
            xtol=1e-15,
            ftol=1e-15,
            gtol=1e-15,
            max_nfev=300,
        )
        points = np.asarray(solution.x.reshape(start.shape))
    return points


def _residuals(
    measured: MeasuredDistances, points: FloatArray, stiffness: float = _STIFFEST
) -> tuple[FloatArray, FloatArray]:
    """Return misses over sigma, then those of the bounds, shape (2 m,), and their derivatives."""
    i, j = measured.pairs.T
    difference = points[i] - points[j]
    distances = np.linalg.norm(difference, axis=1)
    known, sigma = measured.is_known, measured.sigma
    typical = float(np.min(sigma, where=~known, initial=1.0))
    weights = np.where(known, 0.0, 1.0 / np.where(known, 1.0, sigma))
    stiff = stiffness / np.where(known, typical, sigma)
    nearest = np.clip(distances, measured.lower, measured.upper)
    residuals = np.concatenate([weights * (distances - measured.values), stiff * (distances - nearest)])
    outside = distances != nearest
    directions = difference / np.maximum(distances, 1e-300)[:, None]
    jacobian = np.zeros((2, len(i), *points.shape))
    rows = np.arange(len(i))
    for block, factor in enumerate((weights, stiff * outside)):
        jacobian[block, rows, i] += factor[:, None] * directions
        jacobian[block, rows, j] -= factor[:, None] * directions
    return residuals, jacobian.reshape(2 * len(i), -1)
