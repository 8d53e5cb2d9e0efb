"""The arm in pieces that every reader knows: cylinders, spheres, capsules, and one tube of triangles.

A chord of an arc of curvature k and length l is off the arc by its sagitta s, k l^2 / 8 at most. A piece of
radius r + s about the chord holds the tube of radius r, and exceeds it by 2 s at most, on the inner side.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen, frozen_value
from synth.robot import arc_motion

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from synth.robot import LinkShape

EXCESS = 2e-3  # m, by which pieces exceed what they stand for at most
_SAGITTA, _SPHERES_EXCESS = 0.45 * EXCESS, 0.95 * EXCESS
_THINNEST = 1e-3  # m, radius of a piece: no reader takes one of none
_MESH_SAGITTA, _MESH_TURN, _MESH_SIDES = 1e-4, math.radians(8.0), 24  # of the tube that is shown


@frozen_value
class Chain:
    """Straight pieces one after the other, in the frame of the body that they belong to.

    Attributes:
        knees: Their ends, shape (n + 1, 3), m.
        radius: Of all of them, m.
        rounded: Whether there is a sphere at each knee; a lone cylinder may do without.
    """

    knees: FloatArray
    radius: float
    rounded: bool = True

    def __post_init__(self) -> None:
        object.__setattr__(self, "knees", frozen(self.knees))

    @property
    def chords(self) -> FloatArray:
        """From each knee to the next, shape (n, 3), m."""
        return np.diff(self.knees, axis=0)

    @property
    def middles(self) -> FloatArray:
        """The middle of each piece, shape (n, 3), m."""
        return 0.5 * (self.knees[1:] + self.knees[:-1])


@frozen_value
class Tube:
    """Triangles of a closed tube, for the eye.

    Attributes:
        vertices: Points in the frame of the body, shape (n, 3), m.
        faces: Indices of the vertices of each triangle, anticlockwise from outside, shape (m, 3).
    """

    vertices: FloatArray
    faces: NDArray[np.int64]


def stations(shape: LinkShape, longest: Callable[[float], float]) -> tuple[FloatArray, FloatArray]:
    """Return frames along a link; where arcs meet there is one.

    Args:
        shape: The shape of the link.
        longest: Returns how far apart they may be, m, where the link is bent with a curvature, 1/m.

    Returns:
        Rotations, shape (n, 3, 3), their third columns along the link, and positions, shape (n, 3), m, seen
        from the link's start; the first is that start, the last its end.
    """
    rotation, position = np.eye(3), np.zeros(3)
    rotations, positions = [rotation], [position]
    for curvature, length, bend in zip(shape.curvatures, shape.lengths, shape.bends, strict=True):
        if length == 0.0:
            continue
        count = max(1, math.ceil(length / longest(float(bend))))
        step, moved = arc_motion(curvature, length / count)
        for _ in range(count):
            position = position + rotation @ moved
            rotation = rotation @ step
            rotations.append(rotation)
            positions.append(position)
    return np.array(rotations), np.array(positions)


def _chord(sagitta: float, bend: float) -> float:
    """Return how long an arc may be to be within a sagitta of its chord, m."""
    return math.sqrt(8.0 * sagitta / bend) if bend > 0.0 else math.inf


def tube_pieces(shape: LinkShape, start: FloatArray, radius: float) -> Chain:
    """Return pieces that hold the tube about a link, and exceed it by `EXCESS` at most.

    Args:
        shape: The shape of the link.
        start: Where it starts along +z, shape (3,), m.
        radius: Radius of the tube, m.
    """
    _, positions = stations(shape, lambda bend: _chord(_SAGITTA, bend))
    return Chain(start + positions, max(radius + _SAGITTA, _THINNEST))


def rod_pieces(end: FloatArray, radius: float) -> Chain:
    """Return the one piece of a straight rod from the origin to its end, shape (3,), m."""
    return Chain(np.stack([np.zeros(3), end]), max(radius, _THINNEST))


def column_pieces(height: float, radius: float) -> Chain:
    """Return the one piece of the base's column, from P1 up to P2."""
    return Chain(np.array([[0.0, 0.0, 0.0], [0.0, 0.0, height]]), max(radius, _THINNEST), rounded=False)


def tube_spheres(shape: LinkShape, start: FloatArray, radius: float) -> tuple[FloatArray, float]:
    """Return spheres about the centreline whose union holds the tube, and exceeds it by `EXCESS` at most.

    Halfway between two centres d apart on an arc of radius rho, the point of the tube that is farthest from
    both lies outside of the bend, at sqrt(r^2 + (1 + r / rho) d^2 / 4) from them at most.

    Args:
        shape: The shape of the link.
        start: Where it starts along +z, shape (3,), m.
        radius: Radius r of the tube, m.

    Returns:
        Their centres, shape (n, 3), m, and the radius of all of them, m.
    """
    thick = radius + _SPHERES_EXCESS
    room = 2.0 * math.sqrt(thick**2 - radius**2)
    _, positions = stations(shape, lambda bend: room / math.sqrt(1.0 + radius * bend))
    return start + positions, thick


def rod_spheres(end: FloatArray, radius: float) -> tuple[FloatArray, float]:
    """Return spheres along a straight rod from the origin to its end, as `tube_spheres` does."""
    thick = radius + _SPHERES_EXCESS
    count = max(1, math.ceil(float(np.linalg.norm(end)) / (2.0 * math.sqrt(thick**2 - radius**2))))
    return np.linspace(0.0, 1.0, count + 1)[:, None] * end, thick


def tube_mesh(shape: LinkShape, start: FloatArray, radius: float) -> Tube:
    """Return the tube about a link as triangles, closed at both ends.

    Args:
        shape: The shape of the link.
        start: Where it starts along +z, shape (3,), m.
        radius: Radius of the tube, m.
    """
    rotations, positions = stations(
        shape, lambda bend: min(_chord(_MESH_SAGITTA, bend), _MESH_TURN / max(bend, 1e-9))
    )
    angles = np.linspace(0.0, 2.0 * np.pi, _MESH_SIDES, endpoint=False)
    ring = max(radius, _THINNEST) * np.column_stack([np.cos(angles), np.sin(angles), np.zeros(_MESH_SIDES)])
    rings = start + positions[:, None] + np.einsum("nij,kj->nki", rotations, ring)
    count = len(rings) * _MESH_SIDES
    index = np.arange(count).reshape(len(rings), _MESH_SIDES)
    following = np.roll(index, -1, axis=1)
    sides = [index[:-1], following[:-1], following[1:], index[:-1], following[1:], index[1:]]
    first, last = (np.full(_MESH_SIDES, count + end) for end in (0, 1))
    caps = [
        np.stack([first, following[0], index[0]], axis=-1),
        np.stack([last, index[-1], following[-1]], axis=-1),
    ]
    faces = np.concatenate([np.stack(sides, axis=-1).reshape(-1, 3), *caps])
    ends = start + positions[[0, -1]]
    return Tube(np.concatenate([rings.reshape(-1, 3), ends]), faces)
