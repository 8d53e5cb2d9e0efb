"""The robot as it was built: what reshaping the malleable link does not change."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import frozen_value, given
from synth.checks import Checks
from synth.robot.hardware.interval import GivenInterval, Interval, check_interval, check_lengths
from synth.robot.hardware.joint_rates import JointRates
from synth.robot.hardware.rigid_links import RigidLink, RigidLinkChoices, no_triangle

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from synth.arrays import FloatArray


_TURN_AND_ROUNDING = 2.0 * math.pi + 1e-9
_FULL_TURN_OF_BASE = Interval(-math.pi, math.pi)
_FULL_TURN_OF_SECOND = Interval(0.0, 2.0 * math.pi)


@frozen_value
class MalleableLink:
    """The link that is softened, bent by hand and stiffened again.

    Attributes:
        length: Length L of its centreline, m. It is an interval because the link also stretches.
        min_bend_radius: Smallest radius r of its centreline, m.
        diameter: Outer diameter of the tube, m.
        max_total_bend: Largest total bend, the integral of |curvature| along the link, rad.
    """

    length: GivenInterval
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


@frozen_value
class JointLimits:
    """Ranges of the two joints, rad.

    Attributes:
        base: Range of theta1; joint 1 reads zero in the x direction of the base frame.
        second: Range of theta2; 0 is folded back onto the malleable link, pi is straight on.
    """

    base: GivenInterval = given(default=_FULL_TURN_OF_BASE)
    second: GivenInterval = given(default=_FULL_TURN_OF_SECOND)

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


@frozen_value
class Robot:
    """The hardware of a 2-DOF malleable robot. All lengths in metres, all angles in radians.

    Attributes:
        name: What the robot is called.
        d12: Distance of the two points P1 and P2 on the base joint's axis; the link starts at P2.
        link: The malleable link.
        d34: Distance of the two points P3 and P4 on the second joint's axis.
        tip_offset: Where the link ends on the second axis, counted from P3 towards P4.
        rigid_link: Distances from P3 and P4 to the end effector P5; where the synthesis chooses from a
            catalogue, the one chosen, and the first before that.
        joint_limits: Ranges of both joints.
        rigid_links: The catalogue from which the rigid link is chosen; None where `rigid_link` says it.
        joint_rates: How fast the joints may turn and speed up: the limits of trajectories.
    """

    name: str
    d12: float
    link: MalleableLink
    d34: float
    tip_offset: float
    rigid_link: RigidLink
    joint_limits: JointLimits = JointLimits()
    rigid_links: RigidLinkChoices | None = None
    joint_rates: JointRates = JointRates()

    def __post_init__(self) -> None:
        checks = Checks(self)
        checks.name("name")
        checks.number("d12", above=0.0)
        checks.is_a("link", MalleableLink)
        checks.number("d34", above=0.0)
        checks.number("tip_offset")
        checks.is_a("joint_rates", JointRates)
        self._check_rigid_links(checks)
        if checks.is_a("joint_limits", JointLimits):
            for key, limits in (("base", self.joint_limits.base), ("second", self.joint_limits.second)):
                if limits.upper - limits.lower > _TURN_AND_ROUNDING:
                    wide = f"must be at most one turn wide, but is {limits.upper - limits.lower:g} rad"
                    checks.report(f"joint_limits.{key}", wide)
        checks.refuse()

    def _check_rigid_links(self, checks: Checks) -> None:
        if self.rigid_links is not None and not checks.is_a("rigid_links", RigidLinkChoices):
            return
        if not checks.is_a("rigid_link", RigidLink):
            return
        link, given = self.rigid_link, {"rigid_link": self.rigid_link}
        if self.rigid_links is not None:
            given = {f"rigid_links.links[{i}]": each for i, each in enumerate(self.rigid_links.links)}
            if not (link.is_fixed and self.name_of_rigid_link(link.d35.lower, link.d45.lower)):
                checks.put("rigid_link", self.rigid_links.links[0])
        for key, each in () if checks.found_in("d34") else given.items():
            d35, d45 = ((one.lower, one.upper) for one in (each.d35, each.d45))
            if wrong := no_triangle(self.d34, d35, d45):
                checks.report(key, wrong)

    @property
    def possible_rigid_links(self) -> tuple[RigidLink, ...]:
        """The rigid links of the catalogue, or the one that there is."""
        return (self.rigid_link,) if self.rigid_links is None else tuple(self.rigid_links.links)

    def name_of_rigid_link(self, d35: float, d45: float) -> str:
        """Return what the catalogue calls its rigid link of these lengths, m; empty if there is none."""
        return "" if self.rigid_links is None else self.rigid_links.name_of(d35, d45) or ""

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
