"""Many small linear programs at once: the multipliers that make a bound good; no proof rests on them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from synth.arrays import FloatArray

_SMALL = 1e-11
_FAR = -1e30  # the value of a column that must not enter


def multipliers(
    values: FloatArray, slopes: FloatArray, cuts: FloatArray, cut_slopes: FloatArray, pivots: int = 16
) -> tuple[FloatArray, FloatArray]:
    """Return multipliers that all but maximise the lower bound of `combined`.

    The bound is the dual of a linear program over the box |v_k| <= 1. It has one more row than the box has
    sides, and a feasible basis is known: so the simplex method in tableaus, all boxes in step.

    Args:
        values: Of n affine functions at the middle of N boxes, shape (N, n).
        slopes: By v, shape (N, n, d).
        cuts: Values of m affine functions that are known to be at most 0, shape (N, m).
        cut_slopes: By v, shape (N, m, d).
        pivots: How many at most.

    Returns:
        Multipliers of the functions, shape (N, n), and of the cuts, shape (N, m), all at least 0, those of
        each box's functions of sum 1.
    """
    boxes, count, sides = slopes.shape
    held = cuts.shape[1]
    columns = count + held + 2 * sides
    rows = np.arange(boxes)
    # Columns: functions, cuts, +e_k, -e_k, right-hand side. Rows: one for each side, then the sum.
    table = np.zeros((boxes, sides + 1, columns + 1))
    table[:, :sides, :count] = slopes.transpose(0, 2, 1)
    table[:, :sides, count : count + held] = cut_slopes.transpose(0, 2, 1)
    for k in range(sides):
        table[:, k, count + held + k] = 1.0
        table[:, k, count + held + sides + k] = -1.0
    table[:, sides, :count] = 1.0
    table[:, sides, -1] = 1.0
    gain = np.zeros((boxes, columns + 1))
    gain[:, :count], gain[:, count : count + held] = values, cuts
    gain[:, count + held : -1] = -1.0
    basis = np.zeros((boxes, sides + 1), dtype=np.intp)
    basis[:, :sides] = count + held + np.arange(sides)

    # The best function enters on the last row; then each row is given the sign that makes it feasible.
    first = np.argmax(values, axis=1)
    basis[:, sides] = first
    entering = table[rows, :sides, first]
    table[:, :sides] -= entering[:, :, None] * table[:, sides:]
    flipped = table[:, :sides, -1] < 0.0
    table[:, :sides] *= np.where(flipped, -1.0, 1.0)[:, :, None]
    basis[:, :sides] += np.where(flipped, sides, 0)
    gain -= values[rows, first][:, None] * table[:, sides]
    gain += table[:, :sides].sum(axis=1)

    for _ in range(pivots):
        enter = np.argmax(gain[:, :-1], axis=1)
        column = table[rows, :, enter]
        ratios = np.where(column > _SMALL, table[:, :, -1] / np.where(column > _SMALL, column, 1.0), np.inf)
        leave = np.argmin(ratios, axis=1)
        go = (gain[rows, enter] > _SMALL) & np.isfinite(ratios[rows, leave])
        if not go.any():
            break
        pivot = table[rows, leave] / np.where(go, column[rows, leave], 1.0)[:, None]
        pivot[~go] = 0.0
        change = np.where(go[:, None], column, 0.0)
        change[rows, leave] = 0.0
        table -= change[:, :, None] * pivot[:, None, :]
        table[rows[go], leave[go]] = pivot[go]
        gain -= gain[rows, enter][:, None] * pivot
        basis[rows[go], leave[go]] = enter[go]

    found = np.zeros((boxes, columns))
    np.put_along_axis(found, basis, np.maximum(table[:, :, -1], 0.0), axis=1)
    of_functions = found[:, :count]
    total = of_functions.sum(axis=1, keepdims=True)
    good = np.isfinite(total) & (total > 0.5)
    total = np.where(good, total, 1.0)
    fallback = np.zeros_like(of_functions)
    fallback[rows, first] = 1.0
    return (
        np.where(good, of_functions / total, fallback),
        np.where(good, found[:, count : count + held] / total, 0.0),
    )


def combined(
    values: FloatArray,
    slopes: FloatArray,
    cuts: FloatArray,
    cut_slopes: FloatArray,
    of_functions: FloatArray,
    of_cuts: FloatArray,
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the affine function that multipliers make, and its least value over the box.

    Args:
        values: As for `multipliers`, as are the next three.
        slopes: By v, shape (N, n, d).
        cuts: Shape (N, m).
        cut_slopes: By v, shape (N, m, d).
        of_functions: Multipliers of the functions, shape (N, n), at least 0, of sum 1.
        of_cuts: Multipliers of the cuts, shape (N, m), at least 0.

    Returns:
        Its value in the middle, shape (N,), its slopes, shape (N, d), and the least value, shape (N,): where
        the cuts hold, the largest of the functions is nowhere less.
    """
    value = np.einsum("bi,bi->b", of_functions, values) + np.einsum("bi,bi->b", of_cuts, cuts)
    slope = np.einsum("bi,bik->bk", of_functions, slopes) + np.einsum("bi,bik->bk", of_cuts, cut_slopes)
    return value, slope, value - np.abs(slope).sum(axis=1)
