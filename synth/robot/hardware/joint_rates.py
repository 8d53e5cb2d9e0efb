"""How fast the joints may turn, and how fast that may change."""

from __future__ import annotations

import math
from numbers import Real

from synth.arrays import GivenArray, frozen_value, given
from synth.checks import Checks

SPEED = 25.0 * 2.0 * math.pi / 60.0  # rad/s: 25 rpm, the motors of the published prototype
ACCELERATION = 10.0  # rad/s^2: nominal, nobody published one


@frozen_value
class JointRates:
    """How fast the joints may turn; what is not given is the prototype's speed and a nominal acceleration.

    Attributes:
        speeds: Largest speeds of joints 1 and 2, shape (2,), rad/s; a number is taken for both.
        accelerations: Largest rates of these, shape (2,), rad/s^2; likewise.
    """

    speeds: GivenArray = given(default=(SPEED, SPEED))
    accelerations: GivenArray = given(default=(ACCELERATION, ACCELERATION))

    def __post_init__(self) -> None:
        checks = Checks(self)
        for key in ("speeds", "accelerations"):
            given_as = getattr(self, key)
            if isinstance(given_as, Real):
                checks.number(key, above=0.0)
                checks.put(key, (given_as, given_as))
            if not checks.found_in(key):
                checks.array(key, (2,), above=0.0)
        checks.refuse()
