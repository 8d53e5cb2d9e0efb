"""A way: how the arm gets from one target to the next."""

from __future__ import annotations

import numpy as np

from synth.arrays import FloatArray, frozen, frozen_value


@frozen_value
class Motion:
    """How the arm gets from one target to the next.

    Attributes:
        start: Name of the target that it leaves.
        end: Name of the target that it gets to.
        joints: Angles (theta1, theta2) that it passes, shape (k, 2), rad, straight in between: two for
            a straight way, none if no way was found.
    """

    start: str
    end: str
    joints: FloatArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "joints", frozen(self.joints))

    @property
    def found(self) -> bool:
        """Whether there is a way."""
        return len(self.joints) > 0

    @property
    def travel(self) -> float:
        """Travel of the joint that moves more, rad; 0 if no way was found."""
        return travel_of(self.joints)

    def describe(self) -> str:
        """Return which way, in degrees."""
        if not self.found:
            return f"{self.start} to {self.end}: no way was found that keeps clear"
        change = np.degrees(self.joints[-1] - self.joints[0])
        sentence = (
            f"{self.start} to {self.end}: joint 1 by {change[0]:+z.1f} deg, joint 2 by {change[1]:+z.1f} deg"
        )
        if abs(change[0]) > 180.0:
            sentence += " (the long way round: the short one is closed by the limits of joint 1)"
        if len(self.joints) > 2:
            via = ", ".join(f"({a:z.1f}, {b:z.1f})" for a, b in np.degrees(self.joints[1:-1]))
            sentence += f", by way of {via} deg"
        return sentence


def travel_of(way: FloatArray) -> float:
    """Return the travel of the joint that moves more, piece by piece, rad."""
    return float(np.abs(np.diff(way, axis=0)).max(axis=1, initial=0.0).sum())
