"""The circle of P5, and the angle psi, in cells of equal width."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen_value
from synth.synthesis.bound.limits import SLACK

if TYPE_CHECKING:
    from numpy.typing import NDArray


CELLS = 64  # of the circle of P5, and of psi, at first: a bit each
_PARTS = 4  # into which a cell is cut
_CUTS = 2  # times at most


@frozen_value
class Cells:
    """Pairs of a target and a cell of the circle of P5 in some boxes, sorted by box and target.

    Attributes:
        box: Number of the box, shape (C,).
        target: Number of the target, shape (C,).
        phi: Middle of the cell, shape (C,), rad.
        half: Half its width, the same for all, rad.
    """

    box: NDArray[np.intp]
    target: NDArray[np.intp]
    phi: FloatArray
    half: float

    def take(self, chosen: NDArray[np.bool_]) -> Cells:
        """Return some of the cells."""
        return Cells(self.box[chosen], self.target[chosen], self.phi[chosen], self.half)

    def cut(self) -> Cells:
        """Return each cell cut into equal parts."""
        shifts = self.half * ((2.0 * np.arange(_PARTS) + 1.0) / _PARTS - 1.0)
        phi = (self.phi[:, None] + shifts).ravel()
        return Cells(np.repeat(self.box, _PARTS), np.repeat(self.target, _PARTS), phi, self.half / _PARTS)

    def starts(self, targets: int) -> NDArray[np.intp]:
        """Return the first cell of each box and target; every box has some for each of its targets."""
        key = self.box * targets + self.target
        return np.flatnonzero(np.concatenate([[True], key[1:] != key[:-1]]))


@frozen_value
class Grid:
    """The coarsest cells, of phi as of psi, and which of them go together.

    Attributes:
        window: How far joint 2 lets phi be from psi, rad.
        middles: Middles of the cells, shape (CELLS,), rad.
        half: Half their width, rad.
        bits: A bit for each, shape (CELLS,).
        masks: For cells of phi cut 0, 1, ... times, all around the circle, a bit for each cell of psi from
            which joint 2 lets P5 be in it.
    """

    window: float
    middles: FloatArray
    half: float
    bits: NDArray[np.uint64]
    masks: tuple[NDArray[np.uint64], ...]

    @classmethod
    def of(cls, window: float) -> Grid:
        """Return the grid of a range of joint 2."""
        bits = np.left_shift(np.uint64(1), np.arange(CELLS, dtype=np.uint64))
        middles, half = _middles(CELLS)
        masks = []
        for cuts in range(_CUTS + 1):
            phi, finer = _middles(CELLS * _PARTS**cuts)
            within = np.abs(wrapped(phi[:, None] - middles)) <= window + half + finer + SLACK
            masks.append(np.where(within, bits, np.uint64(0)).sum(axis=1, dtype=np.uint64))
        return cls(window, middles, half, bits, tuple(masks))

    def packed(self, chosen: NDArray[np.bool_]) -> NDArray[np.uint64]:
        """Return the bits of chosen cells, shape (N, CELLS), as numbers, shape (N,)."""
        return np.packbits(chosen, axis=1, bitorder="little").view("<u8")[:, 0].astype(np.uint64)

    def unpacked(self, numbers: NDArray[np.uint64]) -> NDArray[np.bool_]:
        """Return which bits numbers have, shape (...), as truth values, shape (..., CELLS)."""
        return np.asarray((numbers[..., None] & self.bits) != 0)

    def psi_for(self, cells: Cells) -> NDArray[np.uint64]:
        """Return from which cells of psi P5 may be in cells, shape (C,), a bit each."""
        cuts = round(math.log(self.half / cells.half, _PARTS))
        place = np.rint((cells.phi + math.pi) / (2.0 * cells.half) - 0.5).astype(np.intp)
        return self.masks[cuts][place]


def wrapped(angle: FloatArray) -> FloatArray:
    """Return angles moved by whole turns into [-pi, pi], rad."""
    return np.asarray(angle - 2.0 * math.pi * np.rint(angle / (2.0 * math.pi)))


def _middles(count: int) -> tuple[FloatArray, float]:
    half = math.pi / count
    return np.asarray((2.0 * np.arange(count) + 1.0) * half - math.pi), half
