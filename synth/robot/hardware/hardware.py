"""The robot as it was built: what reshaping the malleable link does not change."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from synth.checks import Checks
from synth.robot.hardware.interval import Interval, check_interval, check_lengths
from synth.rounding import written_apart

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from synth.arrays import FloatArray


_TURN_AND_ROUNDING = 2.0 * math.pi + 1e-9
_FULL_TURN_OF_BASE = Interval(-math.pi, math.pi)
_FULL_TURN_OF_SECOND = Interval(0.0, 2.0 * math.pi)
_FLAT = 1e-9  # of d34: a triangle that is flat but for rounding is one


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

    def __post_init__(self) -> None:
        checks = Checks(self)
        check_lengths(checks, self, "length")
        checks.number("min_bend_radius", above=0.0)
        checks.number("diameter", least=0.0)
        checks.number("max_total_bend", above=0.0, most=math.inf)
        checks.refuse()

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

    def __post_init__(self) -> None:
        checks = Checks(self)
        check_lengths(checks, self, "d35")
        check_lengths(checks, self, "d45")
        checks.number("diameter", least=0.0)
        checks.refuse()

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

    base: Interval = _FULL_TURN_OF_BASE
    second: Interval = _FULL_TURN_OF_SECOND

    def __post_init__(self) -> None:
        checks = Checks(self)
        check_interval(checks, self, "base")
        check_interval(checks, self, "second")
        checks.refuse()

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

    def __post_init__(self) -> None:
        checks = Checks(self)
        checks.name("name")
        checks.number("d12", above=0.0)
        checks.is_a("link", MalleableLink)
        checks.number("d34", above=0.0)
        checks.number("tip_offset")
        rigid = self.rigid_link
        if checks.is_a("rigid_link", RigidLink) and not checks.found_in("d34"):
            d35, d45 = ((one.lower, one.upper) for one in (rigid.d35, rigid.d45))
            if wrong := no_triangle(self.d34, d35, d45):
                checks.report("rigid_link", wrong)
        if checks.is_a("joint_limits", JointLimits):
            for key, limits in (("base", self.joint_limits.base), ("second", self.joint_limits.second)):
                if limits.upper - limits.lower > _TURN_AND_ROUNDING:
                    wide = f"must be at most one turn wide, but is {limits.upper - limits.lower:g} rad"
                    checks.report(f"joint_limits.{key}", wide)
        checks.refuse()

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


def no_triangle(d34: float, d35: tuple[float, float], d45: tuple[float, float]) -> str:
    """Return why no triangle P3 P4 P5 has sides in these ranges, in any unit of length, or nothing.

    Args:
        d34: Distance of P3 and P4.
        d35: Least and largest distance of P3 and P5.
        d45: Least and largest distance of P4 and P5.
    """
    slack, longest = _FLAT * d34, d35[1] + d45[1]
    if longest < d34 - slack:
        most, needed = written_apart(longest, d34)
        return f"no triangle P3 P4 P5: d35 + d45 is at most {most}, less than d34 = {needed}"
    for longer, shorter, gap in (("d35", "d45", d35[0] - d45[1]), ("d45", "d35", d45[0] - d35[1])):
        if gap > d34 + slack:
            least, allowed = written_apart(gap, d34)
            return (
                f"no triangle P3 P4 P5: {longer} exceeds {shorter} by at least {least}, "
                f"more than d34 = {allowed}"
            )
    return ""
