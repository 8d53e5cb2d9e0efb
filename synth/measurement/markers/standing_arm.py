"""The arm that really stands there: both axes anywhere, the link's end as it was bent, one or many of them.

An `Arm` has axis 1 on the z axis of its base and a shape of its link. What is measured is less and more:
where the axes are, in the frame of the measurement, with joint 1 at the angle that its encoder reads.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import frozen_value
from synth.robot import turned

if TYPE_CHECKING:
    from synth.arrays import FloatArray
    from synth.robot import Arm, JointLimits

FREEDOMS = 11  # of `StandingArm.displaced`
AXIS_1 = slice(0, 5)  # of the freedoms, those of axis 1
LINK_END = slice(5, 11)  # and those of the link's end


def cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return the cross products of vectors, shape (..., 3); faster than numpy's for few of them."""
    ax, ay, az, bx, by, bz = (c[..., k] for c in (a, b) for k in range(3))
    return np.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], axis=-1)


def rotation_matrix(vector: FloatArray) -> FloatArray:
    """Return the rotation by rotation vectors, shape (..., 3), rad; of shape (..., 3, 3)."""
    x, y, z = np.moveaxis(vector, -1, 0)
    angle = np.sqrt(x * x + y * y + z * z)
    sine = np.sinc(angle / np.pi)  # sin(angle) / angle
    versine = 0.5 * np.sinc(0.5 * angle / np.pi) ** 2  # (1 - cos(angle)) / angle^2
    cross = np.zeros((*angle.shape, 3, 3))
    cross[..., 0, 1], cross[..., 0, 2], cross[..., 1, 2] = -z, y, -x
    cross[..., 1, 0], cross[..., 2, 0], cross[..., 2, 1] = z, -y, x
    return np.asarray(np.eye(3) + sine[..., None, None] * cross + versine[..., None, None] * (cross @ cross))


def rotation_between(one: FloatArray, other: FloatArray) -> FloatArray:
    """Return the least rotation vector that turns a unit vector into another, shape (3,), rad."""
    across = np.cross(one, other)
    sine = float(np.linalg.norm(across))
    angle = float(np.arctan2(sine, one @ other))
    return np.asarray(across * (angle / sine if sine > 1e-12 else 0.0))


@frozen_value
class StandingArm:
    """Arms as they stand, in the frame of the measurement, m; leading axes "..." may be absent.

    Attributes:
        point: P1 on axis 1, shape (..., 3).
        direction: Direction of axis 1, shape (..., 3), of length 1.
        end: The link's end, on axis 2, with joint 1 at `joint1`, shape (..., 3).
        frame: Its rotation, shape (..., 3, 3), columns u along axis 2, v = t x u, t along the link.
        joint1: The angle at which joint 1 stood, rad.
        offset: From the link's end along u to the centre of the circle of P5, one number or shape (...), m.
        radius: Radius of that circle, likewise, m.
        limits: Of the joints.
    """

    point: FloatArray
    direction: FloatArray
    end: FloatArray
    frame: FloatArray
    joint1: float
    offset: float | FloatArray
    radius: float | FloatArray
    limits: JointLimits

    @classmethod
    def of(cls, arm: Arm, joint1: float) -> StandingArm:
        """Return an arm as planned, in its base frame, with joint 1 at an angle, rad."""
        offset, radius = arm.robot.end_effector_circle(arm.d35, arm.d45)
        frame, end = arm.end_frame
        return cls(
            np.zeros(3),
            np.array([0.0, 0.0, 1.0]),
            turned(end, joint1),
            turned(frame.T, joint1).T,
            joint1,
            float(offset),
            float(radius),
            arm.robot.joint_limits,
        )

    @property
    def axis(self) -> FloatArray:
        """Direction u of axis 2, shape (..., 3)."""
        return self.frame[..., 0]

    @property
    def centre(self) -> FloatArray:
        """Centre of the circle of P5, shape (..., 3), m."""
        return self.end + np.asarray(self.offset)[..., None] * self.axis

    def displaced(self, by: FloatArray) -> StandingArm:
        """Return this arm displaced in its eleven freedoms.

        Args:
            by: Shape (..., 11): shift of P1 (3, m), tilt of axis 1 about x and y (2, rad), shift of the
                link's end (3, m), and its rotation vector (3, rad); in the frame of the measurement.
        """
        tilt = np.concatenate([by[..., 3:5], np.zeros_like(by[..., :1])], axis=-1)
        direction = np.einsum("...ij,...j->...i", rotation_matrix(tilt), self.direction)
        return replace(
            self,
            point=self.point + by[..., 0:3],
            direction=direction,
            end=self.end + by[..., 5:8],
            frame=rotation_matrix(by[..., 8:11]) @ self.frame,
        )

    def moved(self, by: FloatArray) -> StandingArm:
        """Return this arm with the link's end moved alone: shift (3, m) and rotation vector (3, rad)."""
        return replace(self, end=self.end + by[..., :3], frame=rotation_matrix(by[..., 3:]) @ self.frame)

    def about_axis_1(self, points: FloatArray, joint1: FloatArray) -> FloatArray:
        """Return points, shape (..., n, 3), that joint 1 carries from where it stood to angles, (..., n)."""
        base = self.point[..., None, :]
        return np.asarray(base + self.turned_about_axis_1(points - base, joint1 - self.joint1))

    def turned_about_axis_1(self, vectors: FloatArray, angle: FloatArray) -> FloatArray:
        """Return vectors, shape (..., n, 3), turned about axis 1 by angles, shape (..., n), rad."""
        axis = self.direction[..., None, :]
        cos, sin = np.cos(angle)[..., None], np.sin(angle)[..., None]
        along = np.einsum("...i,...i", vectors, axis)[..., None]
        return np.asarray(vectors * cos + cross(axis, vectors) * sin + axis * (along * (1.0 - cos)))

    def forward(self, joints: FloatArray) -> FloatArray:
        """Return P5 at joint angles, shape (..., n, 2), rad; of shape (..., n, 3), m."""
        return self.about_axis_1(self.centre[..., None, :] + self._on_circle(joints)[0], joints[..., 0])

    def velocities(self, joints: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return P5, shape (..., n, 3), m, and its derivatives by both joints, (..., n, 3, 2), m/rad."""
        radial, tangent = self._on_circle(joints)
        angle = joints[..., 0] - self.joint1
        from_base = self.turned_about_axis_1((self.centre - self.point)[..., None, :] + radial, angle)
        by_first = cross(self.direction[..., None, :], from_base)
        by_second = self.turned_about_axis_1(tangent, angle)
        return self.point[..., None, :] + from_base, np.stack([by_first, by_second], axis=-1)

    def _on_circle(self, joints: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return P5 from the circle's centre and its derivative by joint 2, (..., n, 3), joint 1 at rest."""
        radius = np.asarray(self.radius)[..., None, None]
        cos, sin = radius * np.cos(joints[..., 1, None]), radius * np.sin(joints[..., 1, None])
        v, t = self.frame[..., None, :, 1], self.frame[..., None, :, 2]
        return sin * v - cos * t, cos * v + sin * t


def onto_vertical(direction: FloatArray) -> FloatArray:
    """Return the least rotation that brings a direction onto z, shape (3, 3)."""
    across = np.cross(direction, [0.0, 0.0, 1.0])
    sine = float(np.linalg.norm(across))
    if sine < 1e-15:
        return np.eye(3) if direction[2] > 0.0 else np.diag([1.0, -1.0, -1.0])
    return rotation_matrix(across / sine * np.arctan2(sine, direction[2]))
