"""Shapes that boxes promise to be better than the best found: where to look for a link. Nothing is proven."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from synth.synthesis.bound.cells import wrapped
from synth.synthesis.bound.ends import LinkEnd

if TYPE_CHECKING:
    from synth.arrays import FloatArray
    from synth.synthesis.bound.boxes import Boxes
    from synth.synthesis.bound.misses import MissBounds

_LOOKED_AT = 32  # boxes of a batch
_SMALL = 0.01  # m: P5 moves by less in boxes that are looked at
_APART = 0.05  # m: what is as near to a shape tried before is not tried
_TRIES = 6
_ANGLES = np.linspace(-np.pi, np.pi, 721)
_PSI = np.linspace(-1.0, 1.0, 17)


@dataclass
class Promising:
    """Chooses the middles of boxes that miss by less than any shape found.

    Attributes:
        bounds: Of the task.
        tried: Link's ends and directions of axis 2 of the shapes chosen so far, as rows, m.
    """

    bounds: MissBounds
    tried: FloatArray = field(default_factory=lambda: np.empty((0, 6)))

    def end(self, boxes: Boxes, better_than: float) -> LinkEnd | None:
        """Return how the best middle ends, if it is better than a miss, m, and new."""
        if len(self.tried) >= _TRIES or not len(boxes):
            return None
        small = np.flatnonzero((self.bounds.circle.moved(boxes) < _SMALL) & (boxes.bound < better_than))
        if not len(small):
            return None
        few = boxes.take(small[np.argsort(boxes.bound[small], kind="stable")[:_LOOKED_AT]])
        rows = np.hstack([few.end, self.bounds.circle.arm * few.frame[0]])
        apart = np.linalg.norm(rows[:, None] - self.tried, axis=-1).min(axis=1, initial=np.inf)
        misses, psi = self._misses(few)
        misses[apart <= _APART] = np.inf
        best = int(np.argmin(misses))
        if misses[best] >= better_than:
            return None
        self.tried = np.vstack([self.tried, rows[best]])
        u, e1, e2 = (axis[best] for axis in few.frame)
        t = np.cos(psi[best]) * e1 + np.sin(psi[best]) * e2
        d12 = self.bounds.limits.task.robot.d12
        return LinkEnd(few.end[best] - np.array([0.0, 0.0, d12]), np.stack([u, np.cross(t, u), t], axis=-1))

    def _misses(self, boxes: Boxes) -> tuple[FloatArray, FloatArray]:
        """Return about the worst weighted misses of middles at the best psi, m, and that, shape (N,) each."""
        bounds = self.bounds
        u, e1, e2 = (direction[:, None] for direction in boxes.frame)
        cos, sin = np.cos(_ANGLES)[:, None], np.sin(_ANGLES)[:, None]
        points = boxes.end[:, None] + bounds.circle.offset * u + bounds.circle.radius * (cos * e1 + sin * e2)
        rho, z = np.hypot(points[..., 0], points[..., 1])[..., None], points[..., 2, None]
        off = np.hypot(rho - bounds.circle.rho, z - bounds.circle.z) * bounds.factors
        off[points[..., 2] < bounds.floor] = np.inf
        psi = boxes.middle[:, 4, None] + _PSI * boxes.half[:, 4, None]
        allowed = bounds.limits.allow_direction(boxes, psi, 0.0)
        worst, best = np.full(len(boxes), np.inf), boxes.middle[:, 4].copy()
        for angle, possible in zip(psi.T, allowed.T, strict=True):
            within = (np.abs(wrapped(_ANGLES - angle[:, None])) <= bounds.window) & possible[:, None]
            at_psi = np.where(within[..., None], off, np.inf).min(axis=1).max(axis=1)
            best = np.where(at_psi < worst, angle, best)
            worst = np.minimum(worst, at_psi)
        return worst, best
