"""The room that an arm takes up: a tube about the malleable link and the base's column, and a rod to P5."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen_value

if TYPE_CHECKING:
    from synth.robot.arm import Arm

# By how much a stated clearance may be less than the true one, m, for an arm of up to two metres; for a
# longer one in proportion, or a bound for an arm as long as a street takes minutes.
_TOLERANCE = 2e-5
ROUNDING = 2e-6  # m


@frozen_value
class ArmBody:
    """The room that an arm takes up, in its base frame.

    Attributes:
        arm: The arm.
    """

    arm: Arm

    @property
    def tolerance(self) -> float:
        """By how much a clearance stated here may be less than the true one, m."""
        return _TOLERANCE * max(1.0, 0.5 * (self.arm.shape.length + self.rod_length))

    @property
    def clear(self) -> float:
        """A bound of no less than this, m, is of what is clear: rounding aside, nothing overlaps."""
        return -self.tolerance - ROUNDING

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
        share = along / self.rod_length if self.rod_length > 0.0 else np.zeros_like(along)
        return np.asarray(end + share[..., None] * (tip - end))  # a rod of no length is its own end

    def from_rod(self, points: FloatArray, theta2: FloatArray, *, beyond: float) -> FloatArray:
        """Return how far points are from the rod's centreline at joint 1 = 0, shape (n,), m.

        Args:
            points: The points, shape (n, 3), m.
            theta2: Angles of joint 2, shape (n,), rad.
            beyond: Where the part of the rod begins that counts, from the link's end, m.
        """
        end = self.arm.end_frame[1]
        direction = (self.arm.kinematics.forward(0.0, theta2) - end) / self.rod_length
        off = points - end
        along = np.clip(np.einsum("ni,ni->n", off, direction), beyond, self.rod_length)
        return np.asarray(np.linalg.norm(off - along[:, None] * direction, axis=1))

    def lowest(self) -> float:
        """Return the height of the lowest point of the tube beyond its mount, m; exact."""
        shape = self.arm.shape
        return (
            self.arm.robot.d12 + shape.lowest(beyond=min(self.tube_radius, shape.length)) - self.tube_radius
        )
