"""Limits of the hardware for rows of unknowns: into them, and along them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from synth.synthesis.shapes.columns import ARCS, BASE, CURVATURES, D35, D45, LENGTH

if TYPE_CHECKING:
    from synth.arrays import FloatArray
    from synth.robot import BaseRange, Interval, Robot

_AT_LIMIT = 1e-9
_TINY = 1e-300


def into_limits(robot: Robot, unknowns: FloatArray, places: BaseRange | None = None) -> FloatArray:
    """Return unknowns moved into the limits of the hardware: lengths, bend radius, total bend.

    Where the link would bend too much in all, every arc is straightened by the same share. The orthogonal
    projection of `ArcChains`, which straightens the gentle arcs first, was tried here: of 100 noisy tasks it
    lost two.

    Args:
        robot: The hardware.
        unknowns: As in `Shapes`, shape (..., 9 or more).
        places: Where the base may stand, if it is free.
    """
    unknowns = np.array(unknowns)
    link, rigid = robot.link, robot.rigid_link
    unknowns[..., LENGTH] = np.clip(unknowns[..., LENGTH], link.length.lower, link.length.upper)
    curvatures = unknowns[..., CURVATURES].reshape(*unknowns.shape[:-1], ARCS, 2)
    bends = np.linalg.norm(curvatures, axis=-1)
    shrink = 1.0 / np.maximum(bends, 1.0)
    total = np.sum(bends * shrink, axis=-1) * unknowns[..., LENGTH] * link.max_curvature / ARCS
    shrink = shrink / np.maximum(total / max(link.max_total_bend, 1e-12), 1.0)[..., None]
    unknowns[..., CURVATURES] = (curvatures * shrink[..., None]).reshape(*unknowns.shape[:-1], 2 * ARCS)
    if not rigid.is_fixed:
        # P3, P4, P5 must make a triangle: |d35 - d34| <= d45 <= d35 + d34.
        d35 = np.clip(unknowns[..., D35], rigid.d35.lower, rigid.d35.upper)
        d35 = np.clip(d35, rigid.d45.lower - robot.d34, rigid.d45.upper + robot.d34)
        d45 = np.clip(unknowns[..., D45], np.abs(d35 - robot.d34), d35 + robot.d34)
        unknowns[..., D35], unknowns[..., D45] = d35, np.clip(d45, rigid.d45.lower, rigid.d45.upper)
    if places is not None:
        unknowns[..., BASE] = places.into_limits(unknowns[..., BASE])
    return unknowns


def free_directions(
    robot: Robot, unknowns: FloatArray, places: BaseRange | None, slope: FloatArray
) -> FloatArray:
    """Return projections onto the directions in which shapes may move, shape (N, unknowns, unknowns).

    A limit that is reached, and beyond which a slope leads, takes away its normal.

    Args:
        robot: The hardware.
        unknowns: Of shapes within their limits, as in `Shapes`, shape (N, unknowns).
        places: Where the base may stand, if it is free.
        slope: Slopes of what is to become less, shape (N, unknowns).
    """
    x, count = unknowns, len(slope)
    free = np.tile(np.eye(x.shape[1]), (count, 1, 1))
    curvatures = x[:, CURVATURES].reshape(count, ARCS, 2)
    bends = np.linalg.norm(curvatures, axis=-1)
    bent = curvatures / np.maximum(bends, _TINY)[..., None]
    tighter = np.einsum("nai,nai->na", slope[:, CURVATURES].reshape(count, ARCS, 2), bent) < 0.0
    tightest = tighter & (bends >= 1.0 - _AT_LIMIT)
    for arc in range(ARCS):
        mine = slice(2 * arc, 2 * arc + 2)
        normal = bent[:, arc] * tightest[:, arc, None]
        free[:, mine, mine] -= normal[:, :, None] * normal[:, None, :]
    lower, upper = _ends(robot, places)
    held = (slope[:, LENGTH:] > 0.0) & (x[:, LENGTH:] <= lower + _AT_LIMIT)
    held |= (slope[:, LENGTH:] < 0.0) & (x[:, LENGTH:] >= upper - _AT_LIMIT)
    straight = np.arange(LENGTH, x.shape[1])
    free[:, straight, straight] -= held
    total = bends.sum(axis=1)
    normal = np.zeros(x.shape)
    normal[:, CURVATURES] = (bent * x[:, LENGTH, None, None]).reshape(count, -1)
    normal[:, LENGTH] = total
    normal = (free @ normal[..., None])[..., 0]
    squared = np.einsum("ni,ni->n", normal, normal)
    most = robot.link.max_total_bend * ARCS / robot.link.max_curvature
    held = (total * x[:, LENGTH] >= most - _AT_LIMIT) & (squared > _AT_LIMIT)
    held &= np.einsum("ni,ni->n", slope, normal) < 0.0  # it would bend more
    free -= (held / np.maximum(squared, _TINY))[:, None, None] * normal[:, :, None] * normal[:, None, :]
    return free


def free_lengths(robot: Robot) -> list[Interval]:
    """Return the limits of the unknowns that are lengths, m."""
    rigid = robot.rigid_link
    return [robot.link.length] if rigid.is_fixed else [robot.link.length, rigid.d35, rigid.d45]


def _ends(robot: Robot, places: BaseRange | None = None) -> FloatArray:
    """Return the least and the largest of the unknowns behind the curvatures, shape (2, k)."""
    of_lengths = np.array([(each.lower, each.upper) for each in free_lengths(robot)]).T
    return of_lengths if places is None else np.hstack([of_lengths, places.ends])
