"""Planes that keep an arm apart from obstacles and from itself, for the nonlinear program.

Two convex bodies are apart if and only if a plane is between them. The tube is cut into short pieces, each
within its sagitta of a chord, and the rod is straight; so a piece keeps a clearance c from a solid if both
its ends satisfy

    n . x >= max over the solid of n . y + radius + sagitta + c

for some unit vector n, and from another piece if n . (x - y) >= radii + sagittas + c for all ends x, y.
Given n these are smooth, and between the ends nothing is left to chance. Each n is the direction from the
nearest point at the shape that the solver starts from; new ones are taken where it ends.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, compared_by_value, frozen
from synth.robot import ArmBody, turned
from synth.synthesis.watch import never

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from synth.geometry import Solid
    from synth.robot import Arm
    from synth.synthesis.population import Population
    from synth.task import Task

PIECES = 16  # of the tube
COLUMN, ROD = 0, -1  # the base's column P1P2 and the rigid link, beside the pieces 1 to 16
ANY_TARGET = -1

_ROD_SAMPLES, _ROD_ZOOMS = 8, 3
_GOLDEN_STEPS = 44
_GOLDEN = 0.5 * (np.sqrt(5.0) - 1.0)
_TURNS = 60
_CROSSING = 1e-9  # m; nearer segments cross
# Planes are kept for what is nearer than this, m: farther than most steps of the solver move anything.
_NEAR = 0.06
_NEAR_ITSELF = 0.03


@compared_by_value
@dataclass(frozen=True, eq=False)
class Separation:
    """A plane between a piece of the arm and an obstacle, or another piece.

    Attributes:
        target: Index of the target at whose joint angles it holds; ANY_TARGET where they do not matter.
        piece: The piece: ROD, or 1 to PIECES along the tube.
        other: The piece on the other side, COLUMN among them; None if it is an obstacle.
        normal: Unit vector n towards the piece, shape (3,): in the base frame for an obstacle, at joint 1
            = 0 for another piece.
        offset: The largest n . y over the obstacle, m.
    """

    target: int
    piece: int
    other: int | None
    normal: FloatArray
    offset: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "normal", frozen(self.normal))


def separations(task: Task, arm: Arm, joints: FloatArray, *, itself: bool) -> tuple[Separation, ...]:
    """Return planes that keep an arm apart from what is near.

    Args:
        task: The task with its obstacles.
        arm: The arm to take the directions from.
        joints: Joint angles for each target, shape (n, 2), rad.
        itself: Whether to keep it apart from itself, too.
    """
    planes = list(_from_obstacles(task, arm, joints))
    return tuple(planes + list(_from_itself(arm, joints)) if itself else planes)


def overlaps(
    task: Task,
    population: Population,
    joints: FloatArray,
    *,
    margin: float = 0.0,
    is_up: Callable[[], bool] = never,
) -> FloatArray:
    """Return how deep shapes are inside obstacles and inside themselves, at samples of tube and rod.

    Args:
        task: The task with its obstacles.
        population: The shapes, of shape (N,).
        joints: Joint angles for each target, shape (N, n, 2), rad.
        margin: What they are to keep from each other, m.
        is_up: Asked after each obstacle whether to leave out the others.

    Returns:
        The largest depth of each shape at each target, shape (N, n), m; 0 where it is clear.
    """
    robot, tube = task.robot, population.centreline
    radii = 0.5 * robot.link.diameter, 0.5 * robot.rigid_link.diameter
    end = tube[:, None, -1]
    rod = population.kinematics.each_target().forward(0.0, joints[..., 1]) - end
    depth = np.maximum(*_self_overlaps(population, end, rod, margin))
    if not task.solids:
        return depth
    theta1 = joints[..., 0, None]
    # Between the ends of the pieces, the middles of their chords serve, too.
    tube = np.concatenate([tube, 0.5 * (tube[:, 1:] + tube[:, :-1])], axis=1)
    tube = turned(np.broadcast_to(tube[:, None], (*depth.shape, *tube.shape[1:])), theta1)
    ends = turned(np.stack(np.broadcast_arrays(end, end + rod), axis=-2), theta1)
    # What no link reaches is in the way of none.
    reach = (
        float(population.length.max(initial=0.0))
        + float(np.linalg.norm(rod, axis=-1).max(initial=0.0))
        + max(radii)
        + margin
    )
    near = [solid for solid in task.solids if solid.distance(np.array([0.0, 0.0, robot.d12])) < reach]
    for solid in near:
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
    population: Population, end: FloatArray, rod: FloatArray, margin: float
) -> tuple[FloatArray, FloatArray]:
    """Return how deep the tube is inside itself, shape (N, 1), and the rod in the tube, shape (N, n), m.

    Args:
        population: The shapes, of shape (N,).
        end: Ends of their links, shape (N, 1, 3), m.
        rod: From there to P5 at each target, shape (N, n, 3), m.
        margin: What they are to keep from each other, m.
    """
    robot, nodes = population.robot, population.centreline
    # Between the ends of the pieces, the middles of their chords serve, too.
    tube = np.concatenate([nodes, 0.5 * (nodes[:, 1:] + nodes[:, :-1])], axis=1)
    share = np.arange(1.0, nodes.shape[1] + 1.0) / nodes.shape[1]
    along = np.concatenate([share, 0.5 * (share[1:] + share[:-1])]) * population.length[:, None]
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
    joint = along > population.length[:, None] - thickness
    apart = np.where(joint[..., None], np.inf, np.linalg.norm(off, axis=-1))
    of_rod = 0.5 * (thickness + robot.rigid_link.diameter) + margin - apart.min(axis=1)
    return np.maximum(of_tube, 0.0)[:, None], np.maximum(of_rod, 0.0)


def _from_obstacles(task: Task, arm: Arm, joints: FloatArray) -> Iterator[Separation]:
    body = ArmBody(arm)
    nodes = body.tube(np.linspace(0.0, arm.shape.length, PIECES + 1))
    link = turned(nodes, joints[:, :1])
    rod = np.stack([link[:, -1], turned(body.rod(np.asarray(body.rod_length), joints[:, 1]), joints[:, 0])])
    start = np.concatenate([link[:, :-1], rod[:1].swapaxes(0, 1)], axis=1)
    end = np.concatenate([link[:, 1:], rod[1:].swapaxes(0, 1)], axis=1)
    radius = np.append(np.full(PIECES, body.tube_radius), body.rod_radius)
    for solid in task.solids:
        nearest = _nearest_to_solid(solid, start, end)
        near = solid.distance(nearest) < radius + _NEAR
        for target, piece in np.argwhere(near).tolist():
            normal = solid.outward(nearest[target, piece])
            number = ROD if piece == PIECES else piece + 1
            yield Separation(target, number, None, normal, float(solid.support(normal)))


def _from_itself(arm: Arm, joints: FloatArray) -> Iterator[Separation]:
    body, link = ArmBody(arm), arm.robot.link
    along = np.append(-arm.robot.d12, np.linspace(0.0, arm.shape.length, PIECES + 1))
    nodes = body.tube(along)
    one, other = np.tril_indices(PIECES + 1, -1)
    # What is nearer along the tube is its neighbourhood (see `ArmBody`).
    far = along[one] - along[other + 1] >= np.pi * link.min_bend_radius - arm.shape.length / PIECES
    one, other = one[far], other[far]
    normals, distances = _apart(nodes[one], nodes[one + 1], nodes[other], nodes[other + 1])
    for k in np.flatnonzero(distances < 2.0 * body.tube_radius + _NEAR_ITSELF):
        yield Separation(ANY_TARGET, int(one[k]), int(other[k]), normals[k])
    joint, length = link.diameter, body.rod_length
    clear = np.flatnonzero(along[1:] <= arm.shape.length - joint)
    for target, theta2 in enumerate(joints[:, 1]):
        start, end = body.rod(np.array([min(joint, length), length]), theta2)
        normals, distances = _apart(start, end, nodes[clear], nodes[clear + 1])
        for k in np.flatnonzero(distances < body.rod_radius + body.tube_radius + _NEAR_ITSELF):
            yield Separation(target, ROD, int(clear[k]), normals[k])


def _nearest_to_solid(solid: Solid, start: FloatArray, end: FloatArray) -> FloatArray:
    """Return the points of segments, ends of shape (..., 3), that are nearest to a solid, or deepest.

    The signed distance from a convex solid is a convex function, so a golden section finds them.
    """
    lower, upper = np.zeros((*start.shape[:-1], 1)), np.ones((*start.shape[:-1], 1))
    for _ in range(_GOLDEN_STEPS):
        span = _GOLDEN * (upper - lower)
        left, right = upper - span, lower + span
        left_is_nearer = (
            solid.distance(start + left * (end - start)) < solid.distance(start + right * (end - start))
        )[..., None]
        lower, upper = np.where(left_is_nearer, lower, left), np.where(left_is_nearer, right, upper)
    return np.asarray(start + 0.5 * (lower + upper) * (end - start))


def _apart(
    start: FloatArray, end: FloatArray, other_start: FloatArray, other_end: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the directions to segments from others where they are nearest, (..., 3), and the distances.

    The squared distance is convex in both places along the segments: each in turn is set to its best.
    """
    along, other_along = end - start, other_end - other_start
    place = np.full(np.broadcast_shapes(start.shape, other_start.shape)[:-1], 0.5)
    for _ in range(_TURNS):
        point = start + place[..., None] * along
        other_place = _clipped_share(point - other_start, other_along)
        place = _clipped_share(other_start + other_place[..., None] * other_along - start, along)
    apart = start + place[..., None] * along - other_start - other_place[..., None] * other_along
    distance = np.linalg.norm(apart, axis=-1)
    across = np.cross(along, other_along)
    normal = np.where(distance[..., None] > _CROSSING, apart, across)
    return normal / np.maximum(np.linalg.norm(normal, axis=-1, keepdims=True), 1e-12), distance


def _clipped_share(vector: FloatArray, along: FloatArray) -> FloatArray:
    squared = np.maximum(np.einsum("...i,...i", along, along), 1e-30)
    return np.asarray(np.clip(np.einsum("...i,...i", vector, along) / squared, 0.0, 1.0))
