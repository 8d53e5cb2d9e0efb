"""Boxes of shapes: where the link ends and which way its end points, up to a turn about axis 1."""

from __future__ import annotations

import math
from dataclasses import fields, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen_value

if TYPE_CHECKING:
    from numpy.typing import NDArray


# Charts of the half sphere u_y >= 0, after the faces of a cube: the middle's coordinate axis and sign, the
# coordinate axis towards which alpha turns, the one towards which beta turns, and the least alpha.
_CHARTS = (
    (1, 1.0, 0, 2, -0.25 * math.pi),
    (0, 1.0, 1, 2, 0.0),
    (0, -1.0, 1, 2, 0.0),
    (2, 1.0, 1, 0, 0.0),
    (2, -1.0, 1, 0, 0.0),
)


@frozen_value
class Boxes:
    """Boxes of the parameters (rho, h, alpha, beta, psi) of the link's end.

    After a turn about axis 1 the link ends at p = (rho, 0, h), rho >= 0. With the three axes e_m, e_a, e_b
    of a chart, w = cos(beta) e_m + sin(beta) e_b and u = cos(alpha) w + sin(alpha) e_a, the direction of
    axis 2. With e1 = du/dalpha and e2 = u x e1 the link ends in the direction t = cos(psi) e1 + sin(psi) e2.

    Attributes:
        chart: Number of the chart, shape (N,).
        middle: Middles, shape (N, 5), m and rad.
        half: Half the widths, shape (N, 5).
        bound: What is known of the worst weighted miss: nowhere in the box is it less, shape (N,), m.
        by_psi: Whether to cut psi, too: it keeps some target from its nearest branch, shape (N,).
        origin: Number of the box, of those that were evaluated together, that it is a part of, shape (N,).
    """

    chart: NDArray[np.intp]
    middle: FloatArray
    half: FloatArray
    bound: FloatArray
    by_psi: NDArray[np.bool_]
    origin: NDArray[np.intp]

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name).view()
            object.__setattr__(self, field.name, value)
            value.flags.writeable = False

    @classmethod
    def cover(cls, rho: float, heights: tuple[float, float]) -> Boxes:
        """Return boxes of all ends with u_y >= 0, at most `rho` from axis 1 and between two heights, m."""
        count = len(_CHARTS)
        quarter = 0.25 * math.pi
        lower = np.array([[0.0, heights[0], least, -quarter, -math.pi] for *_, least in _CHARTS])
        upper = np.array([[rho, heights[1], quarter, quarter, math.pi]] * count)
        middle, half = 0.5 * (lower + upper), 0.5 * (upper - lower)
        numbers = np.arange(count)
        return cls(numbers, middle, half, np.zeros(count), np.zeros(count, dtype=bool), numbers)

    @classmethod
    def joined(cls, parts: list[Boxes]) -> Boxes:
        """Return the boxes of all parts, in order."""
        columns = (tuple(getattr(part, field.name) for field in fields(cls)) for part in parts)
        return cls(*(np.concatenate(arrays) for arrays in zip(*columns, strict=True)))

    def __len__(self) -> int:
        return len(self.chart)

    def take(self, chosen: NDArray[np.intp] | NDArray[np.bool_] | slice) -> Boxes:
        """Return some of the boxes."""
        return Boxes(*(getattr(self, field.name)[chosen] for field in fields(self)))

    def halved(self, side: NDArray[np.intp]) -> Boxes:
        """Return both halves of each box, cut across a side, shape (N,): first all lower ones."""
        rows = np.arange(len(self))
        half, shift = self.half.copy(), np.zeros_like(self.half)
        half[rows, side] *= 0.5
        shift[rows, side] = half[rows, side]
        lower = replace(self, middle=self.middle - shift, half=half)
        return Boxes.joined([lower, replace(self, middle=self.middle + shift, half=half)])

    def with_psi(self, lower: FloatArray, upper: FloatArray) -> Boxes:
        """Return the boxes with psi between other limits, shape (N,) each, rad."""
        middle, half = self.middle.copy(), self.half.copy()
        middle[:, 4], half[:, 4] = 0.5 * (lower + upper), 0.5 * (upper - lower)
        return replace(self, middle=middle, half=half)

    def narrowed(self, lower: FloatArray, upper: FloatArray) -> Boxes:
        """Return the boxes with each side between limits in units of the box, shape (N, 5) each."""
        middle = self.middle + 0.5 * (lower + upper) * self.half
        return replace(self, middle=middle, half=0.5 * (upper - lower) * self.half)

    @cached_property
    def end(self) -> FloatArray:
        """The link's end p of the middle, shape (N, 3), m."""
        zero = np.zeros(len(self))
        return np.stack([self.middle[:, 0], zero, self.middle[:, 1]], axis=-1)

    @cached_property
    def frame(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """The directions u, e1, e2 of the middle, shape (N, 3) each."""
        middle, sign, towards_a, towards_b = (np.array([c[i] for c in _CHARTS])[self.chart] for i in range(4))
        eye = np.eye(3)
        e_m, e_a, e_b = sign[:, None] * eye[middle.astype(int)], eye[towards_a], eye[towards_b]
        alpha, beta = self.middle[:, 2, None], self.middle[:, 3, None]
        w = np.cos(beta) * e_m + np.sin(beta) * e_b
        return (
            np.cos(alpha) * w + np.sin(alpha) * e_a,
            np.cos(alpha) * e_a - np.sin(alpha) * w,
            np.cross(w, e_a),
        )

    @cached_property
    def beta_axis(self) -> FloatArray:
        """Components along u and e1 of the axis k about which beta turns the frame, shape (2, N).

        Alpha turns it about e2. The axis is e_a or -e_a, as the chart is right-handed or not.
        """
        eye = np.eye(3)
        signs = np.array([sign * np.cross(eye[m], eye[b]) @ eye[a] for m, sign, a, b, _ in _CHARTS])
        alpha = self.middle[:, 2]
        return np.asarray(signs[self.chart] * np.stack([np.sin(alpha), np.cos(alpha)]))

    @cached_property
    def end_radius(self) -> FloatArray:
        """How far p moves in each box from its middle at most, shape (N,), m."""
        return np.hypot(self.half[:, 0], self.half[:, 1])

    @cached_property
    def turn(self) -> FloatArray:
        """By how much alpha and beta turn u, e1 and e2 in each box at most, shape (N,), rad."""
        return np.hypot(self.half[:, 2], self.half[:, 3])
