"""How far an arm keeps clear of obstacles and of itself: along its continuous curve, not at samples.

The arm is a tube about the centreline of the malleable link, with the base's column P1P2 as its first
straight piece, and a rod from the link's end to P5. Every clearance here is a lower bound: along a curve
the distance to anything changes no faster than the arc length, so values at points bound it between them
(`least_values`).

What is in contact by construction is left out. The link's first half diameter sits in its mount. Pieces
of the tube less than pi r apart along it (r the least bend radius) only touch where they are neighbours:
a curve of curvature at most 1/r that is s <= pi r long has a chord of at least 2 r sin(s / 2r) (Schur).
And within a diameter of the second joint link and rod are the joint.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from synth.geometry import least_values

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.geometry import Solid
    from synth.robot.arm import Arm

_TOLERANCE = 2e-5  # m, by which a stated clearance may be less than the true one
_CEILING = 0.1  # m; a clearance beyond is stated as this much
_SELF_CEILING = 0.02  # m, likewise for what the arm keeps from itself


@dataclass(frozen=True)
class ArmBody:
    """The room that an arm takes up, in its base frame.

    Attributes:
        arm: The arm.
    """

    arm: Arm

    @property
    def tube_radius(self) -> float:
        """Half the diameter of the malleable link, m."""
        return 0.5 * self.arm.robot.link.diameter

    @property
    def rod_radius(self) -> float:
        """Half the diameter of the rigid link, m."""
        return 0.5 * self.arm.robot.rigid_link.diameter

    @property
    def rod_length(self) -> float:
        """Distance from the link's end to P5, m."""
        offset, radius = self.arm.robot.end_effector_circle(self.arm.d35, self.arm.d45)
        return math.hypot(offset, radius)

    def tube(self, along: FloatArray) -> FloatArray:
        """Return points of the tube's centreline at joint 1 = 0, shape (..., 3), m.

        Args:
            along: Distance along it from P2, shape (...), m: negative down to P1, then the link.
        """
        points = self.arm.shape.point_at(np.maximum(along, 0.0)) + self.arm.base_joint[1]
        points[..., 2] += np.minimum(along, 0.0)
        return np.asarray(points)

    def rod(self, along: FloatArray, theta2: FloatArray) -> FloatArray:
        """Return points of the rod's centreline at joint 1 = 0, shape (..., 3), m.

        Args:
            along: Distance from the link's end, shape (...), m.
            theta2: Angle of joint 2, shape (...), rad.
        """
        end = self.arm.end_frame[1]
        tip = self.arm.kinematics.forward(0.0, theta2)
        return np.asarray(end + (along / self.rod_length)[..., None] * (tip - end))

    def lowest(self) -> float:
        """Return the height of the lowest point of the tube beyond its mount, m; exact."""
        shape = self.arm.shape
        return (
            self.arm.robot.d12 + shape.lowest(beyond=min(self.tube_radius, shape.length)) - self.tube_radius
        )

    def from_obstacles(self, joints: FloatArray, solids: Sequence[Solid]) -> FloatArray:
        """Return how far tube and rod keep from solids at joint angles.

        Args:
            joints: Angles (theta1, theta2), shape (n, 2), rad.
            solids: Solids in the base frame.

        Returns:
            Lower bounds of the distance between the surfaces, at most 0.1 m, negative inside; shape
            (n, len(solids), 2), the tube first.
        """
        return self.from_obstacles_between(joints, joints, solids)

    def from_obstacles_between(
        self, start: FloatArray, end: FloatArray, solids: Sequence[Solid], ceiling: float = _CEILING
    ) -> FloatArray:
        """Return how far tube and rod keep from solids on straight motions of both joints.

        On the way a point moves by no more than |d theta1| times its distance from axis 1, plus, on the
        rod, |d theta2| times the radius of P5's circle.

        Args:
            start: Joint angles at the start, shape (n, 2), rad.
            end: Joint angles at the end, shape (n, 2), rad.
            solids: Solids in the base frame.
            ceiling: Largest clearance that is told from larger ones, m.

        Returns:
            As `from_obstacles`.
        """
        motions, count = len(start), len(solids)
        motion = np.repeat(np.arange(motions), count)
        solid = np.tile(np.arange(count), motions)
        turn, second = np.abs(end - start).T[:, motion]
        bounds = np.empty((motions * count, 2))
        link, rod = self.arm.shape.length, self.rod_length

        def distance(which: NDArray[np.intp], points: FloatArray, share: FloatArray) -> FloatArray:
            joints = self._between(start, end, motion[which], share)
            points = turned(points, joints[:, 0])
            values = np.empty(len(which))
            for index, each in enumerate(solids):
                mine = solid[which] == index
                values[mine] = each.distance(points[mine])
            return values

        def tube(which: NDArray[np.intp], at: FloatArray) -> FloatArray:
            return distance(which, self.tube(at[:, 0]), at[:, 1])

        def rigid(which: NDArray[np.intp], at: FloatArray) -> FloatArray:
            theta2 = self._between(start, end, motion[which], at[:, 1])[:, 1]
            return distance(which, self.rod(at[:, 0], theta2), at[:, 1])

        sides = np.ones(len(motion))
        for part, (values, first, last, radius, rates) in enumerate(
            (
                (tube, min(self.tube_radius, link), link, self.tube_radius, turn * link),
                (rigid, 0.0, rod, self.rod_radius, turn * (link + rod) + second * rod),
            )
        ):
            lower, upper = np.stack([first * sides, 0.0 * sides]), np.stack([last * sides, sides])
            upper[1, rates == 0.0] = 0.0
            least, _ = least_values(
                values, lower.T, upper.T, np.stack([sides, rates]).T, _TOLERANCE, radius + ceiling
            )
            bounds[:, part] = least - radius
        return bounds.reshape(motions, count, 2)

    def rod_from_tube(self, theta2: FloatArray) -> FloatArray:
        """Return how far the rod keeps from the tube at angles of joint 2.

        Args:
            theta2: The angles, shape (n,), rad.

        Returns:
            Lower bounds of the distance between the surfaces, at most 0.02 m, negative where they
            overlap; shape (n,).
        """
        joint = self.arm.robot.link.diameter
        last, radii = self.arm.shape.length - joint, self.tube_radius + self.rod_radius
        if joint == 0.0 or last <= 0.0 or self.rod_length <= joint:
            return np.full(len(theta2), _SELF_CEILING)

        def distance(which: NDArray[np.intp], at: FloatArray) -> FloatArray:
            apart = self.tube(at[:, 0]) - self.rod(at[:, 1], theta2[which])
            return np.asarray(np.linalg.norm(apart, axis=1))

        lower = np.tile([-self.arm.robot.d12, joint], (len(theta2), 1))
        upper = np.tile([last, self.rod_length], (len(theta2), 1))
        least, _ = least_values(
            distance, lower, upper, np.ones_like(lower), _TOLERANCE, radii + _SELF_CEILING
        )
        return np.asarray(least - radii)

    def tube_from_itself(self) -> float:
        """Return how far the tube keeps from itself: a lower bound, at most 0.02 m, negative inside."""
        column, link = self.arm.robot.d12, self.arm.shape.length
        apart = math.pi * self.arm.robot.link.min_bend_radius
        room = column + link - apart
        if room <= 0.0 or self.tube_radius == 0.0:
            return _SELF_CEILING

        def distance(_: NDArray[np.intp], at: FloatArray) -> FloatArray:
            # The second coordinate counts from the nearest piece that is not a neighbour.
            other = np.minimum(at[:, 0] + apart + at[:, 1], link)
            return np.asarray(np.linalg.norm(self.tube(at[:, 0]) - self.tube(other), axis=1))

        least, _ = least_values(
            distance,
            np.array([[-column, 0.0]]),
            np.array([[room - column, room]]),
            np.array([[2.0, 1.0]]),
            _TOLERANCE,
            2.0 * self.tube_radius + _SELF_CEILING,
        )
        return float(least[0]) - 2.0 * self.tube_radius

    @staticmethod
    def _between(
        start: FloatArray, end: FloatArray, motion: NDArray[np.intp], share: FloatArray
    ) -> FloatArray:
        return np.asarray(start[motion] + share[:, None] * (end - start)[motion])


def turned(points: FloatArray, angle: FloatArray) -> FloatArray:
    """Return points, shape (..., 3), turned about axis 1 by angles that broadcast to (...), rad."""
    c, s = np.cos(angle), np.sin(angle)
    x, y, z = np.moveaxis(points, -1, 0)
    return np.stack(np.broadcast_arrays(c * x - s * y, s * x + c * y, z), axis=-1)
