"""A robot whose link is stiff in one shape: a 2-DOF arm with its forward and inverse kinematics."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, GivenArray, frozen, frozen_value
from synth.robot.arm_in_shape import ArmInShape
from synth.robot.closed_form import ClosedForm
from synth.robot.closest_joints import closest_joints

_SAME_BRANCH = 1e-5  # rad; branches nearer than this are one, met twice

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


@frozen_value
class JointBranches:
    """The answers of the inverse kinematics: up to two branches for each point, the better first.

    Attributes:
        joints: Angles (theta1, theta2) of each branch, shape (..., 2, 2), rad.
        miss: Distance of the end effector from the point in each branch, shape (..., 2), m;
            infinite where there is no such branch or the joint limits forbid it.
    """

    joints: GivenArray
    miss: GivenArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "joints", frozen(self.joints))
        object.__setattr__(self, "miss", frozen(self.miss))

    def reaching(self, tolerance: float = 1e-6) -> FloatArray:
        """Return the joint angles of one point's branches that miss by at most `tolerance`.

        Args:
            tolerance: Largest miss, m.

        Returns:
            The pairs (theta1, theta2), shape (k, 2) with k from 0 to 2, rad.
        """
        return self.joints[self.miss <= tolerance]


@frozen_value
class Arm(ArmInShape):
    """A robot with its link stiffened in one shape, with its forward and inverse kinematics.

    Points are in the task frame, in metres; see `ArmInShape` for what it holds.
    """

    @cached_property
    def _closed_form(self) -> ClosedForm:
        return ClosedForm(self.kinematics, self.robot.joint_limits)

    def forward_kinematics(self, theta1: ArrayLike, theta2: ArrayLike) -> FloatArray:
        """Return the end effector P5 for joint angles, in the task frame.

        P5 = Rz(theta1) [c + R (-cos(theta2) t - sin(theta2) (u x t))], then the base's pose.

        Args:
            theta1: Angle of the base joint, shape (...), rad.
            theta2: Angle of the second joint, shape (...), rad.

        Returns:
            P5, shape (..., 3), m.
        """
        return self.base.to_task(self._closed_form.forward(theta1, theta2))

    def jacobian(self, joints: ArrayLike) -> FloatArray:
        """Return the derivatives of P5 by the joint angles, in the task frame.

        Args:
            joints: Angles (theta1, theta2), shape (..., 2), rad.

        Returns:
            J, shape (..., 3, 2), m/rad: each column is the velocity of P5 while one joint turns at 1 rad/s.
        """
        angles = np.asarray(joints, dtype=np.float64)
        reached = self.kinematics.forward(angles[..., 0], angles[..., 1])
        by_joint = np.stack(self.kinematics.velocities(angles, reached), axis=-1)
        return np.asarray(self.base.rotation @ by_joint)

    def manipulability(self, joints: ArrayLike) -> FloatArray:
        """Return sqrt(det(J^T J)), shape (...), m^2/rad^2: the area that unit joint velocities span.

        It is 0 where P5 can move in one direction only: on axis 1, and at the rims of the workspace.

        Args:
            joints: Angles (theta1, theta2), shape (..., 2), rad.
        """
        columns = self.jacobian(joints)
        return np.asarray(np.linalg.norm(np.cross(columns[..., 0], columns[..., 1]), axis=-1))

    def inverse_kinematics(
        self, points: ArrayLike, *, within_limits: bool = True, within: float = math.inf
    ) -> JointBranches:
        """Return all joint angles that bring the end effector to points of the workspace.

        In closed form, polished where that is not exact. Where axis 2 is skew to axis 1 a point of the
        workspace has one branch, where they meet or are parallel two; on axis 1 any theta1 does, and one is
        given.

        Args:
            points: Points in the task frame, shape (..., 3), m.
            within_limits: Whether branches beyond the joint limits are dropped.
            within: Largest miss of a branch, m; others are dropped. With a small one it is faster: only
                what is near the workspace is polished.

        Returns:
            The branches; a point off the workspace has none with a small miss.
        """
        point = self.base.to_base(points)
        flat, shape = point.reshape(-1, 3), point.shape[:-1]
        joints, miss = self._closed_form.branches(flat, within, within_limits=within_limits)
        return JointBranches(joints.reshape(*shape, 2, 2), miss.reshape(*shape, 2))

    def closest_joints(self, points: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Return the joint angles within the limits that come closest to points, and their misses.

        Args:
            points: Points in the task frame, shape (..., 3), m; on the workspace or off it.

        Returns:
            Angles (theta1, theta2), shape (..., 2), rad, and misses, shape (...), m.
        """
        point = self.base.to_base(points)
        joints, misses = closest_joints(self.kinematics, point.reshape(-1, 3), self.robot.joint_limits)
        return joints.reshape(*point.shape[:-1], 2), misses.reshape(point.shape[:-1])
