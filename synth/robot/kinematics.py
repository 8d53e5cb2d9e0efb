"""Forward and inverse kinematics of the two joints, for one shape or for many at once."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import frozen_value
from synth.robot.hardware import into_turn, turned

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from synth.arrays import FloatArray
    from synth.robot.hardware import Interval


@frozen_value
class Kinematics:
    """The two joints of shapes whose arrays broadcast: leading axes "..." may be absent.

    All points are in the base frame, m. P5 = Rz(theta1) [c + R (sin(theta2) v - cos(theta2) t)].

    Attributes:
        frame: Rotation of the link's end at theta1 = 0, columns u, v, t, shape (..., 3, 3): u along
            axis 2, t along the link, v = t x u.
        centre: Centre c of the circle of P5 about axis 2, shape (..., 3), m.
        radius: Its radius R, shape (...), m.
    """

    frame: FloatArray
    centre: FloatArray
    radius: FloatArray

    def forward(self, theta1: ArrayLike, theta2: ArrayLike) -> FloatArray:
        """Return P5 for joint angles, shape (...), rad; of shape (..., 3), m."""
        second = np.asarray(theta2, dtype=np.float64)
        return turned(np.stack(self.unturned(np.cos(second), np.sin(second)), axis=-1), theta1)

    def unturned(self, cos: FloatArray, sin: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return x, y and z of P5 at theta1 = 0 for cosines and sines of theta2, shapes (...), m."""
        v, t = self.frame[..., 1], self.frame[..., 2]
        x, y, z = (self.centre[..., i] + self.radius * (sin * v[..., i] - cos * t[..., i]) for i in range(3))
        return x, y, z

    def tangent(self, theta2: FloatArray) -> FloatArray:
        """Return the derivative of P5 by theta2 at theta1 = 0, shape (..., 3), m."""
        v, t = self.frame[..., 1], self.frame[..., 2]
        circle = np.cos(theta2)[..., None] * v + np.sin(theta2)[..., None] * t
        return np.asarray(self.radius[..., None] * circle)

    def best_theta1(self, theta2: FloatArray, point: FloatArray, limits: Interval) -> FloatArray:
        """Return the theta1 within its limits that brings P5 closest to a point, theta2 given."""
        start = self.forward(0.0, theta2)
        wanted = np.arctan2(point[..., 1], point[..., 0]) - np.arctan2(start[..., 1], start[..., 0])
        # An angle modulo a turn: into the turn around the interval's middle, then to its nearer end.
        return np.clip(into_turn(wanted, limits.middle), limits.lower, limits.upper)

    def branches(self, point: FloatArray) -> FloatArray:
        """Return both branches of the inverse kinematics in closed form, joint limits aside.

        Height z and squared distance N = |P5|^2 from P1 do not depend on theta1, and are linear in
        w = (cos theta2, sin theta2): M w = (z - cz, N - |c|^2 - R^2). The singular vectors of M give
        w up to a sign; where the axes meet or are parallel both signs are solutions, elsewhere one.

        Args:
            point: Points, shape (..., 3), m. Off the workspace the branches are near its closest point.

        Returns:
            Pairs (theta1, theta2), shape (..., 2, 2), rad, the branches along the last axis but one.
        """
        radius, centre = self.radius[..., None], self.centre
        across = radius[..., None] * np.stack([-self.frame[..., 2], self.frame[..., 1]], axis=-1)
        squared = np.einsum("...i,...i", centre, centre)
        # N is brought to the scale of a length, so that both rows weigh alike.
        scale = 0.5 / np.sqrt(squared + self.radius**2)
        by_squared = 2.0 * scale[..., None] * np.einsum("...i,...ij->...j", centre, across)
        left, singular, right = np.linalg.svd(np.stack([across[..., 2, :], by_squared], axis=-2))
        height = point[..., 2] - centre[..., 2]
        beyond = scale * (np.einsum("...i,...i", point, point) - squared - self.radius**2)
        along = left[..., 0, 0] * height + left[..., 1, 0] * beyond
        first = np.clip(along / np.maximum(singular[..., 0], 1e-300), -1.0, 1.0)
        second = np.sqrt(1.0 - first**2)
        w = np.stack([first, second], axis=-1)[..., None, :] * np.array([[1.0, 1.0], [1.0, -1.0]])
        w = w @ right
        theta2 = np.arctan2(w[..., 1], w[..., 0])
        one = self.each_target()
        start = one.forward(0.0, theta2)
        theta1 = np.arctan2(point[..., None, 1], point[..., None, 0]) - np.arctan2(
            start[..., 1], start[..., 0]
        )
        return np.stack([theta1, theta2], axis=-1)

    def velocities(self, joints: FloatArray, reached: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the derivatives of P5 by theta1 and by theta2, shape (..., 3), m.

        Axis 1 sweeps P5 along (-y, x, 0), joint 2 along the tangent of its circle.

        Args:
            joints: Angles (theta1, theta2), shape (..., 2), rad.
            reached: P5 at these angles, shape (..., 3), m.
        """
        by_theta1 = reached[..., [1, 0, 2]] * np.array([-1.0, 1.0, 0.0])
        return by_theta1, turned(self.tangent(joints[..., 1]), joints[..., 0])

    def each_target(self) -> Kinematics:
        """Return the same with one more axis behind the leading ones, for the targets."""
        return Kinematics(self.frame[..., None, :, :], self.centre[..., None, :], self.radius[..., None])
