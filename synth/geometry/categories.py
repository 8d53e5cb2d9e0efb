"""The kinds of arm that the literature names, and how far a shape is from each."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from synth.rounding import Unit, rounded_up
from synth.sentences import SentenceEnum

if TYPE_CHECKING:
    from synth.geometry.invariants import Invariants

# Conventions, not physics: twice the error of the motion capture that measured the prototype, and
# what that error turns an axis by if it is marked half a metre apart.
LENGTH_TOLERANCE = 1e-3  # m
ANGLE_TOLERANCE = math.radians(0.1)


class Category(SentenceEnum):
    """Kind of arm, by how axis 2 lies to axis 1 (Clark and Rojas 2020, section II)."""

    GENERAL = "general", "The axes neither meet at P1 or P2 nor are parallel: a torus-like quartic surface."
    PUMA = "puma", "Axis 2 passes through P2: the workspace lies on a sphere about P2."
    SCARA = "scara", "The axes are parallel: the workspace lies in a plane across axis 1."
    SPHERICAL = "spherical", "Axis 2 passes through P1: the workspace lies on a sphere about P1."


@dataclass(frozen=True)
class CategoryDistances:
    """How far an arm is from each special category.

    Attributes:
        puma: Distance from P2 to axis 2, m.
        scara: Angle between the axes as lines without orientation, in [0, pi/2], rad.
        spherical: Distance from P1 to axis 2, m.
    """

    puma: float
    scara: float
    spherical: float

    @classmethod
    def from_invariants(cls, invariants: Invariants, d12: float) -> CategoryDistances:
        """Return the distances of an arm whose P2 stands at the height d12, m, above P1.

        A point of axis 1 at the height z is sqrt(a^2 + (z - z0)^2 sin^2(alpha)) away from axis 2.
        """
        sine = math.sin(invariants.alpha)
        return cls(
            puma=math.hypot(invariants.a, (d12 - invariants.z0) * sine),
            scara=min(invariants.alpha, math.pi - invariants.alpha),
            spherical=math.hypot(invariants.a, invariants.z0 * sine),
        )

    def describe(
        self, length_tolerance: float = LENGTH_TOLERANCE, angle_tolerance: float = ANGLE_TOLERANCE
    ) -> str:
        """Return a sentence for the user, with tolerances as in `classify`.

        For example "general; 434.1 mm from PUMA-like, 37.3 deg from SCARA, 376.0 mm from spherical", or
        "SCARA to 0.1 deg; 96.0 mm from PUMA-like, 96.0 mm from spherical".
        """
        category = classify(self, length_tolerance, angle_tolerance)
        from_each = {
            Category.PUMA: ("PUMA-like", self.puma, Unit.MM),
            Category.SCARA: ("SCARA", self.scara, Unit.DEG),
            Category.SPHERICAL: ("spherical", self.spherical, Unit.MM),
        }
        own = category.value
        if category in from_each:
            name, distance, unit = from_each.pop(category)
            own = f"{name} to {rounded_up(distance, unit)} {unit.symbol}"
        others = (
            f"{unit.of(distance):.1f} {unit.symbol} from {name}"
            for name, distance, unit in from_each.values()
        )
        return f"{own}; {', '.join(others)}"


def classify(
    distances: CategoryDistances,
    length_tolerance: float = LENGTH_TOLERANCE,
    angle_tolerance: float = ANGLE_TOLERANCE,
) -> Category:
    """Return the category of an arm.

    An arm may be within tolerance of several (coincident axes are all three at once): it is then the
    first of spherical, PUMA-like and SCARA.

    Args:
        distances: How far the arm is from each category.
        length_tolerance: Largest distance from P1 or P2 to axis 2 that counts as none, m.
        angle_tolerance: Largest angle between the axes that counts as none, rad.
    """
    if distances.spherical <= length_tolerance:
        return Category.SPHERICAL
    if distances.puma <= length_tolerance:
        return Category.PUMA
    if distances.scara <= angle_tolerance:
        return Category.SCARA
    return Category.GENERAL
