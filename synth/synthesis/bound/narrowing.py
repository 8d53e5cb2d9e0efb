"""Narrowing boxes to where every target may be near. Every inequality is proven in docs/bound.md."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen_value
from synth.synthesis.bound.cells import CELLS, Cells, Grid, wrapped
from synth.synthesis.bound.contraction import hull_of_cells
from synth.synthesis.bound.limits import SLACK

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.synthesis.bound.boxes import Boxes
    from synth.synthesis.bound.forms import Circle, Forms

_THIN = 1e-12  # rad: half of psi's width where there is none


@frozen_value
class Candidates:
    """Boxes in which every target may be near, and where.

    Attributes:
        boxes: N boxes.
        cells: The cells in which a target may be near, some for each box and target.
        psi: The cells of psi that are left, shape (N, CELLS).
    """

    boxes: Boxes
    cells: Cells
    psi: NDArray[np.bool_]

    def cut(self) -> Candidates:
        """Return the same with finer cells."""
        return Candidates(self.boxes, self.cells.cut(), self.psi)

    def take(self, full: NDArray[np.bool_]) -> Candidates:
        """Return some of the boxes with all their cells."""
        cells = self.cells.take(full[self.cells.box])
        numbers = (np.cumsum(full) - 1)[cells.box]
        return Candidates(
            self.boxes.take(full), Cells(numbers, cells.target, cells.phi, cells.half), self.psi[full]
        )


@frozen_value
class Narrowing:
    """What keeps cells, and then boxes, from being near all targets.

    Attributes:
        circle: Where P5 is to reach.
        grid: The coarsest cells.
        factors: Of the targets' misses, shape (n,).
        floor: The lowest height of P5, m.
    """

    circle: Circle
    grid: Grid
    factors: FloatArray
    floor: float

    def near(self, candidates: Candidates, enough: float) -> tuple[Candidates, Forms]:
        """Return the candidates without the cells that are surely far, and the bounds of the others."""
        boxes, cells = candidates.boxes, candidates.cells
        forms = self.circle.forms(boxes, cells)
        near = forms.least() <= enough / self.factors[cells.target]
        theta = np.abs(wrapped(cells.phi - boxes.middle[cells.box, 4]))
        near &= theta <= self.grid.window + boxes.half[cells.box, 4] + cells.half + SLACK
        near &= forms.highest >= self.floor - SLACK
        held = np.zeros((len(boxes), len(self.factors)), dtype=bool)
        held[cells.box[near], cells.target[near]] = True
        full = np.asarray(held.all(axis=1))
        near &= full[cells.box]
        return Candidates(boxes, cells.take(near), candidates.psi).take(full), forms.take(near)

    def narrowed(self, candidates: Candidates, enough: float) -> Candidates:
        """Return the candidates in boxes narrowed to where some cell of each target may be near."""
        candidates, forms = self.near(candidates, enough)
        boxes, cells, psi = candidates.boxes, candidates.cells, candidates.psi
        if not len(boxes):
            return candidates
        n = len(self.factors)
        starts = cells.starts(n)
        values = forms.values - forms.in_cell - enough / self.factors[cells.target]
        psi_for = self._psi_for(boxes, cells)
        near, lower, upper = hull_of_cells(values, forms.slopes, psi_for, cells.box, starts)
        masks = np.where(near, self.grid.psi_for(cells), np.uint64(0))
        masks = np.bitwise_or.reduceat(masks, starts).reshape(len(boxes), n)
        psi = psi & self.grid.unpacked(np.bitwise_and.reduce(masks, axis=1))
        first, last = np.argmax(psi, axis=1), CELLS - 1 - np.argmax(psi[:, ::-1], axis=1)
        middle, half = boxes.middle[:, 4], np.maximum(boxes.half[:, 4], _THIN)
        edge = self.grid.half + SLACK
        lower[4] = np.maximum(lower[4], (self.grid.middles[first] - edge - middle) / half)
        upper[4] = np.minimum(upper[4], (self.grid.middles[last] + edge - middle) / half)
        full = np.asarray((lower <= upper).all(axis=0) & psi.any(axis=1))
        left = Candidates(boxes, cells.take(near & full[cells.box]), psi).take(full)
        return Candidates(left.boxes.narrowed(lower.T[full], upper.T[full]), left.cells, left.psi)

    def _psi_for(self, boxes: Boxes, cells: Cells) -> tuple[FloatArray, FloatArray]:
        """Return between which psi, in units of the box, P5 may be in cells, shape (C,) each."""
        theta = wrapped(cells.phi - boxes.middle[cells.box, 4])
        half = np.maximum(boxes.half[cells.box, 4], _THIN)
        edge = self.grid.window + cells.half + SLACK
        # If psi could come near the cell the other way round, nothing is said.
        both = half + np.abs(theta) + edge >= 2.0 * math.pi
        return np.where(both, -1.0, (theta - edge) / half), np.where(both, 1.0, (theta + edge) / half)
