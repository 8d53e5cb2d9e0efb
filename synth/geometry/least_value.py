"""The least value of functions that change no faster than a known rate: certain, not sampled."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from synth.arrays import FloatArray

_MOST_CELLS = 400_000


def least_values(
    f: Callable[[NDArray[np.intp], FloatArray], FloatArray],
    lower: FloatArray,
    upper: FloatArray,
    rates: FloatArray,
    tolerance: float,
    ceiling: float,
    floor: float = -np.inf,
) -> tuple[FloatArray, FloatArray]:
    """Return lower bounds of functions over boxes, by dividing the boxes into cells.

    Over a cell with centre c and half widths w, f >= f(c) - sum_j rate_j w_j. A cell whose bound is
    above the ceiling, or above the least value known less the tolerance, is done with; the others are
    halved. So f > min(ceiling, least value known - tolerance) everywhere.

    Args:
        f: Takes which function, shape (K,), and where, shape (K, k); returns the values, shape (K,).
        lower: Lower corners of the boxes of the N functions, shape (N, k).
        upper: Their upper corners, shape (N, k).
        rates: How fast each function can change along each coordinate, shape (N, k).
        tolerance: How far the bound may be below the least value.
        ceiling: Values above this need not be told apart.
        floor: Nor values below this: once one is seen, minus infinity is bound enough.

    Returns:
        For each function a bound that it nowhere falls below, shape (N,), and where it was seen least,
        shape (N, k). If the cells become too many, the bound is what the largest of them allow.
    """
    count, sides = lower.shape
    which, centre, half = np.arange(count), 0.5 * (lower + upper), 0.5 * (upper - lower)
    least, at = np.full(count, np.inf), centre.copy()
    while True:
        values = f(which, centre)
        np.minimum.at(least, which, values)
        seen = values == least[which]
        at[which[seen]] = centre[seen]
        spread = rates[which] * half
        bounds = values - spread.sum(axis=1)
        enough = np.where(least < floor, -np.inf, np.minimum(least - tolerance, ceiling))
        open_cells = bounds < enough[which]
        if not open_cells.any():
            return enough, at
        if np.count_nonzero(open_cells) > _MOST_CELLS:
            np.minimum.at(enough, which, bounds)
            return enough, at
        which, centre = which[open_cells], centre[open_cells]
        half, spread = half[open_cells], spread[open_cells]
        longest = np.eye(sides)[np.argmax(spread, axis=1)]
        half = half * (1.0 - 0.5 * longest)
        which = np.concatenate([which, which])
        centre = np.concatenate([centre - longest * half, centre + longest * half])
        half = np.concatenate([half, half])
