"""Arms that pass near all of many targets: those through a few of them, moved towards the others.

A minimal set, four targets with a known radius or five, fixes finitely many arms, so where one arm passes
through all targets it is among those of any set. Where none does, the arms through different sets lie in
different valleys of the sum of squared misses, and Newton's method leads from each to the bottom of its own.
"""

from __future__ import annotations

from itertools import combinations
from math import comb
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from synth.arrays import unlike_all_before
from synth.errors import GeometryError
from synth.geometry.exact.exact_arms import arms_through_five, arms_through_four
from synth.geometry.exact.newton import folded, least_squares, squared_distances

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from synth.arrays import FloatArray

_APART = 0.01  # m and rad; designs that differ by less in every number are one


class NearArms(NamedTuple):
    """Designs near all of many targets, the nearest first.

    Attributes:
        values: a, alpha, z0, h, R, shape (k, 5), m and rad.
        costs: Weighted means of the squared distances of the targets, to first order, shape (k,), m^2.
    """

    values: FloatArray
    costs: FloatArray


def arms_near(
    targets: ArrayLike,
    radius: float | None = None,
    *,
    weights: ArrayLike | None = None,
    sets: int = 60,
    steps: int = 15,
    seed: int = 0,
) -> NearArms:
    """Return distinct designs near all targets: each a least of the sum of squares, or on its way there.

    Joint limits and the link are unknown here: what it leads to is for a search to find out.

    Args:
        targets: Shape (n, 3), m: four or more with a known R, else five or more.
        radius: A known R, m; or any.
        weights: Of the squared distances, shape (n,), of sum 1; by default equal ones.
        sets: Of how many minimal sets the designs are taken to begin with.
        steps: Of Newton's method; with none, the designs through the sets as they are.
        seed: Of the choice of the sets, where there are more; the same seed gives the same designs.

    Raises:
        GeometryError: If the targets are too few or not finite, or R is not positive.
    """
    array = np.asarray(targets, dtype=np.float64)
    needed = 5 if radius is None else 4
    if array.ndim != 2 or array.shape[1] != 3 or len(array) < needed:
        raise GeometryError(f"Arms near targets need {needed} or more points of three numbers.")
    shares = np.full(len(array), 1.0 / len(array)) if weights is None else np.asarray(weights, dtype=float)
    chosen = array[_minimal_sets(len(array), needed, sets, seed)]
    through = arms_through_five(chosen) if radius is None else arms_through_four(chosen, radius)
    rho, z = np.hypot(array[:, 0], array[:, 1]), array[:, 2]
    designs = through.values[through.found]
    with np.errstate(all="ignore"):  # a design that runs away is nan, and left out
        designs = folded(least_squares(designs, rho, z, shares, steps, fixed_radius=radius is not None))
        costs = squared_distances(designs, rho, z) @ shares
    whole = np.isfinite(designs).all(axis=1) & np.isfinite(costs)
    designs, costs = designs[whole], costs[whole]
    order = np.argsort(costs, kind="stable")
    designs, costs = designs[order], costs[order]
    kept = unlike_all_before(np.abs(designs[:, None] - designs).max(axis=-1) >= _APART)
    return NearArms(designs[kept], costs[kept])


def _minimal_sets(count: int, needed: int, most: int, seed: int) -> NDArray[np.intp]:
    """Return which targets make up each set, shape (sets, needed): all sets, or some at random."""
    if comb(count, needed) <= most:
        return np.array(list(combinations(range(count), needed)), dtype=np.intp)
    rng = np.random.default_rng([seed, needed])
    return np.array([rng.choice(count, needed, replace=False) for _ in range(most)], dtype=np.intp)
