"""From an end pose to a link: a chain of arcs within the link's limits that ends at a position along an axis.

The pose asked for is the end's position p and the direction u of axis 2, which the link's end frame
(u, v, t) has for its x axis; the rest is free. Thousands of random chains are compared with the pose, and the
nearest improved together by damped Gauss-Newton steps. Each step goes to the nearest chain within the limits
that meets the linearised pose, so that a chain slides along its limits and does not stick to them. Those
that arrive then move along the pose to the least bending energy, or to the least change of a present shape,
by steps of the same kind.

Every shape that is returned has been checked by its own forward kinematics against the pose and the limits.
That none was found proves nothing: for that there is `why_no_link`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import frozen_value
from synth.robot.hardware import turned
from synth.robot.link.arc_chains import ArcChains
from synth.robot.link.chain_steps import ARRIVED, Wish, eased, stepped
from synth.robot.link.end_pose import ANYWHERE, EndPoses, pose_miss, within
from synth.robot.link.shape import chain_end

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from synth.arrays import FloatArray
    from synth.robot.hardware import Interval, MalleableLink
    from synth.robot.link.shape import LinkShape

POSITION_TOLERANCE = 1e-9  # m
AXIS_TOLERANCE = 1e-8  # rad

_DRAWN = 20_000  # random chains that are compared with each pose
_COARSE = 4  # arcs of these
_PARTS = 3  # into which each of them is cut, and again where none arrives
_STARTS = (4, 32)  # chains that are improved for each pose; more where none arrives
_FINE_STARTS = 8  # of these, in finer arcs
_STEPS, _FINE_STEPS = 40, 120
_EASED = 3  # arrivals of a pose that move on
_BATCH = 128  # poses at once


def link_to_pose(
    link: MalleableLink,
    position: ArrayLike,
    axis: ArrayLike,
    *,
    current: LinkShape | None = None,
    theta1: Interval = ANYWHERE,
    seed: int = 0,
) -> LinkShape | None:
    """Return the gentlest shape found whose end is at a position, with axis 2 in a direction.

    This is `links_to_poses` for one pose: position and axis of shape (3,).
    """
    return links_to_poses(link, position, axis, current=current, theta1=theta1, seed=seed)[0]


def links_to_poses(
    link: MalleableLink,
    positions: ArrayLike,
    axes: ArrayLike,
    *,
    current: LinkShape | None = None,
    theta1: Interval = ANYWHERE,
    seed: int = 0,
) -> list[LinkShape | None]:
    """Return for each pose the gentlest shape found, or the one nearest to the present shape.

    Args:
        link: The link and its limits: length, bend radius and total bend.
        positions: Ends p of the link seen from P2, shape (n, 3), m.
        axes: Directions u of axis 2 from P3 to P4, shape (n, 3); their lengths do not count, their
            signs do.
        current: The present shape. If given, the shape returned is that with the least change: the mean
            square of r (k - k_current) along the centreline plus that of the length's relative change.
        theta1: Where joint 1 may stand, rad: anywhere unless told. The shape has the pose turned by
            -theta1, and `pose_miss` tells theta1. `Interval.fixed(0.0)` asks for the pose in the frame that
            the shape starts in.
        seed: The same shapes for the same seed.

    Returns:
        For each pose a shape of 12 or, where these do not do, 36 equal arcs; the present shape itself if it
        has the pose. It keeps all limits, and misses the pose by no more than `POSITION_TOLERANCE` and
        `AXIS_TOLERANCE`. None where none was found. Its bending energy, the integral of curvature squared,
        or its change, is a local minimum: the least of those found.
    """
    p = np.asarray(positions, dtype=np.float64).reshape(-1, 3) / link.min_bend_radius
    u = np.asarray(axes, dtype=np.float64).reshape(-1, 3)
    poses = EndPoses(p, u / np.linalg.norm(u, axis=1, keepdims=True), theta1)
    coarse = ArcChains(link, _COARSE)
    search = _Search(coarse, coarse.random(_DRAWN, np.random.default_rng(seed)), current)
    batches = [np.arange(first, min(first + _BATCH, len(p))) for first in range(0, len(p), _BATCH)]
    return [shape for rows in batches for shape in search.shapes(poses.take(rows))]


@frozen_value
class _Search:
    """Chains of few arcs, drawn at random, and the present shape."""

    coarse: ArcChains
    pool: FloatArray
    current: LinkShape | None

    def shapes(self, poses: EndPoses) -> list[LinkShape | None]:
        """Return the best shape found for each pose."""
        best = [self.present(poses, row) for row in range(len(poses.p))]
        for count in _STARTS:
            open_ = _missing(best)
            if not len(open_):
                return best
            some = poses.take(open_)
            chains, x = self.nearest(some, count)
            x, left = stepped(chains, some.repeated(count), x, _STEPS)
            self.keep_best(best, open_, poses, (chains, x, left))
        # At its limits a link is arcs of the tightest bend and straights, each of its own length.
        still = np.isin(open_, _missing(best))
        if not still.any():
            return best
        x, left = x.reshape(len(open_), count, x.shape[-1])[still], left.reshape(len(open_), count)[still]
        nearest = np.argsort(left, axis=1, kind="stable")[:, :_FINE_STARTS, None]
        x = np.take_along_axis(x, nearest, axis=1).reshape(-1, x.shape[-1])
        finer, k = chains.refined(x[:, :-1], _PARTS)
        some = poses.take(open_[still]).repeated(_FINE_STARTS)
        x, left = stepped(finer, some, np.column_stack([k, x[:, -1]]), _FINE_STEPS)
        self.keep_best(best, open_[still], poses, (finer, x, left))
        return best

    def present(self, poses: EndPoses, row: int) -> LinkShape | None:
        """Return the present shape if it has a pose already."""
        return self.current if self.current is not None and self.has(self.current, poses, row) else None

    def nearest(self, poses: EndPoses, count: int) -> tuple[ArcChains, FloatArray]:
        """Return the chains that come nearest to each pose when turned about the base axis as a whole.

        Returns:
            The chains, cut into finer arcs, and their rows, shape (poses * count, unknowns + 1).
        """
        k = self.coarse.curvatures(self.pool)
        step = np.repeat(self.coarse.length(self.pool)[:, None] / _COARSE, _COARSE, axis=1)
        frame, end = chain_end(k, step)
        azimuth, wanted = (np.arctan2(v[:, 1], v[:, 0]) for v in (end, poses.p))
        u = turned(poses.u, -wanted)
        own = turned(np.moveaxis(frame[..., :2], -1, 0), -azimuth)  # u and v, with the end in the xz plane
        along, across = u @ own[0].T, u @ own[1].T
        # With the curve turned by phi, and its start by theta1 of that, the end's x axis is that of the chain
        # turned about the tangent: cos(phi - theta1) u - sin(phi - theta1) v.
        phi = wanted[:, None] - azimuth
        theta1 = within(poses.theta1, phi - np.arctan2(-across, along))
        apart = -2.0 * (np.cos(phi - theta1) * along - np.sin(phi - theta1) * across)
        here, there = (np.column_stack([np.hypot(v[:, 0], v[:, 1]), v[:, 2]]) for v in (end, poses.p))
        apart += np.sum(here**2, axis=1) - 2.0 * there @ here.T
        best = np.argpartition(apart, count, axis=1)[:, :count]
        theta1, phi = (np.take_along_axis(angle, best, axis=1) for angle in (theta1, phi))
        k = turned(k[best], (phi - theta1)[..., None])
        x = np.concatenate([k.reshape(*best.shape, -1), self.pool[best][..., -1:]], axis=-1)
        chains, x = self.coarse.refined(x.reshape(-1, x.shape[-1]), _PARTS)
        return chains, np.column_stack([x, theta1.ravel()])

    def keep_best(
        self,
        best: list[LinkShape | None],
        rows: NDArray[np.intp],
        poses: EndPoses,
        chains_at: tuple[ArcChains, FloatArray, FloatArray],
    ) -> None:
        """Ease the best arrivals at each pose, and keep the best of them that passes the check."""
        chains, x, left = chains_at
        wish = Wish(chains, None if self.current is None else chains.row(self.current))
        cost = np.where(left <= ARRIVED, wish.cost(x), np.inf).reshape(len(rows), -1)
        x = x.reshape(*cost.shape, x.shape[-1])
        order = np.argsort(cost, axis=1, kind="stable")[:, :_EASED]
        pose, place = np.nonzero(np.isfinite(np.take_along_axis(cost, order, axis=1)))
        x = eased(chains, poses.take(rows[pose]), x[pose, order[pose, place]], wish)
        for one in np.argsort(wish.cost(x), kind="stable"):
            row = int(rows[pose[one]])
            shape = chains.shape(x[one, :-1])
            if best[row] is None and self.has(shape, poses, row):
                best[row] = shape

    def has(self, shape: LinkShape, poses: EndPoses, row: int) -> bool:
        """Whether a shape has a pose and keeps all limits."""
        link = self.coarse.link
        miss = pose_miss(shape, link.min_bend_radius * poses.p[row], poses.u[row], theta1=poses.theta1)
        return bool(
            miss.position <= POSITION_TOLERANCE
            and miss.axis <= AXIS_TOLERANCE
            and link.length.contains(shape.length, 1e-12)
            and shape.bends.max() <= link.max_curvature
            and shape.total_bend <= link.max_total_bend
        )


def _missing(shapes: list[LinkShape | None]) -> NDArray[np.intp]:
    return np.flatnonzero([shape is None for shape in shapes])
