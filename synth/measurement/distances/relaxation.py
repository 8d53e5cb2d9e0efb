"""Distances that points of some space can have, nearest to measured ones: a convex problem.

The only file that knows CVXPY. With P1 as the origin the Gram matrix G of the other points determines
all squared distances, D_ij = G_ii + G_jj - 2 G_ij, and points exist if and only if G has no negative
eigenvalue. How many dimensions they need, its rank, is what this leaves open. Four points need three
at most, so that for P1, ..., P4 nothing is left open.

Source: Dokmanic, Parhizkar, Ranieri and Vetterli, "Euclidean distance matrices" (2015), section IV.
"""

from __future__ import annotations

import math
import warnings
from typing import TYPE_CHECKING, Any

import numpy as np

from synth.errors import SolverError

if TYPE_CHECKING:
    from synth.arrays import FloatArray
    from synth.measurement.distances.measured import MeasuredDistances

_SOLVED = {"optimal", "optimal_inaccurate"}
_IMPOSSIBLE = {"infeasible", "infeasible_inaccurate"}


def nearest_gram(distances: MeasuredDistances, *, bounded: bool = True) -> FloatArray | None:
    """Return the Gram matrix whose distances are nearest to the measured ones, in any dimension.

    It minimises the sum of ((D_ij - d_ij^2) / (2 d_ij sigma_ij))^2, which for errors small against the
    distances is that of ((sqrt(D_ij) - d_ij) / sigma_ij)^2.

    Args:
        distances: What was measured.
        bounded: Whether every distance must keep its bounds; else only known ones must.

    Returns:
        G, shape (n, n), m^2, with a row of zeros for P1; None if no points in any number of
        dimensions have such distances.

    Raises:
        SolverError: If the solver gives no answer.
    """
    problem = _Problem(distances, bounded=bounded)
    loose = ~distances.is_known
    values = distances.values[loose]
    # A distance near 0 has no first order; it is then known no better than by its sigma.
    weights = 1.0 / (np.maximum(values, distances.sigma[loose]) * distances.sigma[loose])
    misfit = problem.squared[loose] - values**2 / problem.unit
    return problem.solve(problem.scaled(weights / np.max(weights, initial=1e-300), misfit))


def consistent_interval(distances: MeasuredDistances, name: str) -> tuple[float, float] | None:
    """Return between which values a distance can be, if only the others are believed.

    Args:
        distances: What was measured; the others keep their bounds.
        name: Which distance, such as "d25".

    Returns:
        Its least and its largest value, m: in space it lies between them. None if the others are
        impossible without it, in any number of dimensions.

    Raises:
        SolverError: If the solver gives no answer.
    """
    k = distances.names.index(name)
    rest = distances.replaced(name, distances.values[k], math.inf)
    i, j = distances.pairs[k]
    ends = []
    for sign in (1.0, -1.0):
        problem = _Problem(rest, bounded=True)
        gram = problem.solve(sign * problem.squared[k], linear=True)
        if gram is None:
            return None
        ends.append(math.sqrt(max(gram[i, i] + gram[j, j] - 2.0 * gram[i, j], 0.0)))
    return ends[0], ends[1]


class _Problem:
    """The Gram matrix as an unknown, in units of a typical squared distance."""

    def __init__(self, distances: MeasuredDistances, *, bounded: bool) -> None:
        # 1.5 s to import, paid only when it is asked for.
        import cvxpy  # noqa: PLC0415

        cp: Any = cvxpy
        self._cp = cp
        count = distances.count
        # The median: one number that is ten times too large must not make the others small.
        self.unit = float(np.median(distances.values)) ** 2
        self._gram: Any = cp.Variable((count - 1, count - 1), PSD=True)
        by_gram = np.zeros((len(distances.pairs), (count - 1) ** 2))
        for row, pair in zip(by_gram, distances.pairs, strict=True):
            across = np.bincount(pair, [1.0, -1.0], count)[1:]
            row[:] = np.outer(across, across).ravel()
        self.squared: Any = by_gram @ cp.vec(self._gram, order="C")
        known = distances.is_known
        lower, upper = distances.lower**2 / self.unit, distances.upper**2 / self.unit
        self._constraints: list[Any] = []
        if known.any():
            self._constraints.append(self.squared[known] == lower[known])
        above, below = ~known & (lower > 0.0), ~known & np.isfinite(upper)
        if bounded and above.any():
            self._constraints.append(self.squared[above] >= lower[above])
        if bounded and below.any():
            self._constraints.append(self.squared[below] <= upper[below])

    def scaled(self, factors: FloatArray, expression: Any) -> Any:
        """Return an expression times numbers, element by element."""
        return self._cp.multiply(factors, expression)

    def solve(self, objective: Any, *, linear: bool = False) -> FloatArray | None:
        """Minimise a linear expression, or the sum of squares of an affine one; None: impossible."""
        cp = self._cp
        problem = cp.Problem(
            cp.Minimize(objective if linear else cp.sum_squares(objective)), self._constraints
        )
        with warnings.catch_warnings():
            # An inaccurate solution is a start like any other: what counts is checked on the points.
            warnings.filterwarnings("ignore", message="Solution may be inaccurate")
            try:
                problem.solve(solver="CLARABEL")
            except cp.error.SolverError as error:
                raise SolverError(f"the nearest distances were not found: {error}") from error
        if problem.status in _IMPOSSIBLE:
            return None
        if problem.status not in _SOLVED:
            raise SolverError(f"the nearest distances were not found: {problem.status}")
        return np.pad(np.asarray(self._gram.value) * self.unit, ((1, 0), (1, 0)))
