"""How far affine functions that must not be positive narrow boxes: (14) and (15) of docs/bound.md."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.arrays import FloatArray

_ROUNDS = 3
_CELL_ROUNDS = 2
_SMALL = 1e-12  # m: slopes that are no slopes
_MARGIN = 1e-9  # of the box: its middle and half-widths are rounded


def contracted(values: FloatArray, slopes: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return between which limits of each side of a box all of its affine functions can be at most 0.

    Args:
        values: Of m functions at the middle of N boxes, shape (m, N), m.
        slopes: By v, |v| <= 1, shape (d, m, N), m.

    Returns:
        Lower and upper limits of v, shape (d, N) each; a lower one above its upper one is a proof that no v
        is left.
    """
    sides, _, count = slopes.shape
    lower, upper = np.full((sides, count), -1.0), np.ones((sides, count))
    reach = _Reach(slopes)
    for _ in range(_ROUNDS):
        top, bottom, _ = reach.limits(values, lower, upper)
        lower, upper = np.maximum(lower, bottom), np.minimum(upper, top)
    return lower, upper


def hull_of_cells(
    values: FloatArray,
    slopes: FloatArray,
    psi: tuple[FloatArray, FloatArray],
    box: NDArray[np.intp],
    starts: NDArray[np.intp],
) -> tuple[NDArray[np.bool_], FloatArray, FloatArray]:
    """Return which cells may be near in narrowed boxes in which each target has one, and their limits.

    Args:
        values: Of two functions for each cell, at the middle of its box, shape (2, C), m: both are at most 0
            where the cell is near.
        slopes: By the first four parameters, |v| <= 1, shape (4, 2, C), m.
        psi: Lower and upper limits of the fifth, shape (C,) each.
        box: Number of the box of each cell, shape (C,).
        starts: The first cell of each box and target, shape (N n,).

    Returns:
        Which cells, shape (C,); lower and upper limits, shape (5, N) each, a lower one above its upper one
        where the box has nothing left.
    """
    count = int(box[-1]) + 1
    lower, upper = np.full((5, count), -1.0), np.ones((5, count))
    near = np.ones(len(box), dtype=bool)
    reach = _Reach(slopes)
    for _ in range(_CELL_ROUNDS):
        bottom, top = lower[:, box], upper[:, box]
        by_cell_top, by_cell_bottom, least = reach.limits(values, bottom[:4], top[:4])
        top = np.minimum(top, np.vstack([by_cell_top, psi[1]]))
        bottom = np.maximum(bottom, np.vstack([by_cell_bottom, psi[0]]))
        near &= (bottom <= top).all(axis=0) & (least <= 0.0)
        top[:, ~near], bottom[:, ~near] = -2.0, 2.0
        upper = np.maximum.reduceat(top, starts, axis=1).reshape(5, count, -1).min(axis=2)
        lower = np.minimum.reduceat(bottom, starts, axis=1).reshape(5, count, -1).max(axis=2)
    return near, lower, upper


class _Reach:
    """How far each parameter may go before one of m affine functions is positive, whatever the others."""

    def __init__(self, slopes: FloatArray) -> None:
        self.slopes = slopes = np.ascontiguousarray(slopes)
        self.rising, self.falling = slopes > _SMALL, slopes < -_SMALL
        self.size = np.where(self.rising | self.falling, np.abs(slopes), 1.0)

    def limits(
        self, values: FloatArray, lower: FloatArray, upper: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return upper and lower limits, shape (d, N), between others, and the largest least value, (N,)."""
        lower, upper = lower[:, None], upper[:, None]
        least = values + np.minimum(self.slopes * lower, self.slopes * upper).sum(axis=0)
        step = -least / self.size + _MARGIN
        top = lower + np.where(self.rising, step, 4.0)
        bottom = upper - np.where(self.falling, step, 4.0)
        return top.min(axis=1), bottom.max(axis=1), least.max(axis=0)
