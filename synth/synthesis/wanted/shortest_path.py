"""The shortest path through the free nodes of a grid of joint angles."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

_STEPS = ((0, 1), (1, 0), (1, 1), (1, -1))  # and back
_NONE = -9999  # what csgraph calls no predecessor


def shortest_path(
    free: NDArray[np.bool_], start: tuple[int, int], end: tuple[int, int]
) -> list[tuple[int, int]] | None:
    """Return the shortest path through free nodes of a grid and its diagonals; None if there is none.

    The ends count as free, and so do their neighbours: the arm gets away from a target as it got there.

    Args:
        free: Which nodes are, shape (n, m).
        start: Where the path begins.
        end: Where it ends.
    """
    # On use: most ways are straight.
    from scipy.sparse import coo_array  # type: ignore[import-untyped]  # noqa: PLC0415
    from scipy.sparse.csgraph import dijkstra  # type: ignore[import-untyped]  # noqa: PLC0415

    free = free.copy()
    for i, j in (start, end):
        free[max(i - 1, 0) : i + 2, max(j - 1, 0) : j + 2] = True
    first, last = np.ravel_multi_index(np.transpose([start, end]), free.shape)
    lengths, steps = _steps(free)
    graph = coo_array((lengths, steps), shape=(free.size, free.size))
    _, before = dijkstra(graph, directed=False, indices=first, return_predecessors=True)
    path = [int(last)]
    while path[-1] != first:
        if before[path[-1]] == _NONE:
            return None
        path.append(int(before[path[-1]]))
    return [(node // free.shape[1], node % free.shape[1]) for node in path[::-1]]


def _steps(free: NDArray[np.bool_]) -> tuple[NDArray[np.float64], tuple[NDArray[np.intp], NDArray[np.intp]]]:
    """Return the lengths of the steps between free nodes, and between which they lead, each step once."""
    node = np.arange(free.size).reshape(free.shape)
    starts, ends, lengths = [], [], []
    for down, right in _STEPS:
        here = slice(0, free.shape[0] - down), slice(max(-right, 0), free.shape[1] - max(right, 0))
        there = slice(down, None), slice(max(right, 0), free.shape[1] + min(right, 0))
        both = free[here] & free[there]
        starts.append(node[here][both])
        ends.append(node[there][both])
        lengths.append(np.full(np.count_nonzero(both), np.hypot(down, right)))
    return np.concatenate(lengths), (np.concatenate(starts), np.concatenate(ends))
