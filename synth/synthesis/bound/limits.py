"""Which boxes of shapes the hardware rules out: the link's reach, its bending, and the floor."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen_value
from synth.robot import Interval, LinkReach

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.robot import MalleableLink
    from synth.synthesis.bound.boxes import Boxes
    from synth.task import Task

# Granted to every limit, m and rad: the verification grants half of it, and rounding is far below.
SLACK = 2e-6
_SPACING = 0.02  # of the table of margins, in units of the link's length
# `LinkReach.margin` takes the least distance from at least so many points of each curve of the boundary.
_CURVE_POINTS = 721
_SMALL_TURN = 0.15  # rad
_DIRECTIONS = 3  # tried as that of the straight part of the link


@frozen_value
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


@frozen_value
class Limits:
    """What a task and its robot rule out, box by box."""

    task: Task
    link: MalleableLink
    table: ReachTable

    @classmethod
    def of(cls, task: Task) -> Limits:
        """Tabulate what does not depend on the box, for a link with a little more freedom."""
        link = task.robot.link
        free = replace(
            link,
            length=Interval(link.length.lower - SLACK, link.length.upper + SLACK),
            min_bend_radius=link.min_bend_radius - SLACK,
            max_total_bend=link.max_total_bend + SLACK,
        )
        return cls(task, free, ReachTable.of(LinkReach(free)))

    @property
    def most_bend(self) -> float:
        """Largest total bend of the link, rad."""
        return min(self.link.max_total_bend, self.link.length.upper * self.link.max_curvature)

    @property
    def lowest_end(self) -> float:
        """Lowest height of the link's end, with the tube about it above the floor, m."""
        floor = self.task.floor_in_base
        return -math.inf if floor is None else floor + 0.5 * self.link.diameter

    @property
    def upturn(self) -> float:
        """Tightest radius in which every link can turn upright at its end, m; 0 if some are too short."""
        link = self.link
        needed = 0.5 * math.pi * link.min_bend_radius + 0.5 * link.diameter
        return link.min_bend_radius if needed <= link.length.lower else 0.0

    def allow_end(self, boxes: Boxes) -> NDArray[np.bool_]:
        """Whether some shape of each box may end within the reach and with P3 and P4 above the floor.

        Args:
            boxes: N boxes.

        Returns:
            Shape (N,); False is a proof.
        """
        robot, floor = self.task.robot, self.task.floor_in_base
        rho, h = boxes.middle[:, 0], boxes.middle[:, 1]
        radius = boxes.end_radius
        allowed = self.table.upper_bound(rho, h - robot.d12) >= -radius - SLACK
        value, _, known = self.length_cut(boxes)
        allowed &= ~known | (value <= radius + SLACK)
        if floor is not None:
            highest = h + boxes.half[:, 1]
            allowed &= highest >= self.lowest_end - SLACK
            rise = boxes.frame[0][:, 2]
            for along in (-robot.tip_offset, robot.d34 - robot.tip_offset):
                allowed &= highest + along * rise + abs(along) * np.minimum(boxes.turn, 2.0) >= floor - SLACK
        return np.asarray(allowed)

    def length_cut(self, boxes: Boxes) -> tuple[FloatArray, FloatArray, NDArray[np.bool_]]:
        """Return how much longer than the longest link the shortest way to the end is, and its slopes.

        Args:
            boxes: N boxes.

        Returns:
            At the middle, shape (N,), m; its slopes by rho and h, shape (N, 2); and in which boxes this
            affine function is at most 0 for every shape, shape (N,).
        """
        link, d12 = self.link, self.task.robot.d12
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

    def allow_direction(self, boxes: Boxes, psi: FloatArray, half: float | FloatArray) -> NDArray[np.bool_]:
        """Whether the link of some shape of each box may end in directions t near given ones.

        Args:
            boxes: N boxes.
            psi: Angles, shape (K,) or (N, K), rad.
            half: How far psi may be from them, rad; a number or of shape (N, 1).

        Returns:
            Shape (N, K); False is a proof.
        """
        _, e1, e2 = boxes.frame
        p = boxes.end - np.array([0.0, 0.0, self.task.robot.d12])
        chord = np.linalg.norm(p, axis=1)[:, None]
        cos, sin = np.cos(psi), np.sin(psi)
        along = np.einsum("bi,bi->b", p, e1)[:, None] * cos + np.einsum("bi,bi->b", p, e2)[:, None] * sin
        across = np.sqrt(np.maximum(chord**2 - along**2, 0.0))
        moved, turn = boxes.end_radius[:, None], boxes.turn[:, None] + half
        # The link run backwards is a link, too: it starts at p along -t and ends at P2.
        allowed = self.table.upper_bound(across, along) >= -(moved + chord * turn) - SLACK
        # A link that ends upwards has come from below.
        rise = np.clip(cos * e1[:, 2, None] + sin * e2[:, 2, None], -1.0, 1.0)
        flattest = np.minimum(np.arccos(rise) + turn, 0.5 * math.pi)
        highest = (boxes.middle[:, 1] + boxes.half[:, 1])[:, None]
        allowed &= highest - self.upturn * (1.0 - np.sin(flattest)) >= self.lowest_end - SLACK
        # Fenchel: no curve bends by less than the turns from its start to its chord to its end.
        away = chord > moved + SLACK
        swing = np.arcsin(np.minimum(moved / np.where(away, chord, 1.0), 1.0))
        bend = np.arctan2(np.hypot(p[:, 0], p[:, 1]), p[:, 2])[:, None] + np.arctan2(across, along)
        allowed &= ~away | (bend - 2.0 * swing - turn <= self.most_bend + SLACK)
        # The last proof only helps in boxes in which the turn at the end hardly changes.
        box, k = np.nonzero(allowed & (turn < _SMALL_TURN))
        some_psi = np.broadcast_to(psi, allowed.shape)[box, k][:, None]
        t = np.cos(some_psi) * e1[box] + np.sin(some_psi) * e2[box]
        turn = np.broadcast_to(turn, allowed.shape)[box, k]
        allowed[box, k] = _spans(self.link, self.most_bend, p[box], t, moved[box, 0], turn)
        return np.asarray(allowed)


