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

from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen, frozen_value
from synth.robot import ArmBody, turned

if TYPE_CHECKING:
    from collections.abc import Iterator

    from synth.geometry import Solid
    from synth.robot import Arm
    from synth.task import Task

PIECES = 16  # of the tube
COLUMN = 0  # the base's column P1P2, beside the pieces 1 to 16
ROD = -1  # the rigid link
ANY_TARGET = -1

_GOLDEN_STEPS = 44
_GOLDEN = 0.5 * (np.sqrt(5.0) - 1.0)
_TURNS = 60
_CROSSING = 1e-9  # m; nearer segments cross
# Planes are kept for what is nearer than this, m: farther than most steps of the solver move anything.
_NEAR = 0.06
_NEAR_ITSELF = 0.03


@frozen_value
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

    The signed distance from a convex solid is a convex function, so a golden section finds them. It is our
    own: of nine segments in ten an end is nearest, and `scipy.optimize.elementwise.find_minimum` wants a
    point below both ends, and took 2.5 to 5 times the time.
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
