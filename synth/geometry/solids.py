"""Convex solids that a robot keeps clear of: spheres, boxes and capsules.

Each knows three things: the signed distance of points, the outward direction there, and its support
function. With them a solid is kept apart from a convex piece of a robot by a plane: outward direction n
and offset max over the solid of n . x leave the whole solid on one side.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from synth.arrays import FloatArray, GivenArray, frozen_value
from synth.checks import Checks
from synth.geometry.rotations import roll_pitch_yaw, rotation_of

_UP = np.array([0.0, 0.0, 1.0])


@frozen_value
class Sphere:
    """A ball.

    Attributes:
        centre: Its centre, shape (3,), m.
        radius: Its radius, m.
    """

    centre: GivenArray
    radius: float

    def __post_init__(self) -> None:
        checks = Checks(self)
        checks.array("centre", (3,))
        checks.number("radius", above=0.0)
        checks.refuse()

    @property
    def ends(self) -> FloatArray:
        """Its centre twice, shape (2, 3), m: a sphere is a capsule of no length."""
        return np.stack([self.centre, self.centre])

    def distance(self, points: FloatArray) -> FloatArray:
        """Return the signed distance of points, shape (..., 3), m; shape (...), negative inside."""
        return np.asarray(np.linalg.norm(points - self.centre, axis=-1) - self.radius)

    def outward(self, points: FloatArray) -> FloatArray:
        """Return the direction in which the distance grows, shape (..., 3), without unit."""
        away = points - self.centre
        length = np.linalg.norm(away, axis=-1, keepdims=True)
        return np.where(length > 0.0, away / np.where(length > 0.0, length, 1.0), _UP)

    def support(self, directions: FloatArray) -> FloatArray:
        """Return the largest n . x over the solid for unit vectors n, shape (..., 3); shape (...), m."""
        return np.asarray(directions @ self.centre + self.radius)

    def seen_from(self, position: FloatArray, rotation: FloatArray) -> Sphere:
        """Return the same solid in a frame at `position`, shape (3,), m, turned by a matrix, (3, 3)."""
        return Sphere((self.centre - position) @ rotation, self.radius)


@frozen_value
class Capsule:
    """All points within a radius of a segment.

    Attributes:
        ends: Ends of the segment, shape (2, 3), m.
        radius: The radius, m.
    """

    ends: GivenArray
    radius: float

    def __post_init__(self) -> None:
        checks = Checks(self)
        checks.array("ends", (2, 3))
        checks.number("radius", above=0.0)
        checks.refuse()

    def distance(self, points: FloatArray) -> FloatArray:
        """Return the signed distance of points, shape (..., 3), m; shape (...), negative inside."""
        return np.asarray(np.linalg.norm(self._from_segment(points), axis=-1) - self.radius)

    def outward(self, points: FloatArray) -> FloatArray:
        """Return the direction in which the distance grows, shape (..., 3), without unit."""
        away = self._from_segment(points)
        length = np.linalg.norm(away, axis=-1, keepdims=True)
        return np.where(length > 0.0, away / np.where(length > 0.0, length, 1.0), self._across())

    def support(self, directions: FloatArray) -> FloatArray:
        """Return the largest n . x over the solid for unit vectors n, shape (..., 3); shape (...), m."""
        return np.asarray((directions @ self.ends.T).max(axis=-1) + self.radius)

    def seen_from(self, position: FloatArray, rotation: FloatArray) -> Capsule:
        """Return the same solid in a frame at `position`, shape (3,), m, turned by a matrix, (3, 3)."""
        return Capsule((self.ends - position) @ rotation, self.radius)

    def _from_segment(self, points: FloatArray) -> FloatArray:
        start, along = self.ends[0], self.ends[1] - self.ends[0]
        share = np.clip((points - start) @ along / max(along @ along, 1e-300), 0.0, 1.0)
        return np.asarray(points - start - share[..., None] * along)

    def _across(self) -> FloatArray:
        """Return a direction across the segment, for points on it."""
        along = self.ends[1] - self.ends[0]
        if not along.any():
            return _UP
        across = np.cross(along, np.eye(3)[np.argmin(np.abs(along))])
        return np.asarray(across / np.linalg.norm(across))


@frozen_value
class Box:
    """A box.

    Attributes:
        centre: Its centre, shape (3,), m.
        size: Its extent along its own x, y and z axes, shape (3,), m.
        yaw: Rotation of these axes about the z axis, rad, after the two others.
        pitch: Rotation about the y axis, rad, after `roll`.
        roll: Rotation about the x axis, rad.
    """

    centre: GivenArray
    size: GivenArray
    yaw: float = 0.0
    pitch: float = 0.0
    roll: float = 0.0

    def __post_init__(self) -> None:
        checks = Checks(self)
        checks.array("centre", (3,))
        checks.array("size", (3,), above=0.0)
        for key in ("yaw", "pitch", "roll"):
            checks.number(key)
        checks.refuse()

    @cached_property
    def axes(self) -> FloatArray:
        """Its own axes as the columns of a rotation matrix, shape (3, 3)."""
        return rotation_of(self.roll, self.pitch, self.yaw)

    def distance(self, points: FloatArray) -> FloatArray:
        """Return the signed distance of points, shape (..., 3), m; shape (...), negative inside."""
        # Coordinate by coordinate: along an axis of three, numpy is several times as slow.
        x, y, z = np.moveaxis(np.abs(self._inside_frame(points)) - 0.5 * self.size, -1, 0)
        ox, oy, oz = (np.maximum(each, 0.0) for each in (x, y, z))
        inside = np.minimum(np.maximum(np.maximum(x, y), z), 0.0)
        return np.asarray(np.sqrt(ox * ox + oy * oy + oz * oz) + inside)

    def outward(self, points: FloatArray) -> FloatArray:
        """Return the direction in which the distance grows, shape (..., 3), without unit."""
        own = self._inside_frame(points)
        beyond = np.abs(own) - 0.5 * self.size
        outside = np.maximum(beyond, 0.0)
        nearest_face = np.where(beyond == beyond.max(axis=-1, keepdims=True), 1.0, 0.0)
        away = np.where((beyond > 0.0).any(axis=-1, keepdims=True), outside, nearest_face)
        away = np.where(own < 0.0, -away, away)
        return np.asarray(away / np.linalg.norm(away, axis=-1, keepdims=True) @ self.axes.T)

    def support(self, directions: FloatArray) -> FloatArray:
        """Return the largest n . x over the solid for unit vectors n, shape (..., 3); shape (...), m."""
        return np.asarray(directions @ self.centre + np.abs(directions @ self.axes) @ (0.5 * self.size))

    def seen_from(self, position: FloatArray, rotation: FloatArray) -> Box:
        """Return the same solid in a frame at `position`, shape (3,), m, turned by a matrix, (3, 3)."""
        return Box(
            (self.centre - position) @ rotation, self.size, *roll_pitch_yaw(rotation.T @ self.axes)[::-1]
        )

    def _inside_frame(self, points: FloatArray) -> FloatArray:
        return np.asarray((points - self.centre) @ self.axes)


Solid = Sphere | Box | Capsule
