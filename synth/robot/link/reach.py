r"""Where the malleable link's end can be, in closed form, for its length and bend radius.

The direction of the end is free. The link starts at P2 along z. Its reach is a solid of revolution about
z, so a position counts by its distance rho from that axis and its height h over P2. In units of the bend
radius r, with turns to the left leading towards the position and turns to the right leading away from it,
three lengths decide. With
d^2 = h^2 + (rho-1)^2 and D^2 = h^2 + (rho+1)^2, the distances from the centres of the two circles on which
the link can start,

    l1 = a + sqrt(d^2 - 1),  a = atan2(h, 1-rho) - atan(sqrt(d^2 - 1))    left turn a, then straight
    l2 = phi - delta + gamma                              right turn phi - delta, then left turn gamma
    l3 = phi + delta + 2 pi - gamma                       right, then the long way round to the left
    phi = atan2(h, rho+1),  cos(delta) = (D^2 + 3) / (4 D),  cos(gamma) = (5 - D^2) / 4

and the position is reached by exactly the lengths in

    [l1, l2] and [l3, inf)    where d >= 1, h >= 0;  where D > 3 there is no gap, l2 = l3 = inf;
    [l1, inf)                 where d >= 1, h < 0;
    [l3, inf)                 where d < 1.

Why. Let p be the constant costate of the position and M that of the direction. As the end's direction is
free, Pontryagin's principle gives M = p x (x(s) - x(L)) on a curve to the boundary of the reach, with the
curve turning about M: it stays in the plane of p and its tangent, turns fully off the line through x(L)
along p and is straight on it. So it is an arc and a straight, or an arc followed by n equal arcs no shorter
than it, or has full circles inserted; those with n = 2 and more, and the full circles, end inside. A position
enters or leaves the reach only at a length at which such a curve ends there. So the above holds for any
length: also beyond L = 2 pi r, up to which it is the theorem of Bae, Bai, Lee, Lee and Lee, "On the
reachability of 3-dimensional paths with a prescribed curvature bound", arXiv 2403.18707. The hole about P2
closes at L = (pi + 3 arccos(1/3)) r = 6.834 r.

The golden section for the margin is our own: `scipy.optimize.elementwise.find_minimum` wants a point below
both ends, so not the ends of a curve, and takes 3 times the time for one position and 1.1 times for 2000.
Both agree to 1e-14, but for some of 20 000 positions it stops 6e-7 bend radii away from the nearest point.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen
from synth.robot.link.reach_curves import GRID, TURN, Piece, boundary, distances, lengths_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from synth.robot.hardware import MalleableLink

_GOLDEN_STEPS = 32
_GOLDEN = 0.5 * (np.sqrt(5.0) - 1.0)
_BATCH = 2000  # positions at once, so that the table of distances stays small


@dataclass(frozen=True)
class LinkReach:
    """The set of positions of the link's end that some curve of the link's limits reaches.

    The limit of the total bend is left out: for a link that has one the set is an outer bound. What is
    not in it is certainly out of reach.

    Attributes:
        link: The malleable link: its interval of lengths L and its bend radius r.
    """

    link: MalleableLink

    def lengths(self, position: ArrayLike) -> FloatArray:
        """Return the lengths l1, l2, l3 between which, and beyond which, a link ends at a position.

        A link of length L reaches the position if l1 <= L <= l2 or l3 <= L; infinite where there is no such
        length.

        Args:
            position: The end seen from P2, z along the base axis, shape (..., 3), m.

        Returns:
            The lengths, shape (..., 3), m.
        """
        return self.link.min_bend_radius * lengths_of(self._half_plane(position))

    def contains(self, position: ArrayLike) -> NDArray[np.bool_]:
        """Whether a length of the interval reaches positions, shape (..., 3), m; shape (...)."""
        return self._holds(self._half_plane(position))

    def margin(self, position: ArrayLike) -> FloatArray:
        """Return how far positions are from the boundary of the reach, positive inside, negative outside.

        The distance is exact up to rounding: the margin changes by at most as much as a position moves.

        Args:
            position: The end seen from P2, shape (..., 3), m.

        Returns:
            The signed distance, shape (...), m.
        """
        points = self._half_plane(position)
        flat = points.reshape(-1, 2)
        batches = [self._distance(flat[i : i + _BATCH]) for i in range(0, len(flat), _BATCH)]
        distance = np.concatenate([*batches, np.empty(0)]).reshape(points.shape[:-1])
        return self.link.min_bend_radius * np.where(self._holds(points), distance, -distance)

    def boundary(self, count: int = 181) -> tuple[FloatArray, ...]:
        """Return the boundary in the half-plane of the base axis, for plots.

        Args:
            count: Number of points of each curve.

        Returns:
            For each smooth curve of the boundary its points (rho, h over P2), shape (count, 2), m. The base
            axis itself is not part of the boundary.
        """
        radius = self.link.min_bend_radius
        return tuple(
            frozen(radius * curve(np.linspace(first, last, count))) for curve, first, last in self._pieces
        )

    def sample(self, count: int, seed: int = 0) -> FloatArray:
        """Return random positions in the reach, uniform by volume, seen from P2, shape (count, 3), m.

        Args:
            count: Number of positions.
            seed: The same positions for the same seed.
        """
        rng = np.random.default_rng(seed)
        corners = np.concatenate(self.boundary())
        (widest, top), lowest = corners.max(axis=0), corners[:, 1].min()
        positions = np.empty((0, 3))
        while len(positions) < count:
            rho, turn = widest * np.sqrt(rng.uniform(size=2 * count)), rng.uniform(0.0, TURN, 2 * count)
            h = rng.uniform(lowest, top, 2 * count)
            drawn = np.column_stack([rho * np.cos(turn), rho * np.sin(turn), h])
            positions = np.concatenate([positions, drawn[self.contains(drawn)]])
        return positions[:count]

    @property
    def _extremes(self) -> tuple[float, float]:
        """Shortest and longest length, in units of the bend radius."""
        return (
            self.link.length.lower / self.link.min_bend_radius,
            self.link.length.upper / self.link.min_bend_radius,
        )

    def _half_plane(self, position: ArrayLike) -> FloatArray:
        x, y, z = np.moveaxis(np.asarray(position, dtype=np.float64), -1, 0) / self.link.min_bend_radius
        return np.stack([np.hypot(x, y), z], axis=-1)

    def _holds(self, points: FloatArray) -> NDArray[np.bool_]:
        shortest, longest = self._extremes
        first, last, again = np.moveaxis(lengths_of(points), -1, 0)
        return np.asarray(((first <= longest) & (shortest <= last)) | (again <= longest))

    @cached_property
    def _pieces(self) -> tuple[Piece, ...]:
        return boundary(*self._extremes)

    def _distance(self, points: FloatArray) -> FloatArray:
        """Return the distance of points, shape (n, 2), from the boundary, shape (n,)."""
        nearest = np.full(len(points), np.inf)
        for curve, first, last in self._pieces:
            grid = np.linspace(first, last, GRID)
            apart = points[:, None, :] - curve(grid)
            closest = np.argmin(np.einsum("nti,nti->nt", apart, apart), axis=1)
            lower, upper = grid[np.maximum(closest - 1, 0)], grid[np.minimum(closest + 1, GRID - 1)]
            for _ in range(_GOLDEN_STEPS):
                span = _GOLDEN * (upper - lower)
                left, right = upper - span, lower + span
                left_is_nearer = distances(points, curve(left)) < distances(points, curve(right))
                lower, upper = np.where(left_is_nearer, lower, left), np.where(left_is_nearer, right, upper)
            for t in (grid[closest], 0.5 * (lower + upper)):
                nearest = np.minimum(nearest, distances(points, curve(t)))
        return nearest