def _spans(
    link: MalleableLink, most_bend: float, p: FloatArray, t: FloatArray, moved: FloatArray, turn: FloatArray
) -> NDArray[np.bool_]:
    """Whether the link is long enough to turn from z to a direction n, go along it, and turn to t.

    Any direction n gives a proof of NO; here it is about that of the straight part of the shortest way.

    Args:
        link: The link.
        most_bend: Its largest total bend, rad.
        p: The end seen from P2, shape (M, 3), m.
        t: Its direction, shape (M, 3).
        moved: How far the end may be from there, shape (M,), m.
        turn: How far its direction may be from there, shape (M,), rad.
    """
    r, longest = link.min_bend_radius, link.length.upper
    start = np.array([0.0, 0.0, 1.0])
    allowed, n = np.ones(len(p), dtype=bool), p
    if most_bend < math.pi:
        return allowed
    for step in range(_DIRECTIONS):
        n = n / np.maximum(np.linalg.norm(n, axis=-1, keepdims=True), 1e-12)
        cosines = [np.clip(np.einsum("...i,...i", direction, n), -1.0, 1.0) for direction in (start, t)]
        first, last = (np.arctan2(np.sqrt(1.0 - cosine**2), cosine) for cosine in cosines)
        beside = np.maximum(0.5 * (first + last - most_bend), 0.0)
        # The next direction: where p is no more beside the present one than its bound falls there.
        falls = r * np.cos(beside) + 0.5 * (longest - r * most_bend) * np.sin(beside)
        ahead = p - (r * (np.sin(first) + np.sin(last) - 2.0 * np.sin(beside)))[:, None] * n
        for direction, cosine in zip((start, t), cosines, strict=True):
            sine = np.maximum(np.sqrt(1.0 - cosine**2), 1e-6)
            ahead -= ((falls - r * cosine) / sine)[:, None] * (direction - cosine[:, None] * n)
        last = np.maximum(last - turn, 0.0)
        beside = np.maximum(0.5 * (first + last - most_bend), 0.0)
        straight = longest - r * (first + last - 2.0 * beside)
        most = r * (np.sin(first) + np.sin(last) - 2.0 * np.sin(beside)) + straight * np.cos(beside)
        allowed &= np.einsum("mi,mi->m", p, n) <= most + moved + SLACK
        # Full steps would go to and fro.
        ahead /= np.maximum(np.linalg.norm(ahead, axis=-1, keepdims=True), 1e-12)
        n = ahead if step == 0 else n + ahead
    return allowed
