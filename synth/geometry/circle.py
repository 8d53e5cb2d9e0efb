"""The circle that P5 runs on about axis 2: swept about axis 1 it is the workspace surface."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, Self

import numpy as np

from synth.arrays import FloatArray, GivenArray, frozen, frozen_value
from synth.errors import GeometryError
from synth.geometry.closest_angles import closest_angles
from synth.geometry.distances import ArmDistances, realise, squared_distances
from synth.geometry.gamma import WorkspaceSurface

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


@frozen_value
class CircleAboutAxis:
    """A circle in space, about an axis of its own.

    Attributes:
        centre: Centre c of the circle, a point of the axis, shape (3,), m.
        axis: Direction u of the axis, shape (3,); stored with length 1.
        radius: Radius R of the circle, m.

    Raises:
        GeometryError: If the axis has no direction or the radius is negative.
    """

    centre: GivenArray
    axis: GivenArray
    radius: float

    def __post_init__(self) -> None:
        length = float(np.linalg.norm(self.axis))
        if not (length > 0.0 and self.radius >= 0.0):
            raise GeometryError("A circle needs an axis that is not zero and a radius that is not negative.")
        object.__setattr__(self, "centre", frozen(self.centre))
        object.__setattr__(self, "axis", frozen(np.asarray(self.axis) / length))

    @classmethod
    def from_points(cls, points: ArrayLike) -> Self:
        """Return the circle of P5 about the line from P3 to P4.

        Args:
            points: P1, ..., P5 in the base frame, shape (5, 3), m; or only the last three of them.
        """
        p3, p4, p5 = np.asarray(points, dtype=np.float64)[-3:]
        span = p4 - p3
        centre = p3 + span * np.dot(p5 - p3, span) / max(np.dot(span, span), np.finfo(np.float64).tiny)
        return cls(centre, span, float(np.linalg.norm(p5 - centre)))

    def axis_points(self, d34: float, offset: float) -> FloatArray:
        """Return P3 and P4, shape (2, 3), m: the points of axis 2 to be marked.

        Args:
            d34: Distance of P3 and P4, m.
            offset: From P3 to the centre of the circle along the axis, m; negative if P3 lies beyond.
        """
        return np.asarray(self.centre + np.outer([-offset, d34 - offset], self.axis))

    def points(self, angles: ArrayLike) -> FloatArray:
        """Return points of the circle, shape (..., 3), m, at angles, shape (...), rad, about u.

        Angle 0 is where the circle reaches out along the coordinate axis most nearly across u: an
        arbitrary choice, not the zero of joint 2.
        """
        start = _part_across(self.axis, np.eye(3)[np.argmin(np.abs(self.axis))])
        start /= np.linalg.norm(start)
        angles = np.asarray(angles, dtype=np.float64)[..., None]
        across = np.cos(angles) * start + np.sin(angles) * np.cross(self.axis, start)
        return np.asarray(self.centre + self.radius * across)


class SweptCircle(CircleAboutAxis):
    """Axis 2 and the circle of P5 about it, in the base frame (axis 1 is z, P1 the origin).

    It holds what a shape of the arm means for its workspace, wherever P3 and P4 are marked on axis 2, of
    which `axis` is the direction from P3 towards P4.
    """

    @classmethod
    def from_squared_distances(cls, distances: ArmDistances, *, chirality: Literal[1, -1] = 1) -> SweptCircle:
        """Return the circle of the arm with these squared distances; P3 stands as in `realise`.

        With P3 at the distance l = (s35 - s45 + s34) / (2 d34) before the centre, R^2 = s35 - l^2.

        Args:
            distances: The squared distances of the arm, m^2.
            chirality: Sign of the orientation of (P1, P2, P3, P4), which distances leave open.

        Raises:
            GeometryError: If no points in space have these distances or an axis has no direction.
        """
        s34, s35, s45 = distances.s34, distances.s35, distances.s45
        if not (distances.s12 > 0.0 and s34 > 0.0):
            raise GeometryError("P1 and P2, or P3 and P4, coincide: their axis has no direction.")
        offset = (s35 - s45 + s34) / (2.0 * np.sqrt(s34))
        realise(distances.matrix(0.0, 0.0)[2:, 2:])  # refuses a triangle P3, P4, P5 that does not close
        p3, p4 = realise(distances.axis_matrix, chirality=chirality)[2:]
        axis = (p4 - p3) / np.linalg.norm(p4 - p3)
        return cls(p3 + offset * axis, axis, float(np.sqrt(max(s35 - offset**2, 0.0))))

    @property
    def moment(self) -> float:
        """Mutual moment of the axes, (z x c) . u = +-a sin(alpha), m.

        It is 0 where they are parallel or meet, and has the sign of the orientation of (P1, P2, P3, P4).
        """
        return float(self.centre[0] * self.axis[1] - self.centre[1] * self.axis[0])

    def squared_distances(self, d12: float, d34: float, offset: float) -> ArmDistances:
        """Return the squared distances of the arm, m^2, with P1, ..., P4 marked on the axes.

        Args:
            d12: Distance of P1 and P2, m.
            d34: Distance of P3 and P4, m.
            offset: From P3 to the centre of the circle along the axis, m.
        """
        axis_1 = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, d12]])
        s = squared_distances(np.concatenate([axis_1, self.axis_points(d34, offset)]))
        s35, s45 = (self.radius**2 + along**2 for along in (offset, d34 - offset))
        s12, s13, s14, s23, s24, s34 = s[np.triu_indices(4, k=1)].tolist()
        return ArmDistances(s12, s13, s14, s23, s24, s34, s35, s45)

    def surface(self, d12: float, d34: float) -> WorkspaceSurface:
        """Return the surface that the circle sweeps about axis 1.

        With N' = N - |c|^2 - R^2, z' = z - c_z and _|_ for the part perpendicular to u, the vector
        w = N' z_|_ - 2 z' c_|_ runs round a circle of radius 2 R |moment| as P5 runs round its own:

            Gamma = -(s12 s34 / 4) (|w|^2 - 4 R^2 moment^2).

        So Gamma is minus a square wherever the moment is 0. Nothing is divided by sin(alpha), so that q is
        finite for every arm. d12 and d34 only scale Gamma: by d12 d34 = 2 the factor becomes -1.

        Args:
            d12: Distance of P1 and P2, m.
            d34: Distance of P3 and P4, m.
        """
        z_part = _part_across(self.axis, np.array([0.0, 0.0, 1.0]))
        c_part = _part_across(self.axis, self.centre)
        n_centre = float(np.dot(self.centre, self.centre)) + self.radius**2
        constant = 2.0 * self.centre[2] * c_part - n_centre * z_part
        q2 = 2.0 * np.dot(z_part, constant)
        q = [
            np.dot(z_part, z_part),
            -4.0 * np.dot(z_part, c_part) / d12,
            q2,
            q2 + 4.0 * np.dot(c_part, c_part),
            -4.0 * np.dot(c_part, constant) / d12,
            np.dot(constant, constant) - 4.0 * (self.radius * self.moment) ** 2,
        ]
        return WorkspaceSurface(d12, -((0.5 * d12 * d34) ** 2) * np.array(q))

    def closest_point(self, points: ArrayLike) -> FloatArray:
        """Return the point of the swept surface that is closest to each point, joint limits aside.

        Joint 1 turns any point into the half-plane (rho, z), where the surface is one closed curve and all
        minima of the distance are found: see `closest_angles`. It lies in the half-plane of its point. A
        point of axis 1 is as near to a whole circle, of which the point in the half-plane x > 0, y = 0 is
        returned; of other points that are equally close, any.

        No Gamma is needed, and so this holds in every category, also beyond the rims where the sphere or
        the plane ends but Gamma goes on, and for coincident axes, where Gamma vanishes everywhere.

        Args:
            points: Shape (..., 3), m.

        Returns:
            Shape (..., 3), m.
        """
        p = np.asarray(points, dtype=np.float64)
        rho, z = np.hypot(p[..., 0], p[..., 1]), p[..., 2]
        start, quarter = self.points([0.0, 0.5 * np.pi]) - self.centre
        angles = closest_angles(self.centre, start, quarter, rho.ravel(), z.ravel())
        nearest = self.points(angles).reshape(p.shape)
        off_axis = np.where(rho > 0.0, rho, 1.0)
        outwards = np.where(rho[..., None] > 0.0, p[..., :2] / off_axis[..., None], [1.0, 0.0])
        radial = np.hypot(nearest[..., 0], nearest[..., 1])
        return np.concatenate([radial[..., None] * outwards, nearest[..., 2:]], axis=-1)

    def distance(self, points: ArrayLike) -> FloatArray:
        """Return the distance |p - closest_point(p)| from points to the swept surface, joint limits aside.

        Args:
            points: Shape (..., 3), m.

        Returns:
            Shape (...), m.
        """
        p = np.asarray(points, dtype=np.float64)
        return np.asarray(np.linalg.norm(p - self.closest_point(p), axis=-1))

    def signed_distance(self, points: ArrayLike) -> FloatArray:
        """Return the distance to the swept surface, negative inside: where Gamma > 0.

        Skew axes sweep a closed tube, and in the coordinates (N, z) its section is an ellipse: inside is
        |w| < 2 R |moment|, with w as in `surface`. If the circle passes through axis 1 (a spindle torus),
        what it encloses about the axis is outside, as for Gamma. As the axes come to meet or to be
        parallel the tube flattens to a sheet with no inside: every point is then outside.

        Args:
            points: Shape (..., 3), m.

        Returns:
            Shape (...), m.
        """
        p = np.asarray(points, dtype=np.float64)
        inside = np.linalg.norm(self._across(p), axis=-1) < 2.0 * self.radius * abs(self.moment)
        return np.where(inside, -1.0, 1.0) * self.distance(p)

    def _across(self, points: FloatArray) -> FloatArray:
        """Return w = N' z_|_ - 2 z' c_|_ of `surface` at points, shape (..., 3), m^2."""
        n = np.sum(points**2, axis=-1) - np.dot(self.centre, self.centre) - self.radius**2
        z_part = _part_across(self.axis, np.array([0.0, 0.0, 1.0]))
        height = points[..., 2] - self.centre[2]
        return np.asarray(
            n[..., None] * z_part - 2.0 * height[..., None] * _part_across(self.axis, self.centre)
        )


def _part_across(axis: FloatArray, vector: FloatArray) -> FloatArray:
    """Return the part of a vector perpendicular to a unit vector, to rounding in the small part."""
    return np.cross(axis, np.cross(vector, axis))
