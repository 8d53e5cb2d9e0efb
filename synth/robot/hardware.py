"""The robot as it was built: what reshaping the malleable link does not change."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from synth.arrays import FloatArray


@dataclass(frozen=True)
class Interval:
    """A closed interval `[lower, upper]`; a fixed number is an interval of no width."""

    lower: float
    upper: float

    @classmethod
    def fixed(cls, value: float) -> Interval:
        """Return the interval that holds one value."""
        return cls(value, value)

    @property
    def is_fixed(self) -> bool:
        """Whether there is nothing to choose."""
        return self.lower == self.upper

    @property
    def middle(self) -> float:
        """The midpoint of the interval."""
        return 0.5 * (self.lower + self.upper)

    def contains(self, value: float, slack: float = 0.0) -> bool:
        """Whether `value` lies in the interval widened by `slack` at both ends."""
        return self.lower - slack <= value <= self.upper + slack


@dataclass(frozen=True)
class MalleableLink:
    """The link that is softened, bent by hand and stiffened again.

    Attributes:
        length: Length L of its centreline, m. It is an interval because the link also stretches.
        min_bend_radius: Smallest radius r of its centreline, m.
        diameter: Outer diameter of the tube, m.
        max_total_bend: Largest total bend, the integral of |curvature| along the link, rad.
    """

    length: Interval
    min_bend_radius: float
    diameter: float = 0.0
    max_total_bend: float = math.inf

    @property
    def max_curvature(self) -> float:
        """Largest curvature of the centreline, 1/m."""
        return 1.0 / self.min_bend_radius


@dataclass(frozen=True)
class RigidLink:
    """The link from the second joint to the end effector, as distances to the axis points.

    Attributes:
        d35: Distance from P3 to the end effector P5, m; an interval is chosen by the synthesis.
        d45: Distance from P4 to P5, m; likewise.
        diameter: Its outer diameter, m, where it may touch obstacles or the malleable link.
    """

    d35: Interval
    d45: Interval
    diameter: float = 0.0

    @property
    def is_fixed(self) -> bool:
        """Whether the rigid link is given and not to be designed."""
        return self.d35.is_fixed and self.d45.is_fixed


@dataclass(frozen=True)
class JointLimits:
    """Ranges of the two joints, rad.

    Attributes:
        base: Range of theta1; joint 1 reads zero in the x direction of the base frame.
        second: Range of theta2; 0 is folded back onto the malleable link, pi is straight on.
    """

    base: Interval = Interval(-math.pi, math.pi)
    second: Interval = Interval(0.0, 2.0 * math.pi)

    def contain(self, joints: FloatArray, slack: float = 1e-9) -> NDArray[np.bool_]:
        """Whether pairs (theta1, theta2), shape (..., 2), rad, are within the limits; shape (...)."""
        lower = np.array([self.base.lower, self.second.lower]) - slack
        upper = np.array([self.base.upper, self.second.upper]) + slack
        return np.asarray(((joints >= lower) & (joints <= upper)).all(axis=-1))


@dataclass(frozen=True)
class Robot:
    """The hardware of a 2-DOF malleable robot. All lengths in metres, all angles in radians.

    Attributes:
        name: What the robot is called.
        d12: Distance of the two points P1 and P2 on the base joint's axis; the link starts at P2.
        link: The malleable link.
        d34: Distance of the two points P3 and P4 on the second joint's axis.
        tip_offset: Where the link ends on the second axis, counted from P3 towards P4.
        rigid_link: Distances from P3 and P4 to the end effector P5.
        joint_limits: Ranges of both joints.
    """

    name: str
    d12: float
    link: MalleableLink
    d34: float
    tip_offset: float
    rigid_link: RigidLink
    joint_limits: JointLimits = JointLimits()

    def end_effector_circle(self, d35: ArrayLike, d45: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Return where and how wide P5 circles about the second axis.

        Args:
            d35: Distance from P3 to P5, shape (...), m.
            d45: Distance from P4 to P5, shape (...), m.

        Returns:
            The signed distance from the link's end to the circle's centre along axis 2 (positive
            from P3 towards P4), m, and the radius R of the circle, m; R is 0 where P3, P4, P5 are
            in line. With a = (s35 - s45 + s34) / (2 d34): R^2 = s35 - a^2.
        """
        s35, s45 = np.square(d35), np.square(d45)
        from_p3 = (s35 - s45 + self.d34**2) / (2.0 * self.d34)
        return from_p3 - self.tip_offset, np.sqrt(np.maximum(s35 - from_p3**2, 0.0))
