"""Chains of equal torsion-free arcs as rows of unknowns: their ends, derivatives and limits, many at once."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from synth.robot.link.chain_limits import Projection, threshold
from synth.robot.link.shape import LinkShape, arc_motion

if TYPE_CHECKING:
    from synth.arrays import FloatArray
    from synth.robot.hardware import MalleableLink

_WITHIN = 1.0 - 1e-9  # share of the bends' limits that is used, so that rounding cannot exceed them
_SMALL = 0.02  # rad; arcs that turn less have their derivatives from power series


class ChainEnds(NamedTuple):
    """Ends of chains in units of the bend radius, and their derivatives by the unknowns.

    Attributes:
        frame: Rotation at the end, columns u, v, t, shape (n, 3, 3).
        position: Position p of the end, shape (n, 3).
        d_position: dp/dx, shape (n, 3, unknowns).
        rotation: The rotation vector by which the end frame turns, by x, shape (n, 3, unknowns).
    """

    frame: FloatArray
    position: FloatArray
    d_position: FloatArray
    rotation: FloatArray


@dataclass(frozen=True)
class ArcChains:
    """Chains of equal arcs. A row x holds their curvatures (kx, ky) in units of the largest, and q.

    The length is L = L_middle (1 + q / sqrt(arcs)): so the squared length of a change of x is, but for the
    factor of 1/arcs, the mean squared change of the curvature and the squared relative change of the length.

    Attributes:
        link: The link and its limits.
        arcs: Number of arcs.
    """

    link: MalleableLink
    arcs: int

    def random(self, count: int, rng: np.random.Generator, parts: int = 1) -> FloatArray:
        """Draw chains within the limits, shape (count, unknowns); curvatures are uniform in their disc.

        Args:
            count: How many.
            rng: Source of randomness.
            parts: How many arcs in sequence have the same curvature.
        """
        k = random_curvatures(count, self.arcs // parts, rng)
        share = rng.uniform(*self._shares, count)
        return self.into_limits(np.column_stack([np.repeat(k, parts, axis=1).reshape(count, -1), share]))

    def row(self, shape: LinkShape) -> FloatArray:
        """Return the unknowns nearest to a shape: the means of its curvature, shape (unknowns,)."""
        ends = np.concatenate([[0.0], np.cumsum(shape.lengths)]) / shape.length
        turned = np.concatenate(
            [np.zeros((1, 2)), np.cumsum(shape.curvatures * shape.lengths[:, None], axis=0)]
        )
        marks = np.linspace(0.0, 1.0, self.arcs + 1)
        turned = np.stack([np.interp(marks, ends, turned[:, i]) for i in range(2)], axis=-1)
        k = np.diff(turned, axis=0) * (self.arcs / shape.length * self.link.min_bend_radius)
        share = (shape.length / self.link.length.middle - 1.0) * np.sqrt(self.arcs)
        return np.append(k.ravel(), share)

    def refined(self, x: FloatArray, parts: int) -> tuple[ArcChains, FloatArray]:
        """Return chains of finer arcs, and the unknowns of the same curves in them."""
        finer = ArcChains(self.link, self.arcs * parts)
        k = np.repeat(self.curvatures(x), parts, axis=-2).reshape(*x.shape[:-1], -1)
        return finer, np.concatenate([k, x[..., -1:] * np.sqrt(parts)], axis=-1)

    def curvatures(self, x: FloatArray) -> FloatArray:
        """Return the curvatures in units of the largest, shape (..., arcs, 2)."""
        return np.asarray(x[..., :-1].reshape(*x.shape[:-1], self.arcs, 2))

    def length(self, x: FloatArray) -> FloatArray:
        """Return the length in units of the bend radius, shape (...)."""
        middle = self.link.length.middle / self.link.min_bend_radius
        return np.asarray(middle * (1.0 + x[..., -1] / np.sqrt(self.arcs)))

    def energy(self, x: FloatArray) -> FloatArray:
        """Return the bending energy in units of 1 / bend radius, shape (...)."""
        return np.asarray(np.sum(x[..., :-1] ** 2, axis=-1) * self.length(x) / self.arcs)

    def into_limits(self, x: FloatArray) -> FloatArray:
        """Return the nearest unknowns within the limits of the link; the length is brought in first."""
        x = np.array(x)
        x[..., -1] = np.clip(x[..., -1], *self._shares)
        return self.projected(x, self.length(x))[0]

    def projected(self, x: FloatArray, length: FloatArray) -> tuple[FloatArray, Projection]:
        """Return the nearest unknowns within the limits, the total bend being that of a given length.

        The bends b of a row become min(max(b - tau, 0), 1) with the least tau >= 0 that keeps their total:
        the orthogonal projection onto discs and a bounded sum of radii.

        Args:
            x: Unknowns, shape (n, unknowns).
            length: The length for which the total bend counts, in units of the bend radius, shape (n,).

        Returns:
            The unknowns within the limits, and what is needed of the projection's derivative.
        """
        k = self.curvatures(x)
        bends = np.hypot(k[..., 0], k[..., 1])
        most = self.link.max_total_bend * self.arcs / length
        tau = threshold(bends / _WITHIN, most)
        shrunk = bends / _WITHIN - tau[..., None]
        kept = _WITHIN * np.clip(shrunk, 0.0, 1.0)
        still = np.where(tau[..., None] == 0.0, 1.0, 0.0)
        scale = np.where(bends == 0.0, still, kept / np.maximum(bends, 1e-300))
        share = np.clip(x[..., -1:], *self._shares)
        inside = np.concatenate([(k * scale[..., None]).reshape(*x.shape[:-1], -1), share], axis=-1)
        direction = k / np.maximum(bends, 1e-300)[..., None]
        free = (shrunk > 0.0) & (shrunk < 1.0)
        return inside, Projection(direction, scale, free, tau > 0.0, share[..., 0] == x[..., -1])

    def ends(self, x: FloatArray) -> ChainEnds:
        """Return the ends of chains, shape (n, unknowns), with derivatives."""
        n = len(x)
        k, step = self.curvatures(x), self.length(x) / self.arcs
        rotation, displacement = arc_motion(k, np.broadcast_to(step[:, None], k.shape[:-1]))
        frames = np.empty((n, self.arcs + 1, 3, 3))
        points = np.empty((n, self.arcs + 1, 3))
        frames[:, 0], points[:, 0] = np.eye(3), 0.0
        for arc in range(self.arcs):
            frame = frames[:, arc]
            frames[:, arc + 1] = frame @ rotation[:, arc]
            points[:, arc + 1] = points[:, arc] + (frame @ displacement[:, arc, :, None])[..., 0]
        # How a change of each curvature turns and shifts the end of its arc, seen from the arc's start.
        turned, shifted = _arc_derivatives(k, step[:, None])
        turned, shifted = frames[:, :-1] @ turned, frames[:, :-1] @ shifted
        lever = points[:, -1:] - points[:, 1:]
        shifted = shifted + _cross(turned, lever[..., None], axis=2)
        bending = frames[:, :-1, :, 1] * k[..., :1] - frames[:, :-1, :, 0] * k[..., 1:]
        stretching = np.sum(frames[:, 1:, :, 2] + _cross(bending, lever, axis=2), axis=1)
        by_share = (self.link.length.middle / self.link.min_bend_radius / self.arcs**1.5) * np.ones((n, 1))
        d_position = np.concatenate([_columns(shifted), (by_share * stretching)[..., None]], axis=-1)
        turning = np.concatenate([_columns(turned), (by_share * np.sum(bending, axis=1))[..., None]], axis=-1)
        return ChainEnds(frames[:, -1], points[:, -1], d_position, turning)

    def shape(self, x: FloatArray) -> LinkShape:
        """Return one chain, shape (unknowns,), as a shape of the link, in metres."""
        radius = self.link.min_bend_radius
        lengths = np.full(self.arcs, float(self.length(x)) * radius / self.arcs)
        return LinkShape(self.curvatures(x) / radius, lengths)

    @property
    def _shares(self) -> tuple[float, float]:
        """The least and the largest q."""
        interval, root = self.link.length, np.sqrt(self.arcs)
        return (
            root * (interval.lower / interval.middle - 1.0),
            root * (interval.upper / interval.middle - 1.0),
        )


def random_curvatures(count: int, arcs: int, rng: np.random.Generator) -> FloatArray:
    """Draw curvatures (kx, ky) uniform in their disc, in units of the largest, shape (count, arcs, 2)."""
    bend = np.sqrt(rng.uniform(size=(count, arcs)))
    direction = rng.uniform(0.0, 2.0 * np.pi, (count, arcs))
    return np.stack([bend * np.cos(direction), bend * np.sin(direction)], axis=-1)


def _arc_derivatives(k: FloatArray, length: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return how arcs' ends turn and shift with (kx, ky), seen from the arcs' starts, each (..., 3, 2)."""
    kx, ky = k[..., 0], k[..., 1]
    length = np.broadcast_to(length, kx.shape)
    turn = np.hypot(kx, ky) * length
    small, square = turn < _SMALL, turn**2
    safe = np.where(small, 1.0, turn)
    sin, cos = np.sin(safe), np.cos(safe)
    versine = 0.5 * np.sinc(0.5 * turn / np.pi) ** 2  # (1 - cos) / turn^2
    rest = np.where(small, 1.0 / 6.0 - square / 120.0, (safe - sin) / safe**3)
    # By |k|, divided by |k|: of (1 - cos(k l)) / k^2 and of sin(k l) / k.
    d_versine = (
        np.where(small, -1.0 / 12.0 + square / 180.0, (safe * sin - 2.0 * (1.0 - cos)) / safe**4) * length**4
    )
    d_sine = np.where(small, -1.0 / 3.0 + square / 30.0, (safe * cos - sin) / safe**3) * length**3
    # With phi = l (-ky, kx, 0) the end turns by (1 + versine phi x + rest phi x phi x) d phi.
    px, py = -ky * length, kx * length
    turned = np.empty((*turn.shape, 3, 2))
    for column, (dx, dy) in enumerate(((0.0, 1.0), (-1.0, 0.0))):
        cross = px * dy - py * dx  # phi x d phi has only a z component
        turned[..., 0, column] = dx + rest * py * cross
        turned[..., 1, column] = dy - rest * px * cross
        turned[..., 2, column] = versine * cross
    turned *= length[..., None, None]
    flat = versine * length**2
    shifted = np.empty_like(turned)
    for column, along in enumerate((kx, ky)):
        shifted[..., 0, column] = kx * d_versine * along
        shifted[..., 1, column] = ky * d_versine * along
        shifted[..., 2, column] = d_sine * along
        shifted[..., column, column] += flat
    return turned, shifted


def _cross(one: FloatArray, two: FloatArray, axis: int) -> FloatArray:
    """Return vector products; for small arrays several times as fast as numpy's own."""
    (ax, ay, az), (bx, by, bz) = (np.moveaxis(each, axis, 0) for each in (one, two))
    return np.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], axis=axis)


def _columns(by_arc: FloatArray) -> FloatArray:
    """Return derivatives (n, arcs, 3, 2) as (n, 3, 2 arcs)."""
    n, arcs, rows, columns = by_arc.shape
    return np.moveaxis(by_arc, 2, 1).reshape(n, rows, arcs * columns)
