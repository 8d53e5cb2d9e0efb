"""Which boxes of shapes the hardware rules out: the link's reach, its bending, and the floor."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from synth.robot import LinkReach

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.synthesis.bound.boxes import Boxes
    from synth.task import Task

SLACK = 1e-9  # m and rad, granted to every limit: far above all rounding, far below all that matters
_SPACING = 0.02  # of the table of margins, in units of the link's length
# `LinkReach.margin` takes the least distance from at least so many points of each curve of the boundary.
_CURVE_POINTS = 721


@dataclass(frozen=True, eq=False)
class ReachTable:
    """Upper bounds of the margin of a link's reach, from its values on a grid of the half-plane.

    Attributes:
        spacing: Of the grid, m.
        lowest: Height of its lowest nodes over the link's start, m.
        margins: Upper bounds of the margins at its nodes, shape (I, J), m.
    """

    spacing: float
    lowest: float
    margins: FloatArray

    @classmethod
    def of(cls, reach: LinkReach) -> ReachTable:
        """Tabulate a reach."""
        length = reach.link.length.upper
        spacing = _SPACING * length
        out, up = np.arange(0.0, 1.1, _SPACING) * length, np.arange(-1.1, 1.1, _SPACING) * length
        rho, h = np.meshgrid(out, up, indexing="ij")
        margins = reach.margin(np.stack([rho, np.zeros_like(rho), h], axis=-1))
        # A margin is the distance from the nearest of points that cover the boundary: the curves have a
        # parameter of at most a turn and a half, and at most max(L, 4 r) of length to a unit of it.
        step = 1.5 * 2.0 * math.pi / (_CURVE_POINTS - 1)
        between = 0.5 * step * max(length, 4.0 * reach.link.min_bend_radius)
        return cls(spacing, float(up[0]), margins + between)

    def upper_bound(self, rho: FloatArray, h: FloatArray) -> FloatArray:
        """Return upper bounds of the margins of points, seen from the link's start, shape (...), m.

        A margin changes by at most as much as its point moves.
        """
        rows, columns = self.margins.shape
        i = np.clip(np.rint(rho / self.spacing), 0, rows - 1).astype(np.intp)
        j = np.clip(np.rint((h - self.lowest) / self.spacing), 0, columns - 1).astype(np.intp)
        moved = np.hypot(rho - i * self.spacing, h - self.lowest - j * self.spacing)
        return np.asarray(self.margins[i, j] + moved)


@dataclass(frozen=True, eq=False)
class Limits:
    """What a task and its robot rule out, box by box."""

    task: Task
    table: ReachTable

    @classmethod
    def of(cls, task: Task) -> Limits:
        """Tabulate what does not depend on the box."""
        return cls(task, ReachTable.of(LinkReach(task.robot.link)))

    @property
    def most_bend(self) -> float:
        """Largest total bend of the link, rad."""
        link = self.task.robot.link
        return min(link.max_total_bend, link.length.upper * link.max_curvature)

    def allow_end(self, boxes: Boxes) -> NDArray[np.bool_]:
        """Whether some shape of each box may end within the reach and with P3 and P4 above the floor.

        Args:
            boxes: N boxes.

        Returns:
            Shape (N,); False is a proof.
        """
        robot, floor = self.task.robot, self.task.floor
        rho, h = boxes.middle[:, 0], boxes.middle[:, 1]
        radius = boxes.end_radius
        allowed = self.table.upper_bound(rho, h - robot.d12) >= -radius - SLACK
        value, _, known = self.length_cut(boxes)
        allowed &= ~known | (value <= radius + SLACK)
        if floor is not None:
            highest = h + boxes.half[:, 1]
            rise = boxes.frame[0][:, 2]
            for along in (-robot.tip_offset, robot.d34 - robot.tip_offset):
                allowed &= highest + along * rise + abs(along) * np.minimum(boxes.turn, 2.0) >= floor - SLACK
        return np.asarray(allowed)

    def length_cut(self, boxes: Boxes) -> tuple[FloatArray, FloatArray, NDArray[np.bool_]]:
        """Return how much longer than the longest link the shortest way to the end is, and its slopes.

        Args:
            boxes: N boxes.

        Returns:
            At the middle, shape (N,), m; its slopes by rho and h, shape (N, 2); and in which boxes this affine
            function is at most 0 for every shape, shape (N,).
        """
        link, d12 = self.task.robot.link, self.task.robot.d12
        r = link.min_bend_radius
        rho, h = boxes.middle[:, 0], boxes.middle[:, 1] - d12
        out = rho - r
        d = np.hypot(out, h)
        known = (d > r + boxes.end_radius + SLACK) & (rho >= 0.0)
        d = np.where(known, d, 2.0 * r)
        straight = np.sqrt(d**2 - r**2)
        turned = np.arctan2(h, -out)
        turned = np.where(turned < 0.0, turned + 2.0 * math.pi, turned) - np.arctan2(straight, r)
        known &= turned > 0.0
        slopes = np.stack([np.sin(turned), np.cos(turned)], axis=-1)
        return r * turned + straight - link.length.upper, slopes, known

    def allow_direction(self, boxes: Boxes, psi: FloatArray, half: float) -> NDArray[np.bool_]:
        """Whether the link of some shape of each box may end in directions t near given ones.

        Args:
            boxes: N boxes.
            psi: Angles, shape (K,), rad.
            half: How far psi may be from them, rad.

        Returns:
            Shape (N, K); False is a proof.
        """
        _, e1, e2 = boxes.frame
        p = boxes.end - np.array([0.0, 0.0, self.task.robot.d12])
        chord = np.linalg.norm(p, axis=1)
        cos, sin = np.cos(psi), np.sin(psi)
        along = np.einsum("bi,bi->b", p, e1)[:, None] * cos + np.einsum("bi,bi->b", p, e2)[:, None] * sin
        across = np.sqrt(np.maximum(chord[:, None] ** 2 - along**2, 0.0))
        turn = boxes.turn + half
        # The link run backwards is a link, too: it starts at p along -t and ends at P2.
        moved = boxes.end_radius + chord * turn
        allowed = self.table.upper_bound(across, along) >= -moved[:, None] - SLACK
        # Fenchel: no curve bends by less than the turns from its start to its chord to its end.
        away = chord > boxes.end_radius + SLACK
        swing = np.arcsin(np.minimum(boxes.end_radius / np.where(away, chord, 1.0), 1.0))
        bend = np.arctan2(np.hypot(p[:, 0], p[:, 1]), p[:, 2])[:, None] + np.arctan2(across, along)
        least = bend - (2.0 * swing + turn)[:, None]
        return np.asarray(allowed & (~away[:, None] | (least <= self.most_bend + SLACK)))
