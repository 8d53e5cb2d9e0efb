"""A robot whose link is stiff in one shape: its axes, its circle, its surface, its joints."""

from __future__ import annotations

from dataclasses import field
from functools import cached_property

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
from synth.robot.hardware import Robot
from synth.robot.kinematics import Kinematics
from synth.robot.link import LinkShape


@frozen_value
class ArmInShape:
    """A robot with its link stiffened in one shape: where its axes are, and what they make of it.

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
    def joint_bounds(self) -> FloatArray:
        """Least and largest (theta1, theta2), shape (2, 2), rad, for planners that take bounds as arrays."""
        base, second = self.robot.joint_limits.base, self.robot.joint_limits.second
        return np.array([[base.lower, second.lower], [base.upper, second.upper]])

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
