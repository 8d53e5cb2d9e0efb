"""Affine lower bounds of the misses in boxes of shapes. Every inequality is proven in docs/bound.md."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from synth.synthesis.bound.boxes import Boxes
from synth.synthesis.bound.cells import CELLS, Cells, Grid, wrapped
from synth.synthesis.bound.forms import Circle
from synth.synthesis.bound.limits import SLACK, Limits
from synth.synthesis.bound.merging import grouped
from synth.synthesis.bound.narrowing import Candidates, Narrowing
from synth.synthesis.bound.programs import solved

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.task import Task

# Boxes in which P5 moves by less than these, m, look at finer cells. Above the first, no affine bound helps.
_FINER = (0.2, 0.02, 0.002)
# Where psi keeps no target from its nearest branch, it is cut only in boxes of which no other side moves P5
# by this much, m: there the link may forbid it.
_THIN = 1e-4
_PARED = 8  # parts of a cell of psi at each end that are looked at one by one


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
        self.floor = task.lowest_from(task.base)
        self.factors = factors
        offset, radius = robot.end_effector_circle(robot.rigid_link.d35.lower, robot.rigid_link.d45.lower)
        x, y, z = task.positions_in_base[targets].T
        self.circle = Circle(float(offset), float(radius), np.hypot(x, y), z)
        second = robot.joint_limits.second
        # joint 2 stands at pi where P5 is at phi = psi
        self.window = max(second.upper - math.pi, math.pi - second.lower) + SLACK
        self.grid = Grid.of(self.window)
        self.narrowing = Narrowing(self.circle, self.grid, factors, self.floor)

    def evaluate(self, boxes: Boxes, enough: float) -> Boxes:
        """Bound the worst weighted miss in boxes.

        Args:
            boxes: The boxes.
            enough: Where it is not less than this, m, boxes are narrowed or dropped.

        Returns:
            What is left of the boxes, with their bounds.
        """
        boxes = replace(boxes, origin=np.arange(len(boxes)))
        boxes = boxes.take(self.limits.allow_end(boxes))
        boxes, alive, psi = self._coarse(boxes, enough)
        size = self.circle.moved(boxes)
        parts = [boxes.take(size >= _FINER[0])]
        for cuts, (upper, lower) in enumerate(itertools.pairwise((*_FINER, 0.0))):
            chosen = (size < upper) & (size >= lower)
            if chosen.any():
                box, target, cell = np.nonzero(self.grid.unpacked(alive[chosen]))
                cells = Cells(box, target, self.grid.middles[cell], self.grid.half)
                parts.append(self._fine(Candidates(boxes.take(chosen), cells, psi[chosen]), enough, cuts))
        return Boxes.joined(parts)

    def sides(self, boxes: Boxes) -> FloatArray:
        """Return how far each parameter alone moves P5, shape (N, 5), m."""
        scale = np.array([1.0, 1.0, self.circle.arm, self.circle.arm, self.circle.radius])
        sides = boxes.half * scale
        sides[:, 4] = np.where(boxes.by_psi, sides[:, 4], np.minimum(sides[:, 4], _THIN))
        return np.asarray(sides)

    def _coarse(self, boxes: Boxes, enough: float) -> tuple[Boxes, NDArray[np.uint64], NDArray[np.bool_]]:
        """Return the boxes in which every target may be near, where, and at which psi.

        Returns:
            The boxes; the cells in which each target may be near, shape (N, n), a bit each; and the cells
            of psi that are left, shape (N, CELLS).
        """
        u, e1, e2 = boxes.frame
        grid = self.grid
        cos, sin = np.cos(grid.middles)[:, None], np.sin(grid.middles)[:, None]
        points = (boxes.end + self.circle.offset * u)[:, None] + self.circle.radius * (
            cos * e1[:, None] + sin * e2[:, None]
        )
        rho, z = np.hypot(points[..., 0], points[..., 1]), points[..., 2]
        reach = (self.circle.moved(boxes) + 2.0 * self.circle.radius * math.sin(0.5 * grid.half))[:, None]
        above = z + reach >= self.floor - SLACK
        alive = np.empty((len(boxes), len(self.circle.z)), dtype=np.uint64)
        for i, factor in enumerate(self.factors):
            near = (rho - self.circle.rho[i]) ** 2 + (z - self.circle.z[i]) ** 2 <= (
                reach + enough / factor
            ) ** 2
            alive[:, i] = grid.packed(near & above)

        psi = self.limits.allow_direction(boxes, grid.middles, grid.half)
        psi &= np.abs(grid.middles - boxes.middle[:, 4, None]) <= boxes.half[:, 4, None] + grid.half + SLACK
        for i in range(len(self.circle.z)):
            psi &= (alive[:, i, None] & grid.masks[0]) != 0
        alive &= np.bitwise_or.reduce(np.where(psi, grid.masks[0], np.uint64(0)), axis=1)[:, None]
        kept = psi.any(axis=1) & (alive != 0).all(axis=1)
        boxes, alive, psi = boxes.take(kept), alive[kept], psi[kept]
        if len(boxes):
            first, last = np.argmax(psi, axis=1), CELLS - 1 - np.argmax(psi[:, ::-1], axis=1)
            middle, half = boxes.middle[:, 4], boxes.half[:, 4]
            lower = np.maximum(middle - half, grid.middles[first] - grid.half)
            upper = np.minimum(middle + half, grid.middles[last] + grid.half)
            lower, upper, open_ = self._pared(boxes, lower, upper)
            boxes = boxes.with_psi(lower, np.maximum(lower, upper)).take(open_)
            alive, psi = alive[open_], psi[open_]
        return boxes, alive, psi

    def _pared(
        self, boxes: Boxes, lower: FloatArray, upper: FloatArray
    ) -> tuple[FloatArray, FloatArray, NDArray[np.bool_]]:
        """Return psi from `lower` to `upper`, less what the link forbids at both ends, and if any is left."""
        cell = 2.0 * self.grid.half
        width = np.minimum(cell, upper - lower) / _PARED
        steps = np.arange(_PARED)
        below = lower[:, None] + (steps + 0.5) * width[:, None]
        above = upper[:, None] - (steps + 0.5) * width[:, None]
        allowed = self.limits.allow_direction(boxes, np.hstack([below, above]), 0.5 * width[:, None])
        cut = np.logical_and.accumulate(~allowed[:, :_PARED], axis=1).sum(axis=1)
        cut_above = np.logical_and.accumulate(~allowed[:, _PARED:], axis=1).sum(axis=1)
        # A narrow interval is covered by its parts, one without width by each of them.
        left = allowed.any(axis=1) | (upper - lower > cell)
        lower, upper = lower + cut * width, upper - cut_above * width
        return lower, upper, left & (lower <= upper)

    def _fine(self, candidates: Candidates, enough: float, cuts: int) -> Boxes:
        """Bound the worst weighted miss in small boxes by affine functions."""
        candidates = self.narrowing.narrowed(candidates, enough)
        for _ in range(cuts):
            candidates = self.narrowing.narrowed(candidates.cut(), enough)
        candidates, forms = self.narrowing.near(candidates, enough)
        boxes, cells, n = candidates.boxes, candidates.cells, len(self.factors)
        if not len(boxes):
            return boxes
        values, slopes, nearest = grouped(candidates, forms, n, self.window)
        values, slopes = values * self.factors[:, None], slopes * self.factors[:, None, None]
        cut, cut_slope, known = self.limits.length_cut(boxes)
        cut_slopes = np.zeros((len(boxes), 1, 5))
        cut_slopes[:, 0, :2] = np.where(known[:, None], cut_slope, 0.0) * boxes.half[:, :2]
        bounds, lower, upper = solved(values, slopes, np.where(known, cut, -1.0)[:, None], cut_slopes, enough)
        single = np.minimum.reduceat(forms.least(), cells.starts(n)).reshape(len(boxes), n) * self.factors
        bounds = np.maximum(bounds, single.max(axis=1))

        around = np.abs(wrapped(cells.phi[nearest].reshape(len(boxes), n, 1) - self.grid.middles)).max(axis=1)
        by_psi = ~((around <= self.window) & candidates.psi).any(axis=1)
        boxes = replace(boxes, bound=np.maximum(boxes.bound, bounds), by_psi=by_psi)
        left = (bounds < enough) & (lower <= upper).all(axis=1)
        return boxes.take(left).narrowed(lower[left], upper[left])
