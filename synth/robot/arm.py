"""A robot whose link is stiff in one shape: a 2-DOF arm with its forward and inverse kinematics."""

from __future__ import annotations

from dataclasses import field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen, frozen_value
from synth.checks import Checks
from synth.geometry import (
    Category,
    CategoryDistances,
    Invariants,
    SweptCircle,
    WorkspaceSurface,
    classify,
    squared_distances,
)
from synth.robot.base_pose import BasePose
from synth.robot.closest_joints import closest_joints
from synth.robot.hardware import Robot, into_turn
from synth.robot.kinematics import Kinematics
from synth.robot.link import LinkShape

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

    joints: FloatArray
    miss: FloatArray

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
class Arm:
    """A robot with its link stiffened in one shape. Points are in the task frame, in metres.

    Attributes:
        robot: The hardware.
        shape: The shape of the malleable link.
        d35: Distance from P3 to the end effector P5, m.
        d45: Distance from P4 to P5, m.
        base: Where the robot stands.
    """

    robot: Robot
    shape: LinkShape
    d35: float
    d45: float
    base: BasePose = field(default_factory=BasePose)

    def __post_init__(self) -> None:
        checks = Checks(self)
        checks.is_a("robot", Robot)
        checks.is_a("shape", LinkShape)
        checks.number("d35", above=0.0)
        checks.number("d45", above=0.0)
        checks.is_a("base", BasePose)
        checks.refuse()

    @property
    def base_joint(self) -> FloatArray:
        """P1 and P2 in the base frame, shape (2, 3), m."""
        return np.array([[0.0, 0.0, 0.0], [0.0, 0.0, self.robot.d12]])

    @cached_property
    def end_frame(self) -> tuple[FloatArray, FloatArray]:
        """The link's end at theta1 = 0 in the base frame: rotation (3, 3) and position p (3,), m.

        The columns of the rotation: u (axis 2, from P3 to P4), t x u, and t (along the link).
        """
        rotation, position = self.shape.end_frame()
        return rotation, position + self.base_joint[1]

    @cached_property
    def axis_points(self) -> FloatArray:
        """P1, P2, P3, P4 at theta1 = 0 in the base frame, shape (4, 3), m."""
        rotation, position = self.end_frame
        p3 = position - self.robot.tip_offset * rotation[:, 0]
        p4 = p3 + self.robot.d34 * rotation[:, 0]
        return frozen(np.vstack([self.base_joint, p3, p4]))

    @cached_property
    def circle(self) -> SweptCircle:
        """The circle of P5 about axis 2, at theta1 = 0, in the base frame."""
        offset, radius = self.robot.end_effector_circle(self.d35, self.d45)
        rotation, position = self.end_frame
        return SweptCircle(position + offset * rotation[:, 0], rotation[:, 0], float(radius))

    @cached_property
    def squared_distances(self) -> FloatArray:
        """Squared distances of P1..P5, shape (5, 5), m^2; s15 and s25 are those at theta2 = pi."""
        return frozen(squared_distances(np.vstack([self.axis_points, self.kinematics.forward(0.0, np.pi)])))

    @cached_property
    def surface(self) -> WorkspaceSurface:
        """The workspace surface Gamma = 0, in the base frame."""
        return self.circle.surface(self.robot.d12, self.robot.d34)

    @cached_property
    def invariants(self) -> Invariants:
        """The five numbers (a, alpha, z0, h, R) that determine the surface."""
        return Invariants.from_circle(self.circle)

    @cached_property
    def category_distances(self) -> CategoryDistances:
        """How far the shape is from each special category."""
        return CategoryDistances.from_invariants(self.invariants, self.robot.d12)

    @property
    def category(self) -> Category:
        """The kind of arm that this shape is."""
        return classify(self.category_distances)

    @cached_property
    def kinematics(self) -> Kinematics:
        """The two joints, in the base frame."""
        return Kinematics(self.end_frame[0], self.circle.centre, np.asarray(self.circle.radius))

    def forward_kinematics(self, theta1: ArrayLike, theta2: ArrayLike) -> FloatArray:
        """Return the end effector P5 for joint angles, in the task frame.

        P5 = Rz(theta1) [c + R (-cos(theta2) t - sin(theta2) (u x t))], then the base's pose.

        Args:
            theta1: Angle of the base joint, shape (...), rad.
            theta2: Angle of the second joint, shape (...), rad.

        Returns:
            P5, shape (..., 3), m.
        """
        return self.base.to_task(self.kinematics.forward(theta1, theta2))

    def inverse_kinematics(self, points: ArrayLike, *, within_limits: bool = True) -> JointBranches:
        """Return all joint angles that bring the end effector to points of the workspace.

        In closed form, then polished. Where axis 2 is skew to axis 1 a point of the workspace has one
        branch, where they meet or are parallel two; on axis 1 any theta1 does, and one is given.

        Args:
            points: Points in the task frame, shape (..., 3), m.
            within_limits: Whether branches beyond the joint limits are dropped.

        Returns:
            The branches; a point off the workspace has none with a small miss.
        """
        point = self.base.to_base(points)
        limits = self.robot.joint_limits
        joints = self.kinematics.polished(self.kinematics.branches(point), point[..., None, :])
        for joint, interval in enumerate((limits.base, limits.second)):
            joints[..., joint] = into_turn(joints[..., joint], interval.middle)
        reached = self.kinematics.forward(joints[..., 0], joints[..., 1])
        miss = np.linalg.norm(reached - point[..., None, :], axis=-1)
        if within_limits:
            miss[~limits.contain(joints)] = np.inf
        order = np.argsort(miss, axis=-1, stable=True)
        joints = np.take_along_axis(joints, order[..., None], axis=-2)
        miss = np.take_along_axis(miss, order, axis=-1)
        same = np.abs(joints[..., 0, :] - joints[..., 1, :]).max(axis=-1) < _SAME_BRANCH
        miss[..., 1] = np.where(same, np.inf, miss[..., 1])
        return JointBranches(joints, miss)

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
