"""One affine bound for each target from those of its cells. Every inequality is proven in docs/bound.md."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from synth.synthesis.bound.cells import wrapped

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.synthesis.bound.forms import Forms
    from synth.synthesis.bound.narrowing import Candidates


def grouped(
    candidates: Candidates, forms: Forms, targets: int, window: float
) -> tuple[FloatArray, FloatArray, NDArray[np.intp]]:
    """Return affine bounds that hold for all cells of a target, and for each of two groups of them.

    Args:
        candidates: N boxes and their C cells.
        forms: The bounds of these.
        targets: Number n of targets.
        window: How far joint 2 lets phi be from psi, rad.

    Returns:
        Values of all cells and of both groups, shape (3, N, n, 2), m, infinite for a group without cells;
        their slopes by all five parameters over the half-widths, shape (3, N, n, 2, 5), m; and the nearest
        cell of each box and target, shape (N n,).
    """
    cells = candidates.cells
    key, starts = cells.box * targets + cells.target, cells.starts(targets)
    merging = _Merging(candidates, forms, starts, window)
    nearest = np.lexsort((forms.distance, key))[starts]
    values, slopes, allowed = merging.merged(nearest)
    # The groups: what is more like the nearest cell, and what is more like the one that costs most.
    other = np.lexsort((allowed, key))[starts]
    first = merging.change(nearest) <= merging.change(other)
    variants = [
        (values, slopes),
        *(merging.merged(cell, group)[:2] for cell, group in ((nearest, first), (other, ~first))),
    ]
    shape = (3, len(candidates.boxes), targets, 2)
    return (
        np.stack([value for value, _ in variants]).reshape(shape),
        np.stack([slope for _, slope in variants]).reshape(*shape, 5),
        nearest,
    )


class _Merging:
    def __init__(self, candidates: Candidates, forms: Forms, starts: NDArray[np.intp], window: float) -> None:
        cells, boxes = candidates.cells, candidates.boxes
        self.forms, self.half, self.window, self.starts = forms, cells.half, window, starts
        self.sizes = np.diff(np.concatenate([starts, [len(cells.box)]]))
        self.psi_half = boxes.half[cells.box, 4]
        self.theta = wrapped(cells.phi - boxes.middle[cells.box, 4])

    def change(self, reference: NDArray[np.intp]) -> FloatArray:
        """Return how unlike the slopes of each cell and of its target's reference cell are, shape (C,)."""
        there = np.repeat(self.forms.slopes[..., reference], self.sizes, axis=2)
        return np.asarray(np.abs(self.forms.slopes - there).sum(axis=(0, 1)))

    def merged(
        self, reference: NDArray[np.intp], group: NDArray[np.bool_] | None = None
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return affine bounds, with the slopes of a reference cell, that hold for all cells of a target.

        Args:
            reference: A candidate of each box and target, shape (N n,).
            group: Which candidates count, shape (C,); all by default.

        Returns:
            Values, shape (N n, 2), infinite where no candidate counts; slopes, shape (N n, 2, 5); and what
            each candidate allows the values to be, summed over both sides, shape (C,).
        """
        forms, theta, sizes = self.forms, self.theta, self.sizes
        edge = self.window + self.psi_half
        values, slopes = np.empty((len(reference), 2)), np.empty((len(reference), 2, 5))
        allowed = np.zeros(len(theta))
        for side in range(2):
            rate = forms.along_cell[side]
            # A target that would rather have joint 2 beyond its limit follows psi.
            limit = np.where(rate < 0.0, self.window, -self.window)
            held = (np.sign(limit) * theta > edge - 3.0 * self.half) & (edge + 2.0 * self.half < math.pi)
            follow = np.repeat(np.where(held, rate, 0.0)[reference], sizes)
            limit = np.repeat(limit[reference], sizes)
            own = forms.slopes[:, side]
            change = own - np.repeat(own[:, reference], sizes, axis=1)
            value = forms.values[side] - np.abs(change).sum(axis=0)
            value -= np.abs(rate - follow) * self.half + np.abs(rate) * self.half**3 / 6.0
            value -= follow * (theta - limit)
            allowed += value
            if group is not None:
                value = np.where(group, value, np.inf)
            values[:, side] = np.minimum.reduceat(value, self.starts)
            slopes[:, side, :4] = own[:, reference].T
            slopes[:, side, 4] = (follow * self.psi_half)[self.starts]
        return values, slopes, allowed
