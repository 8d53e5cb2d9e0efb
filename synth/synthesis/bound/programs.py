"""The bound of a box from those of all its targets. Every inequality is proven in docs/bound.md."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from synth.synthesis.bound.contraction import contracted
from synth.synthesis.bound.linear import combined, multipliers

if TYPE_CHECKING:
    from synth.arrays import FloatArray

_ROUNDS = 3  # of cutting a target's cells into two groups


def solved(
    values: FloatArray, slopes: FloatArray, cuts: FloatArray, cut_slopes: FloatArray, enough: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Bound the largest of affine functions, target after target cut into its two groups of cells.

    Args:
        values: Of all cells of each target, and of both groups, at the middle of N boxes, shape
            (3, N, n, 2), m.
        slopes: By v, |v| <= 1, shape (3, N, n, 2, d), m.
        cuts: Values of m affine functions that are known to be at most 0, shape (N, m).
        cut_slopes: By v, shape (N, m, d).
        enough: No more is needed, m.

    Returns:
        Lower bounds, shape (N,), m; and between which v they are not all `enough`: lower and upper limits,
        shape (N, d) each, a lower one above its upper one where there is nothing left.
    """
    _, count, n, _, sides = slopes.shape
    owner, taken = np.arange(count), np.zeros((count, n), dtype=np.intp)
    targets = np.arange(n)
    final, before = np.full(count, np.inf), np.zeros(count)
    lower, upper = np.ones((count, sides)), -np.ones((count, sides))
    for round_ in range(_ROUNDS + 1):
        value = values[taken, owner[:, None], targets].reshape(len(owner), 2 * n)
        slope = slopes[taken, owner[:, None], targets].reshape(len(owner), 2 * n, sides)
        empty = np.isinf(value).any(axis=1)  # of a group without cells
        value[empty] = enough
        programs = (value, slope, cuts[owner], cut_slopes[owner])
        weights = multipliers(*programs)
        bound = np.maximum(combined(*programs, *weights)[2], before)
        # What both groups apart allow more than together, as far as it weighs.
        weight = weights[0].reshape(len(owner), n, 2)
        apart = np.minimum(values[1, owner], values[2, owner]) - values[0, owner]
        gain = np.where(taken == 0, (weight * np.minimum(apart, 1.0)).sum(axis=2), 0.0)
        best = np.argmax(gain, axis=1)
        rows = np.arange(len(owner))
        more = (bound < enough) & ~empty & (gain[rows, best] > 0.0) & (round_ < _ROUNDS)
        done = ~more & ~empty
        np.minimum.at(final, owner[done], bound[done])
        open_ = np.flatnonzero(done & (bound < enough))
        low, high = contracted(
            np.concatenate([value[open_] - enough, cuts[owner[open_]]], axis=1).T,
            np.concatenate([slope[open_], cut_slopes[owner[open_]]], axis=1).T,
        )
        possible = (low <= high).all(axis=0)
        np.minimum.at(lower, owner[open_[possible]], low.T[possible])
        np.maximum.at(upper, owner[open_[possible]], high.T[possible])
        if not more.any():
            break
        owner, before = np.repeat(owner[more], 2), np.repeat(bound[more], 2)
        taken, best = np.repeat(taken[more], 2, axis=0), np.repeat(best[more], 2)
        taken[np.arange(len(owner)), best] = np.tile([1, 2], len(owner) // 2)
    return final, lower, upper
