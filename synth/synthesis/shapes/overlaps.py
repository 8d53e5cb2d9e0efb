"""How deep shapes are inside obstacles and inside themselves: many at once, at samples of tube and rod."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from synth.robot import turned
from synth.watch import never

if TYPE_CHECKING:
    from collections.abc import Callable

    from synth.arrays import FloatArray
    from synth.geometry import Solid
    from synth.synthesis.shapes.shapes import Shapes
    from synth.task import Task

_ROD_SAMPLES = 8  # along a rod, where its least distance is looked for
_ROD_ZOOMS = 3  # times that they are drawn closer


def overlaps(
    task: Task,
    shapes: Shapes,
    joints: FloatArray,
    *,
    margin: float = 0.0,
    is_up: Callable[[], bool] = never,
) -> FloatArray:
    """Return how deep shapes are inside obstacles and inside themselves, at samples of tube and rod.

    Args:
        task: The task with its obstacles.
        shapes: The shapes, of shape (N,).
        joints: Joint angles for each target, shape (N, n, 2), rad.
        margin: What they are to keep from each other, m.
        is_up: Asked after each obstacle whether to leave out the others.

    Returns:
        The largest depth of each shape at each target, shape (N, n), m; 0 where it is clear.
    """
    robot, tube = task.robot, shapes.centreline
    radii = 0.5 * robot.link.diameter, 0.5 * robot.rigid_link.diameter
    end = tube[:, None, -1]
    rod = shapes.kinematics.each_target().forward(0.0, joints[..., 1]) - end
    depth = np.maximum(*_self_overlaps(shapes, end, rod, margin))
    solids = task.solids if shapes.places is None else task.solids_in_task
    if not solids:
        return depth
    theta1 = joints[..., 0, None]
    # Between the ends of the pieces, the middles of their chords serve, too.
    tube = np.concatenate([tube, 0.5 * (tube[:, 1:] + tube[:, :-1])], axis=1)
    tube = turned(np.broadcast_to(tube[:, None], (*depth.shape, *tube.shape[1:])), theta1)
    ends = turned(np.stack(np.broadcast_arrays(end, end + rod), axis=-2), theta1)
    if shapes.places is not None:
        tube, ends = shapes.bases.in_task(tube), shapes.bases.in_task(ends)
    # What no link reaches is in the way of none.
    reach = (
        float(shapes.length.max(initial=0.0))
        + float(np.linalg.norm(rod, axis=-1).max(initial=0.0))
        + max(radii)
        + margin
    )
    p2 = np.array([[0.0, 0.0, robot.d12]])
    if shapes.places is not None:
        p2 = shapes.bases.in_task(np.broadcast_to(p2, (len(depth), 3)))
    for solid in (solid for solid in solids if solid.distance(p2).min(initial=np.inf) < reach):
        if is_up():
            break
        depth = np.maximum(depth, radii[0] + margin - solid.distance(tube).min(axis=-1))
        depth = np.maximum(depth, radii[1] + margin - _least_along(solid, ends[..., 0, :], ends[..., 1, :]))
    return depth


def _least_along(solid: Solid, start: FloatArray, end: FloatArray) -> FloatArray:
    """Return about the least signed distances of segments, ends of shape (..., 3), from a solid, m.

    Along a segment it is convex, so the least is beside the least of the samples, which are drawn closer.
    """
    first, span = np.zeros((*start.shape[:-1], 1)), 1.0
    for _ in range(_ROD_ZOOMS):
        share = first + span * np.linspace(0.0, 1.0, _ROD_SAMPLES)
        distances = solid.distance(start[..., None, :] + share[..., None] * (end - start)[..., None, :])
        best = np.clip(np.argmin(distances, axis=-1), 1, _ROD_SAMPLES - 2)
        first = np.take_along_axis(share, best[..., None] - 1, axis=-1)
        span *= 2.0 / (_ROD_SAMPLES - 1)
    return np.asarray(distances.min(axis=-1))


def _self_overlaps(
    shapes: Shapes, end: FloatArray, rod: FloatArray, margin: float
) -> tuple[FloatArray, FloatArray]:
    """Return how deep the tube is inside itself, shape (N, 1), and the rod in the tube, shape (N, n), m.

    Args:
        shapes: The shapes, of shape (N,).
        end: Ends of their links, shape (N, 1, 3), m.
        rod: From there to P5 at each target, shape (N, n, 3), m.
        margin: What they are to keep from each other, m.
    """
    robot, nodes = shapes.robot, shapes.centreline
    # Between the ends of the pieces, the middles of their chords serve, too.
    tube = np.concatenate([nodes, 0.5 * (nodes[:, 1:] + nodes[:, :-1])], axis=1)
    share = np.arange(1.0, nodes.shape[1] + 1.0) / nodes.shape[1]
    along = np.concatenate([share, 0.5 * (share[1:] + share[:-1])]) * shapes.length[:, None]
    thickness = robot.link.diameter
    # What is nearer along the tube is its neighbourhood, or the joint (see `ArmBody`).
    apart = np.linalg.norm(tube[:, :, None] - tube[:, None], axis=-1)
    neighbours = np.abs(along[:, :, None] - along[:, None]) < np.pi * robot.link.min_bend_radius
    of_tube = thickness + margin - np.where(neighbours, np.inf, apart).min(axis=(1, 2))
    length = np.linalg.norm(rod, axis=-1, keepdims=True)
    direction = rod / np.where(length > 0.0, length, 1.0)  # none of a rod of no length
    from_end = tube - end
    reached = np.clip(from_end @ np.swapaxes(direction, 1, 2), thickness, np.swapaxes(length, 1, 2))
    off = from_end[:, :, None] - reached[..., None] * direction[:, None]
    joint = along > shapes.length[:, None] - thickness
    apart = np.where(joint[..., None], np.inf, np.linalg.norm(off, axis=-1))
    of_rod = 0.5 * (thickness + robot.rigid_link.diameter) + margin - apart.min(axis=1)
    return np.maximum(of_tube, 0.0)[:, None], np.maximum(of_rod, 0.0)
