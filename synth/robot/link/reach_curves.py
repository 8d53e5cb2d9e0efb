"""The curves that bound where the end of a link can be, in units of the bend radius."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from synth.arrays import FloatArray


TURN = 2.0 * np.pi
GRID = 721  # points of a boundary curve among which the nearest is looked for
_BISECTIONS = 50


class Piece(NamedTuple):
    """A piece of the boundary: t -> (rho, h), in units of the bend radius, for t from first to last."""

    curve: Callable[[FloatArray], FloatArray]
    first: float
    last: float


def arcs_to(points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return l2 and l3 of (rho, h) as if both arcs turned forwards; both infinite where D > 3."""
    rho, h = points[..., 0], points[..., 1]
    far = np.hypot(h, rho + 1.0)
    phi = np.arctan2(h, rho + 1.0)
    delta = np.arccos(np.minimum((far**2 + 3.0) / (4.0 * far), 1.0))
    gamma = np.arccos(np.clip((5.0 - far**2) / 4.0, -1.0, 1.0))
    beyond = far > 3.0
    return (
        np.where(beyond, np.inf, phi - delta + gamma),
        np.where(beyond, np.inf, phi + delta + TURN - gamma),
    )


def lengths_of(points: FloatArray) -> FloatArray:
    """Return l1, l2, l3 of (rho, h), all in units of the bend radius, shape (..., 3)."""
    rho, h = points[..., 0], points[..., 1]
    squared = h**2 + (rho - 1.0) ** 2 - 1.0
    straight = np.sqrt(np.maximum(squared, 0.0))
    direction = np.arctan2(h, 1.0 - rho)
    direction = np.where(direction < 0.0, direction + TURN, direction)
    first = np.maximum(direction - np.arctan(straight), 0.0) + straight
    last, again = arcs_to(points)
    inside, behind = squared < 0.0, h < 0.0
    return np.stack(
        [
            np.where(inside, np.inf, first),
            np.where(inside, -np.inf, np.where(behind, np.inf, last)),
            np.where(behind & ~inside, np.inf, again),
        ],
        axis=-1,
    )


def boundary(shortest: float, longest: float) -> tuple[Piece, ...]:
    """Return the curves of the boundary: l1 = longest, l2 = shortest, l3 = longest, and the circle d = 1.

    Args:
        shortest: Least length, in units of the bend radius.
        longest: Largest length, likewise.
    """

    def front(t: FloatArray) -> FloatArray:
        left = longest - t
        return np.stack([1.0 - np.cos(t) + left * np.sin(t), np.sin(t) + left * np.cos(t)], axis=-1)

    def circle(t: FloatArray) -> FloatArray:
        return np.stack([1.0 - np.cos(t), np.sin(t)], axis=-1)

    def two_arcs(length: float) -> Callable[[FloatArray], FloatArray]:
        def end(t: FloatArray) -> FloatArray:
            back = length - 2.0 * t
            return np.stack([2.0 * np.cos(t) - 1.0 - np.cos(back), 2.0 * np.sin(t) + np.sin(back)], axis=-1)

        return end

    def on_this_side(points: FloatArray) -> NDArray[np.bool_]:
        return points[..., 0] >= 0.0

    def before_return(points: FloatArray) -> NDArray[np.bool_]:
        return (points[..., 0] >= 0.0) & (points[..., 1] >= 0.0) & (arcs_to(points)[1] >= longest)

    def at_return(points: FloatArray) -> NDArray[np.bool_]:
        rho, h = points[..., 0], points[..., 1]
        inside = np.hypot(h, rho - 1.0) < 1.0
        return (rho >= 0.0) & (inside | ((h >= 0.0) & (arcs_to(points)[0] <= shortest)))

    # Beyond a full circle the front has crossed the axis for good at t = 3 pi / 2.
    last = longest if longest < TURN else 0.75 * TURN
    rear, inner = two_arcs(shortest), two_arcs(longest)
    return (
        *runs(front, 0.0, last, on_this_side),
        *runs(circle, shortest, min(longest, np.pi), before_return),
        *runs(rear, max(shortest - np.pi, 0.0), 0.5 * shortest, before_return),
        *runs(inner, max(longest - TURN, 0.0), min(longest - np.pi, 0.5 * longest), at_return),
    )


def runs(
    curve: Callable[[FloatArray], FloatArray],
    first: float,
    last: float,
    counts: Callable[[FloatArray], NDArray[np.bool_]],
) -> list[Piece]:
    """Return the pieces of a curve on which it counts; their ends are bisected."""
    if last <= first:
        return []
    grid = np.linspace(first, last, GRID)
    inside = np.concatenate([[False], counts(curve(grid)), [False]])
    pieces = []
    changes = np.flatnonzero(inside[1:] != inside[:-1])
    for start, stop in changes.reshape(-1, 2):
        begin = grid[0] if start == 0 else _switch(curve, counts, grid[start], grid[start - 1])
        end = grid[-1] if stop == GRID else _switch(curve, counts, grid[stop - 1], grid[stop])
        pieces.append(Piece(curve, begin, end))
    return pieces


def _switch(
    curve: Callable[[FloatArray], FloatArray],
    counts: Callable[[FloatArray], NDArray[np.bool_]],
    inside: float,
    outside: float,
) -> float:
    for _ in range(_BISECTIONS):
        middle = 0.5 * (inside + outside)
        if counts(curve(np.asarray(middle))):
            inside = middle
        else:
            outside = middle
    return inside


def distances(points: FloatArray, others: FloatArray) -> FloatArray:
    """Return the distances of points of the half-plane, shape (..., 2), from others."""
    return np.asarray(np.hypot(points[..., 0] - others[..., 0], points[..., 1] - others[..., 1]))
