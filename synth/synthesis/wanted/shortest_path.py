"""The shortest path through the free nodes of a grid of joint angles."""

from __future__ import annotations

import heapq
import itertools
import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

    import numpy as np
    from numpy.typing import NDArray


def shortest_path(
    free: NDArray[np.bool_], start: tuple[int, int], end: tuple[int, int]
) -> list[tuple[int, int]] | None:
    """Return the shortest path through free nodes of a grid and its diagonals, by Dijkstra's algorithm.

    The ends count as free, and so do their neighbours: the arm gets away from a target as it got there.
    """
    free = free.copy()
    for i, j in (start, end):
        free[max(i - 1, 0) : i + 2, max(j - 1, 0) : j + 2] = True
    distance, before = {start: 0.0}, {start: start}
    queue = [(0.0, start)]
    while queue:
        travelled, node = heapq.heappop(queue)
        if node == end:
            path = [node]
            while path[-1] != start:
                path.append(before[path[-1]])
            return path[::-1]
        if travelled > distance[node]:
            continue
        for neighbour in _neighbours(node, free):
            length = travelled + math.hypot(neighbour[0] - node[0], neighbour[1] - node[1])
            if length < distance.get(neighbour, math.inf):
                distance[neighbour], before[neighbour] = length, node
                heapq.heappush(queue, (length, neighbour))
    return None


def _neighbours(node: tuple[int, int], free: NDArray[np.bool_]) -> Iterator[tuple[int, int]]:
    for i, j in itertools.product((-1, 0, 1), repeat=2):
        neighbour = node[0] + i, node[1] + j
        inside = 0 <= neighbour[0] < free.shape[0] and 0 <= neighbour[1] < free.shape[1]
        if (i or j) and inside and free[neighbour]:
            yield neighbour
