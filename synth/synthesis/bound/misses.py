"""Affine lower bounds of the misses in boxes of shapes. Every inequality is proven in docs/bound.md."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from synth.synthesis.bound.boxes import Boxes
from synth.synthesis.bound.linear import combined, multipliers
from synth.synthesis.bound.limits import SLACK, Limits

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.task import Task

_CELLS = 64  # of the circle of P5, and of psi, at first: a bit each
_PARTS = 4  # into which a cell is cut
# Boxes in which P5 moves by less than these, m, look at finer cells. Above the first, no affine bound helps.
_FINER = (0.06, 0.03, 0.006)
_TINY = 1e-300
_PARED = 8  # parts of a cell of psi at each end that are looked at one by one
_ROUNDS = 3  # of cutting a target's cells into two groups


@dataclass(frozen=True, eq=False)
class _Candidates:
    """Pairs of a target and a cell of the circle of P5 that are left in some boxes, sorted by box and target."""

    box: NDArray[np.intp]
    target: NDArray[np.intp]
    phi: FloatArray
    half: float

    def take(self, chosen: NDArray[np.bool_]) -> _Candidates:
        return _Candidates(self.box[chosen], self.target[chosen], self.phi[chosen], self.half)

    def cut(self) -> _Candidates:
        """Return each cell cut into equal parts."""
        shifts = self.half * ((2.0 * np.arange(_PARTS) + 1.0) / _PARTS - 1.0)
        phi = (self.phi[:, None] + shifts).ravel()
        return _Candidates(
            np.repeat(self.box, _PARTS), np.repeat(self.target, _PARTS), phi, self.half / _PARTS
        )


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
        x, y, self.z = task.positions[targets].T
        self.rho = np.hypot(x, y)
        offset, radius = robot.end_effector_circle(robot.rigid_link.d35.lower, robot.rigid_link.d45.lower)
        self.offset, self.radius = float(offset), float(radius)
        self.arm = math.hypot(self.offset, self.radius)
        second = robot.joint_limits.second
        # joint 2 stands at pi where P5 is at phi = psi
        self.window = max(second.upper - math.pi, math.pi - second.lower) + SLACK
        self.cells = (2.0 * np.arange(_CELLS) + 1.0) * math.pi / _CELLS - math.pi
        self.cell_half = math.pi / _CELLS
        self.bits = np.left_shift(np.uint64(1), np.arange(_CELLS, dtype=np.uint64))
        within = np.abs(wrapped(self.cells[:, None] - self.cells)) <= self.window + 2.0 * self.cell_half + SLACK
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
        size = self.moved(boxes)
        parts = [boxes.take(size >= _FINER[0])]
        for cuts, (upper, lower) in enumerate(itertools.pairwise((*_FINER, 0.0))):
            chosen = (size < upper) & (size >= lower)
            if chosen.any():
                parts.append(self._fine(boxes.take(chosen), alive[chosen], allowed[chosen], enough, cuts))
        return Boxes.joined(parts)

    def moved(self, boxes: Boxes) -> FloatArray:
        """Return how far any point of the circle of P5 moves in each box from its middle, shape (N,), m."""
        return boxes.end_radius + self.arm * np.minimum(boxes.turn, 2.0)

    def sides(self, boxes: Boxes) -> FloatArray:
        """Return how far each parameter alone moves P5, shape (N, 5), m."""
        scale = np.array([1.0, 1.0, self.arm, self.arm, self.radius])
        sides = boxes.half * scale
        sides[:, 4] = np.where(boxes.by_psi, sides[:, 4], 0.0)
        return sides

    def _coarse(
        self, boxes: Boxes, enough: float
    ) -> tuple[Boxes, NDArray[np.uint64], NDArray[np.bool_]]:
        """Return the boxes in which every target may be near, where, and at which psi.

        Returns:
            The boxes; the cells in which each target may be near, shape (N, n), a bit each; and the cells
            of psi that are left, shape (N, K).
        """
        u, e1, e2 = boxes.frame
        cos, sin = np.cos(self.cells)[:, None], np.sin(self.cells)[:, None]
        points = (boxes.end + self.offset * u)[:, None] + self.radius * (cos * e1[:, None] + sin * e2[:, None])
        rho, z = np.hypot(points[..., 0], points[..., 1]), points[..., 2]
        reach = (self.moved(boxes) + 2.0 * self.radius * math.sin(0.5 * self.cell_half))[:, None]
        above = z + reach >= self.floor - SLACK
        alive = np.empty((len(boxes), len(self.z)), dtype=np.uint64)
        for i, factor in enumerate(self.factors):
            near = (rho - self.rho[i]) ** 2 + (z - self.z[i]) ** 2 <= (reach + enough / factor) ** 2
            alive[:, i] = np.packbits(near & above, axis=1, bitorder="little").view("<u8")[:, 0]

        allowed = self.limits.allow_direction(boxes, self.cells, self.cell_half)
        psi, psi_half = boxes.middle[:, 4, None], boxes.half[:, 4, None]
        allowed &= np.abs(self.cells - psi) <= psi_half + self.cell_half + SLACK
        for i in range(len(self.z)):
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
        candidates = _Candidates(box, target, self.cells[cell], self.cell_half)
        forms, kept = self._near(boxes, candidates, enough)
        for _ in range(cuts):
            forms, kept = self._near(boxes, kept.cut(), enough)
        counts = np.bincount(kept.box * len(self.z) + kept.target, minlength=len(boxes) * len(self.z))
        full = (counts.reshape(len(boxes), -1) > 0).all(axis=1)
        chosen = full[kept.box]
        boxes, kept, forms = boxes.take(full), kept.take(chosen), forms.take(chosen)
        if not len(boxes):
            return boxes
        kept = _Candidates((np.cumsum(full) - 1)[kept.box], kept.target, kept.phi, kept.half)
        return self._combine(boxes, kept, forms, allowed[full], enough)

    def _near(self, boxes: Boxes, cells: _Candidates, enough: float) -> tuple[_Forms, _Candidates]:
        """Return the affine bounds of each cell, those aside that show it to be far from its target."""
        forms = self._forms(boxes, cells)
        near = forms.least() <= enough / self.factors[cells.target]
        theta = np.abs(wrapped(cells.phi - boxes.middle[cells.box, 4]))
        near &= theta <= self.window + boxes.half[cells.box, 4] + cells.half + SLACK
        near &= forms.highest >= self.floor - SLACK
        return forms.take(near), cells.take(near)

    def _forms(self, boxes: Boxes, cells: _Candidates) -> _Forms:
        """Return for each cell two affine functions of the box that its distance is nowhere less than."""
        box = cells.box
        u, e1, e2 = (direction[box] for direction in boxes.frame)
        cos, sin = np.cos(cells.phi)[:, None], np.sin(cells.phi)[:, None]
        outward, tangent = cos * e1 + sin * e2, cos * e2 - sin * e1
        arm = self.offset * u + self.radius * outward
        point = boxes.end[box] + arm
        rho = np.hypot(point[:, 0], point[:, 1])
        off_axis = np.maximum(rho, _TINY)
        out, up = rho - self.rho[cells.target], point[:, 2] - self.z[cells.target]
        distance = np.hypot(out, up)
        turn = np.minimum(boxes.turn, 2.0)
        along = 2.0 * self.radius * math.sin(0.5 * cells.half)
        moved = self.moved(boxes)[box] + along
        regular = rho > 2.0 * moved
        x, y = point[:, 0] / off_axis, point[:, 1] / off_axis

        # What is of second order in the box and the cell, whatever the direction.
        a, b = boxes.half[:, 2], boxes.half[:, 3]
        second = (0.5 * self.arm * (a**2 + b**2 + a * b))[box] + turn[box] * along
        by_alpha = np.cross(e2, arm)
        by_beta = np.cross(boxes.beta_axis[box], arm)
        rim = x * tangent[:, 0] + y * tangent[:, 1]
        steep = np.maximum(np.hypot(rim, tangent[:, 2]), _TINY)
        # The normal that serves best: from the target to the nearest point of the cell, taken as straight.
        tangent_rho, tangent_z = rim / steep, tangent[:, 2] / steep
        sideways = out * tangent_rho + up * tangent_z
        beyond = np.sign(sideways) * np.maximum(np.abs(sideways) - self.radius * cells.half * steep, 0.0)
        to_rho = out + (beyond - sideways) * tangent_rho
        to_z = up + (beyond - sideways) * tangent_z
        length = np.maximum(np.hypot(to_rho, to_z), _TINY)
        far = length > moved
        values, slopes, along_cell = [], [], []
        for side in (1.0, -1.0):
            n_rho = np.where(far, to_rho / length, -side * tangent_z)
            n_z = np.where(far, to_z / length, side * tangent_rho)
            normal = np.stack([n_rho * x, n_rho * y, n_z], axis=-1)
            bulge = np.maximum(np.einsum("ci,ci->c", normal, outward), 0.0)
            value = n_rho * out + n_z * up - second - self.radius * (1.0 - math.cos(cells.half)) * bulge
            value -= np.maximum(-n_rho, 0.0) * moved**2 / (2.0 * np.where(regular, rho - moved, 1.0))
            slope = np.stack(
                [
                    normal[:, 0],
                    normal[:, 2],
                    np.einsum("ci,ci->c", normal, by_alpha),
                    np.einsum("ci,ci->c", normal, by_beta),
                ],
                axis=-1,
            )
            values.append(np.where(regular, value, distance - moved))
            slopes.append(np.where(regular[:, None], slope * boxes.half[box, :4], 0.0))
            rate = self.radius * np.einsum("ci,ci->c", normal, tangent)
            along_cell.append(np.where(regular, rate, 0.0))
        return _Forms(
            np.stack(values),
            np.stack(slopes),
            np.stack(along_cell),
            cells.half,
            distance,
            distance - moved,
            point[:, 2] + moved,
        )

    def _combine(
        self, boxes: Boxes, cells: _Candidates, forms: _Forms, allowed: NDArray[np.bool_], enough: float
    ) -> Boxes:
        """Return the boxes that are left, with the best bound from the affine bounds of all their cells."""
        count, n = len(boxes), len(self.z)
        key = cells.box * n + cells.target
        starts = np.flatnonzero(np.concatenate([[True], key[1:] != key[:-1]]))
        sizes = np.diff(np.concatenate([starts, [len(key)]]))
        nearest = np.lexsort((forms.distance, key))[starts]
        all_values, all_slopes, loss = self._merged(boxes, cells, forms, nearest, starts, sizes)
        other = np.lexsort((loss, key))[starts]
        to_nearest = np.abs(forms.slopes - np.repeat(forms.slopes[:, nearest], sizes, axis=1)).sum(axis=(0, 2))
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
        cells: _Candidates,
        forms: _Forms,
        reference: NDArray[np.intp],
        starts: NDArray[np.intp],
        sizes: NDArray[np.intp],
        group: NDArray[np.bool_] | None = None,
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return affine bounds of each target, with the slopes of a reference cell, that hold for all its cells.

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
        count, n = len(boxes), len(self.z)
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
        count, n = len(boxes), len(self.z)
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


@dataclass(frozen=True, eq=False)
class _Forms:
    """Affine lower bounds of the distance of each candidate's target from its cell, in units of the box.

    Attributes:
        values: In the middle of box and cell, on both sides, shape (2, C), m.
        slopes: By the first four parameters, over the half-width of the box, shape (2, C, 4), m.
        along_cell: By the angle phi in the cell, shape (2, C), m / rad.
        half: Half the width of the cells, rad.
        distance: Of the middle of the cell from the target, shape (C,), m.
        floor: `distance` less all that moves, shape (C,), m.
        highest: Largest height in the cell, shape (C,), m.
    """

    values: FloatArray
    slopes: FloatArray
    along_cell: FloatArray
    half: float
    distance: FloatArray
    floor: FloatArray
    highest: FloatArray

    def take(self, chosen: NDArray[np.bool_]) -> _Forms:
        return _Forms(
            self.values[:, chosen],
            self.slopes[:, chosen],
            self.along_cell[:, chosen],
            self.half,
            self.distance[chosen],
            self.floor[chosen],
            self.highest[chosen],
        )

    def least(self) -> FloatArray:
        """Return lower bounds over the whole box and cell, shape (C,), m."""
        in_cell = np.abs(self.along_cell) * (self.half + self.half**3 / 6.0)
        over_box = self.values - np.abs(self.slopes).sum(axis=2) - in_cell
        return np.maximum(over_box.max(axis=0), self.floor)


def wrapped(angle: FloatArray) -> FloatArray:
    """Return angles moved by whole turns into [-pi, pi], rad."""
    return angle - 2.0 * math.pi * np.rint(angle / (2.0 * math.pi))

