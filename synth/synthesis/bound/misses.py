"""Affine lower bounds of the misses in boxes of shapes. Every inequality is proven in docs/bound.md."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from synth.synthesis.bound.boxes import Boxes
from synth.synthesis.bound.cells import Cells, Circle, Forms, wrapped
from synth.synthesis.bound.limits import SLACK, Limits
from synth.synthesis.bound.linear import combined, multipliers

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.task import Task

_CELLS = 64  # of the circle of P5, and of psi, at first: a bit each
# Boxes in which P5 moves by less than these, m, look at finer cells. Above the first, no affine bound helps.
_FINER = (0.06, 0.03, 0.006)
_PARED = 8  # parts of a cell of psi at each end that are looked at one by one
_ROUNDS = 3  # of cutting a target's cells into two groups


class MissBounds:
    """Lower bounds of the worst of factor * miss over the targets, for boxes of shapes.

    Args:
        task: The task; its rigid link is fixed.
        targets: Which of its targets count, shape (n,).
        factors: The tightest tolerance over that of each of these, shape (n,).
    """

    def __init__(self, task: Task, targets: NDArray[np.intp], factors: FloatArray) -> None:
        robot = task.robot
        self.limits = Limits.of(task)
        self.floor = -math.inf if task.floor is None else task.floor
        self.factors = factors
        offset, radius = robot.end_effector_circle(robot.rigid_link.d35.lower, robot.rigid_link.d45.lower)
        x, y, z = task.positions[targets].T
        self.circle = Circle(float(offset), float(radius), np.hypot(x, y), z)
        second = robot.joint_limits.second
        # joint 2 stands at pi where P5 is at phi = psi
        self.window = max(second.upper - math.pi, math.pi - second.lower) + SLACK
        self.cells = (2.0 * np.arange(_CELLS) + 1.0) * math.pi / _CELLS - math.pi
        self.cell_half = math.pi / _CELLS
        self.bits = np.left_shift(np.uint64(1), np.arange(_CELLS, dtype=np.uint64))
        within = (
            np.abs(wrapped(self.cells[:, None] - self.cells)) <= self.window + 2.0 * self.cell_half + SLACK
        )
        self.masks = np.where(within, self.bits, np.uint64(0)).sum(axis=1, dtype=np.uint64)

    def evaluate(self, boxes: Boxes, enough: float) -> Boxes:
        """Bound the worst weighted miss in boxes.

        Args:
            boxes: The boxes.
            enough: Boxes in which it is nowhere less than this, m, are dropped.

        Returns:
            The others, with their bounds, and psi narrowed to what the limits allow.
        """
        boxes = boxes.take(self.limits.allow_end(boxes))
        boxes, alive, allowed = self._coarse(boxes, enough)
        size = self.circle.moved(boxes)
        parts = [boxes.take(size >= _FINER[0])]
        for cuts, (upper, lower) in enumerate(itertools.pairwise((*_FINER, 0.0))):
            chosen = (size < upper) & (size >= lower)
            if chosen.any():
                parts.append(self._fine(boxes.take(chosen), alive[chosen], allowed[chosen], enough, cuts))
        return Boxes.joined(parts)

    def sides(self, boxes: Boxes) -> FloatArray:
        """Return how far each parameter alone moves P5, shape (N, 5), m."""
        scale = np.array([1.0, 1.0, self.circle.arm, self.circle.arm, self.circle.radius])
        sides = boxes.half * scale
        sides[:, 4] = np.where(boxes.by_psi, sides[:, 4], 0.0)
        return np.asarray(sides)

    def _coarse(self, boxes: Boxes, enough: float) -> tuple[Boxes, NDArray[np.uint64], NDArray[np.bool_]]:
        """Return the boxes in which every target may be near, where, and at which psi.

        Returns:
            The boxes; the cells in which each target may be near, shape (N, n), a bit each; and the cells
            of psi that are left, shape (N, K).
        """
        u, e1, e2 = boxes.frame
        cos, sin = np.cos(self.cells)[:, None], np.sin(self.cells)[:, None]
        points = (boxes.end + self.circle.offset * u)[:, None] + self.circle.radius * (
            cos * e1[:, None] + sin * e2[:, None]
        )
        rho, z = np.hypot(points[..., 0], points[..., 1]), points[..., 2]
        reach = (self.circle.moved(boxes) + 2.0 * self.circle.radius * math.sin(0.5 * self.cell_half))[
            :, None
        ]
        above = z + reach >= self.floor - SLACK
        alive = np.empty((len(boxes), len(self.circle.z)), dtype=np.uint64)
        for i, factor in enumerate(self.factors):
            near = (rho - self.circle.rho[i]) ** 2 + (z - self.circle.z[i]) ** 2 <= (
                reach + enough / factor
            ) ** 2
            alive[:, i] = np.packbits(near & above, axis=1, bitorder="little").view("<u8")[:, 0]

        allowed = self.limits.allow_direction(boxes, self.cells, self.cell_half)
        psi, psi_half = boxes.middle[:, 4, None], boxes.half[:, 4, None]
        allowed &= np.abs(self.cells - psi) <= psi_half + self.cell_half + SLACK
        for i in range(len(self.circle.z)):
            allowed &= (alive[:, i, None] & self.masks) != 0
        reachable = np.bitwise_or.reduce(np.where(allowed, self.masks, np.uint64(0)), axis=1)
        alive &= reachable[:, None]
        kept = allowed.any(axis=1) & (alive != 0).all(axis=1)
        boxes, alive, allowed = boxes.take(kept), alive[kept], allowed[kept]
        if len(boxes):
            first, last = np.argmax(allowed, axis=1), _CELLS - 1 - np.argmax(allowed[:, ::-1], axis=1)
            psi, psi_half = boxes.middle[:, 4], boxes.half[:, 4]
            lower = np.maximum(psi - psi_half, self.cells[first] - self.cell_half)
            upper = np.minimum(psi + psi_half, self.cells[last] + self.cell_half)
            lower, upper = self._pared(boxes, lower, upper)
            open_ = lower <= upper
            boxes = boxes.with_psi(lower, np.maximum(lower, upper)).take(open_)
            alive, allowed = alive[open_], allowed[open_]
        return boxes, alive, allowed

    def _pared(self, boxes: Boxes, lower: FloatArray, upper: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return psi from `lower` to `upper`, less what the link forbids at both ends."""
        width = np.minimum(2.0 * self.cell_half, upper - lower) / _PARED
        steps = np.arange(_PARED)
        below = lower[:, None] + (steps + 0.5) * width[:, None]
        above = upper[:, None] - (steps + 0.5) * width[:, None]
        allowed = self.limits.allow_direction(boxes, np.hstack([below, above]), 0.5 * width[:, None])
        cut = np.logical_and.accumulate(~allowed[:, :_PARED], axis=1).sum(axis=1)
        cut_above = np.logical_and.accumulate(~allowed[:, _PARED:], axis=1).sum(axis=1)
        return lower + cut * width, upper - cut_above * width

    def _fine(
        self,
        boxes: Boxes,
        alive: NDArray[np.uint64],
        allowed: NDArray[np.bool_],
        enough: float,
        cuts: int,
    ) -> Boxes:
        """Bound the worst weighted miss in small boxes by affine functions."""
        box, target, cell = np.nonzero((alive[:, :, None] & self.bits) != 0)
        candidates = Cells(box, target, self.cells[cell], self.cell_half)
        forms, kept = self._near(boxes, candidates, enough)
        for _ in range(cuts):
            forms, kept = self._near(boxes, kept.cut(), enough)
        held = np.zeros((len(boxes), len(self.circle.z)), dtype=bool)
        held[kept.box, kept.target] = True
        full = np.asarray(held.all(axis=1))
        chosen = full[kept.box]
        boxes, kept, forms = boxes.take(full), kept.take(chosen), forms.take(chosen)
        if not len(boxes):
            return boxes
        kept = Cells((np.cumsum(full) - 1)[kept.box], kept.target, kept.phi, kept.half)
        return self._combine(boxes, kept, forms, allowed[full], enough)

    def _near(self, boxes: Boxes, cells: Cells, enough: float) -> tuple[Forms, Cells]:
        """Return the affine bounds of each cell, those aside that show it to be far from its target."""
        forms = self.circle.forms(boxes, cells)
        near = forms.least() <= enough / self.factors[cells.target]
        theta = np.abs(wrapped(cells.phi - boxes.middle[cells.box, 4]))
        near &= theta <= self.window + boxes.half[cells.box, 4] + cells.half + SLACK
        near &= forms.highest >= self.floor - SLACK
        return forms.take(near), cells.take(near)

    def _combine(
        self, boxes: Boxes, cells: Cells, forms: Forms, allowed: NDArray[np.bool_], enough: float
    ) -> Boxes:
        """Return the boxes that are left, with the best bound from the affine bounds of all their cells."""
        count, n = len(boxes), len(self.circle.z)
        key = cells.box * n + cells.target
        starts = np.flatnonzero(np.concatenate([[True], key[1:] != key[:-1]]))
        sizes = np.diff(np.concatenate([starts, [len(key)]]))
        nearest = np.lexsort((forms.distance, key))[starts]
        all_values, all_slopes, loss = self._merged(boxes, cells, forms, nearest, starts, sizes)
        other = np.lexsort((loss, key))[starts]
        to_nearest = np.abs(forms.slopes - np.repeat(forms.slopes[:, nearest], sizes, axis=1)).sum(
            axis=(0, 2)
        )
        to_other = np.abs(forms.slopes - np.repeat(forms.slopes[:, other], sizes, axis=1)).sum(axis=(0, 2))
        first = to_nearest <= to_other
        variants = [(all_values, all_slopes)]
        for reference, group in ((nearest, first), (other, ~first)):
            variants.append(self._merged(boxes, cells, forms, reference, starts, sizes, group)[:2])
        values = np.stack([value for value, _ in variants]) * self.factors[:, None]
        slopes = np.stack([slope for _, slope in variants]) * self.factors[:, None, None]
        single = np.minimum.reduceat(forms.least(), starts).reshape(count, n) * self.factors
        bounds = np.maximum(self._programs(boxes, values, slopes, enough), single.max(axis=1))

        around = np.abs(wrapped(cells.phi[nearest].reshape(count, n, 1) - self.cells)).max(axis=1)
        by_psi = ~((around <= self.window) & allowed).any(axis=1)
        boxes = replace(boxes, bound=np.maximum(boxes.bound, bounds), by_psi=by_psi)
        return boxes.take(bounds < enough)

    def _merged(
        self,
        boxes: Boxes,
        cells: Cells,
        forms: Forms,
        reference: NDArray[np.intp],
        starts: NDArray[np.intp],
        sizes: NDArray[np.intp],
        group: NDArray[np.bool_] | None = None,
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return affine bounds, with the slopes of a reference cell, that hold for all cells of a target.

        Args:
            boxes: N boxes.
            cells: Their C candidates.
            forms: The bounds of these.
            reference: A candidate of each box and target, shape (N n,).
            starts: The first candidate of each box and target, shape (N n,).
            sizes: How many there are of each, shape (N n,).
            group: Which candidates count, shape (C,); all by default.

        Returns:
            Values, shape (N, n, 2), infinite where no candidate counts; slopes, shape (N, n, 2, 5); and what
            each candidate allows the values to be, summed over both sides, shape (C,).
        """
        count, n = len(boxes), len(self.circle.z)
        psi_half = boxes.half[cells.box, 4]
        theta = wrapped(cells.phi - boxes.middle[cells.box, 4])
        edge = self.window + psi_half
        values, slopes, allowed = np.empty((count, n, 2)), np.empty((count, n, 2, 5)), np.zeros(len(theta))
        for side in range(2):
            rate = forms.along_cell[side]
            # A target that would rather have joint 2 beyond its limit follows psi.
            limit = np.where(rate < 0.0, self.window, -self.window)
            held = (np.sign(limit) * theta > edge - 3.0 * cells.half) & (edge + 2.0 * cells.half < math.pi)
            follow = np.repeat(np.where(held, rate, 0.0)[reference], sizes)
            limit = np.repeat(limit[reference], sizes)
            change = forms.slopes[side] - np.repeat(forms.slopes[side][reference], sizes, axis=0)
            value = forms.values[side] - np.abs(change).sum(axis=1)
            value -= np.abs(rate - follow) * cells.half + np.abs(rate) * cells.half**3 / 6.0
            value -= follow * (theta - limit)
            allowed += value
            if group is not None:
                value = np.where(group, value, np.inf)
            values[..., side] = np.minimum.reduceat(value, starts).reshape(count, n)
            slopes[..., side, :4] = forms.slopes[side][reference].reshape(count, n, 4)
            slopes[..., side, 4] = follow[starts].reshape(count, n) * boxes.half[:, 4, None]
        return values, slopes, allowed

    def _programs(self, boxes: Boxes, values: FloatArray, slopes: FloatArray, enough: float) -> FloatArray:
        """Return lower bounds from linear programs, target after target cut into its two groups of cells.

        Args:
            boxes: N boxes.
            values: Of all cells of each target, and of both groups, shape (3, N, n, 2), m.
            slopes: Likewise, shape (3, N, n, 2, 5), m.
            enough: No more is needed, m.

        Returns:
            Shape (N,), m.
        """
        count, n = len(boxes), len(self.circle.z)
        cut, cut_slope, known = self.limits.length_cut(boxes)
        cuts = np.where(known, cut, -1.0)[:, None]
        cut_slopes = np.zeros((count, 1, 5))
        cut_slopes[:, 0, :2] = np.where(known[:, None], cut_slope, 0.0) * boxes.half[:, :2]

        owner, taken = np.arange(count), np.zeros((count, n), dtype=np.intp)
        targets = np.arange(n)
        final = np.full(count, np.inf)
        before = np.zeros(count)
        for round_ in range(_ROUNDS + 1):
            value = values[taken, owner[:, None], targets].reshape(len(owner), 2 * n)
            slope = slopes[taken, owner[:, None], targets].reshape(len(owner), 2 * n, 5)
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
            if not more.any():
                break
            owner, before = np.repeat(owner[more], 2), np.repeat(bound[more], 2)
            taken, best = np.repeat(taken[more], 2, axis=0), np.repeat(best[more], 2)
            taken[np.arange(len(owner)), best] = np.tile([1, 2], len(owner) // 2)
        return np.asarray(final)
