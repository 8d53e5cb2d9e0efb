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

from synth.arrays import FloatArray, frozen
from synth.robot import ArmBody, turned

if TYPE_CHECKING:
    from collections.abc import Iterator

    from synth.robot import Arm
    from synth.synthesis.population import Population
    from synth.task import Task

PIECES = 16  # of the tube
COLUMN, ROD = 0, -1  # the base's column P1P2 and the rigid link, beside the pieces 1 to 16
ANY_TARGET = -1

_SAMPLES = 4  # of each piece
_ROD_SAMPLES = 48
# Planes are kept for what is nearer than this, m: farther than most steps of the solver move anything.
_NEAR = 0.06
_NEAR_ITSELF = 0.03


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


def overlaps(task: Task, population: Population, joints: FloatArray) -> FloatArray:
    """Return how deep shapes are inside obstacles at joint angles, at samples of tube and rod.

    Args:
        task: The task with its obstacles.
        population: The shapes, of shape (N,).
        joints: Joint angles for each target, shape (N, n, 2), rad.

    Returns:
        The largest depth of each shape at each target, shape (N, n), m; 0 where it is clear.
    """
    depth = np.zeros(joints.shape[:-1])
    robot = task.robot
    tube = population.centreline
    tip = population.kinematics.each_target().forward(0.0, joints[..., 1])
    share = np.linspace(0.0, 1.0, _ROD_SAMPLES // 4)[:, None]
    rod = tube[:, None, -1:] + share * (tip[..., None, :] - tube[:, None, -1:])
    for points, radius in (
        (np.broadcast_to(tube[:, None], (*depth.shape, *tube.shape[1:])), 0.5 * robot.link.diameter),
        (rod, 0.5 * robot.rigid_link.diameter),
    ):
        points = turned(points, joints[..., 0, None])
        for solid in task.solids:
            depth = np.maximum(depth, radius - solid.distance(points).min(axis=-1))
    return depth


def _from_obstacles(task: Task, arm: Arm, joints: FloatArray) -> Iterator[Separation]:
    body = ArmBody(arm)
    tube = body.tube(np.linspace(0.0, arm.shape.length, PIECES * _SAMPLES + 1))
    along = np.linspace(0.0, body.rod_length, _ROD_SAMPLES)
    pieces = np.arange(PIECES)[:, None] * _SAMPLES + np.arange(_SAMPLES + 1)
    for solid in task.solids:
        for target, (theta1, theta2) in enumerate(joints):
            tubes = turned(tube, theta1)[pieces]
            rod = turned(body.rod(along, theta2), theta1)
            for piece, points, radius in (
                *((index + 1, points, body.tube_radius) for index, points in enumerate(tubes)),
                (ROD, rod, body.rod_radius),
            ):
                distance = solid.distance(points)
                nearest = int(np.argmin(distance))
                if distance[nearest] < radius + _NEAR:
                    normal = solid.outward(points[nearest])
                    yield Separation(target, piece, None, normal, float(solid.support(normal)))


def _from_itself(arm: Arm, joints: FloatArray) -> Iterator[Separation]:
    body, link = ArmBody(arm), arm.robot.link
    length, joint = arm.shape.length, link.diameter
    along = np.linspace(0.0, length, PIECES * _SAMPLES + 1)
    column = np.linspace(-arm.robot.d12, 0.0, _SAMPLES + 1)
    pieces = np.vstack([column, along[np.arange(PIECES)[:, None] * _SAMPLES + np.arange(_SAMPLES + 1)]])
    tubes = body.tube(pieces)
    for one in range(PIECES + 1):
        for other in range(one):
            if pieces[one, 0] - pieces[other, -1] >= np.pi * link.min_bend_radius - length / PIECES:
                normal, distance = _apart(tubes[one], tubes[other])
                if distance < 2.0 * body.tube_radius + _NEAR_ITSELF:
                    yield Separation(ANY_TARGET, one, other, normal)
    rod = np.linspace(joint, max(body.rod_length, joint), _ROD_SAMPLES)
    for target, theta2 in enumerate(joints[:, 1]):
        rods = body.rod(rod, theta2)
        for piece in np.flatnonzero(pieces[:, -1] <= length - joint):
            normal, distance = _apart(rods, tubes[piece])
            if distance < body.rod_radius + body.tube_radius + _NEAR_ITSELF:
                yield Separation(target, ROD, int(piece), normal)


def _apart(one: FloatArray, other: FloatArray) -> tuple[FloatArray, float]:
    """Return the direction to the first of two rows of points from the second, and their distance."""
    apart = one[:, None] - other
    distance = np.linalg.norm(apart, axis=-1)
    nearest = np.unravel_index(np.argmin(distance), distance.shape)
    least = float(distance[nearest])
    if least > 0.0:
        return apart[nearest] / least, least
    across = np.cross(one[-1] - one[0], other[-1] - other[0])
    return across / max(float(np.linalg.norm(across)), 1e-12), 0.0
