"""Links that end as a box asks for: position, axis 2 and the direction along the link. Nothing is proven."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import frozen_value
from synth.robot import ANYWHERE, ArcChains, stepped, turned

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.robot import Interval, LinkShape, MalleableLink

_STEPS = 40


@frozen_value
class LinkEnd:
    """How a link is to end, up to a turn about axis 1.

    Attributes:
        position: Seen from P2, shape (3,), m.
        frame: Its columns are the direction of axis 2, that across, and that along the link, shape (3, 3).
    """

    position: FloatArray
    frame: FloatArray

    def links(self, link: MalleableLink, arcs: int, count: int, rng: np.random.Generator) -> list[LinkShape]:
        """Return links of equal arcs that end about so, the nearest first.

        Args:
            link: The link and its limits, which all of them keep.
            arcs: Number of arcs.
            count: How many.
            rng: Source of randomness.
        """
        chains = ArcChains(link, arcs)
        starts = np.column_stack([chains.random(count, rng), rng.uniform(-np.pi, np.pi, count)])
        aims = _Ends(
            np.broadcast_to(self.position / link.min_bend_radius, (count, 3)),
            np.broadcast_to(self.frame, (count, 3, 3)),
        )
        x, left = stepped(chains, aims, starts, _STEPS)
        return [chains.shape(x[row, :-1]) for row in np.argsort(left, kind="stable")]


@frozen_value
class _Ends:
    """Ends as aims of chains: positions in units of the bend radius, (n, 3), and frames, (n, 3, 3)."""

    p: FloatArray
    frames: FloatArray
    theta1: Interval = ANYWHERE

    def take(self, rows: NDArray[np.intp]) -> _Ends:
        """Return some of the ends."""
        return _Ends(self.p[rows], self.frames[rows])

    def off(self, chains: ArcChains, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return what is left of position and frame, shape (n, 12), and its derivative by x."""
        ends, count = chains.ends(x[:, :-1]), len(x)
        p = turned(self.p, -x[:, -1])
        frames = turned(self.frames.swapaxes(1, 2), -x[:, None, -1])  # directions as rows
        reached = ends.frame.swapaxes(1, 2)
        up = np.array([0.0, 0.0, 1.0])
        # A turn w moves a direction by w x direction; theta1 turns the aim back.
        by_turn = np.cross(up, frames).reshape(count, 9, 1)
        by_unknowns = np.cross(ends.rotation[:, None], reached[..., None], axis=2).reshape(count, 9, -1)
        d_position = np.concatenate([ends.d_position, np.cross(up, p)[..., None]], axis=-1)
        d_frame = np.concatenate([by_unknowns, by_turn], axis=-1)
        return (
            np.concatenate([ends.position - p, (reached - frames).reshape(count, 9)], axis=1),
            np.concatenate([d_position, d_frame], axis=1),
        )
