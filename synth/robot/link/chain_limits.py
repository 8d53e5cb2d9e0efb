"""The orthogonal projection of arcs' bends into the limits of the link: its threshold and its derivative."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.arrays import FloatArray


class Projection(NamedTuple):
    """The derivative of the projection into the limits, at rows of unknowns.

    A bend changes along itself where it is `free`, less the mean of all free ones where the total bend is
    `bounded`; across itself it changes by `scale`.
    """

    direction: FloatArray
    scale: FloatArray
    free: NDArray[np.bool_]
    bounded: NDArray[np.bool_]
    stretches: NDArray[np.bool_]

    def take(self, rows: NDArray[np.intp]) -> Projection:
        """Return the derivative at some of the rows."""
        return Projection(
            self.direction[rows], self.scale[rows], self.free[rows], self.bounded[rows], self.stretches[rows]
        )

    def between(self, jacobian: FloatArray) -> FloatArray:
        """Return J D J^T for matrices J, shape (n, m, unknowns), and the derivative D; shape (n, m, m)."""
        n, m, _ = jacobian.shape
        by_arc = jacobian[..., :-1].reshape(n, m, -1, 2)
        along = np.einsum("nmai,nai->nma", by_arc, self.direction)
        across = (
            by_arc[..., 1] * self.direction[:, None, :, 0] - by_arc[..., 0] * self.direction[:, None, :, 1]
        )
        # A bend of exactly zero has no direction, and moves freely.
        still = np.all(self.direction == 0.0, axis=-1)
        plain = np.where(still[:, None, :, None], by_arc, 0.0) * np.sqrt(self.scale)[:, None, :, None]
        along_free = along * self.free[:, None]
        product = along_free @ along_free.transpose(0, 2, 1)
        scaled = across * self.scale[:, None]
        product += scaled @ across.transpose(0, 2, 1)
        plain = plain.reshape(n, m, -1)
        product += plain @ plain.transpose(0, 2, 1)
        total = np.sum(along_free, axis=-1)
        count = np.maximum(np.sum(self.free, axis=-1), 1)
        product -= (self.bounded / count)[:, None, None] * total[:, :, None] * total[:, None, :]
        last = jacobian[..., -1] * self.stretches[:, None]
        product += last[:, :, None] * last[:, None, :]
        return np.asarray(product)


def threshold(bends: FloatArray, most: FloatArray) -> FloatArray:
    """Return the least tau >= 0 for which the sum of min(max(b - tau, 0), 1) is at most a bound, (...)."""
    tau = np.zeros(bends.shape[:-1])
    over = np.sum(np.minimum(bends, 1.0), axis=-1) > most
    if not over.any():
        return tau
    b, bound = bends[over], np.broadcast_to(most, tau.shape)[over][:, None]
    # The sum is piecewise linear in tau with corners at b - 1 and b.
    corners = np.sort(np.maximum(np.concatenate([b - 1.0, b, np.zeros((len(b), 1))], axis=-1), 0.0), axis=-1)
    sums = np.sum(np.clip(b[:, None, :] - corners[:, :, None], 0.0, 1.0), axis=-1)
    after = np.argmax(sums <= bound, axis=-1)[:, None]
    (t0, s0), (t1, s1) = (
        (np.take_along_axis(corners, i, axis=-1), np.take_along_axis(sums, i, axis=-1))
        for i in (np.maximum(after - 1, 0), after)
    )
    share = np.where(s0 > s1, (s0 - bound) / np.maximum(s0 - s1, 1e-300), 0.0)
    tau[over] = (t0 + share * (t1 - t0))[:, 0]
    return tau
