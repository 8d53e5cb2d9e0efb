"""Intervals: what may be chosen of a number; and the check of a field that holds one."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from synth.arrays import FloatArray, Given
from synth.checks import LARGEST, Checks, described, numbers_in, wrong_number
from synth.errors import InputError
from synth.rounding import written_apart


@dataclass(frozen=True)
class Interval:
    """A closed interval `[lower, upper]`; a fixed number is an interval of no width.

    Its ends may be infinite, as those of an angle that is free.
    """

    lower: float
    upper: float

    def __post_init__(self) -> None:
        lower, upper = self.lower, self.upper
        if type(lower) is float and type(upper) is float and lower <= upper:
            return  # neither is NaN
        checks = Checks(self)
        for key in ("lower", "upper"):
            if not (isinstance(getattr(self, key), float) and math.isinf(getattr(self, key))):
                checks.number(key, least=-math.inf, most=math.inf)
        checks.refuse()
        if self.lower > self.upper:
            ends = written_apart(self.lower, self.upper)
            checks.report("", f"must run from low to high, but is [{', '.join(ends)}]")
        checks.refuse()

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

    def nearest(self, value: float) -> float:
        """Return the number of the interval that is nearest to a value."""
        return min(max(value, self.lower), self.upper)

    def contains(self, value: float, slack: float = 0.0) -> bool:
        """Whether `value` lies in the interval widened by `slack` at both ends."""
        return self.lower - slack <= value <= self.upper + slack


GivenInterval = Given[Interval | float | Sequence[float] | FloatArray, Interval]


def check_interval(checks: Checks, value: object, key: str) -> bool:
    """Check a field that is a bounded interval; a number and a pair of numbers are taken for one."""
    given = getattr(value, key)
    if not isinstance(given, Interval):
        ends = numbers_in(given)
        if ends is None or ends.shape not in {(), (2,)}:
            checks.report(key, f"must be an Interval, a number or [low, high], but is {described(given)}")
            return False
        try:
            given = Interval(*(ends.tolist() if ends.ndim else (float(ends),) * 2))
        except InputError as error:
            for mistake in error.mistakes:
                checks.report(f"{key}.{mistake.key}".removesuffix("."), mistake.message)
            return False
        checks.put(key, given)
    for end, number in (("lower", given.lower), ("upper", given.upper)):
        if not abs(number) <= LARGEST:
            checks.report(f"{key}.{end}", wrong_number(number))
            return False
    return True


def check_lengths(checks: Checks, value: object, key: str) -> None:
    """Check a field that is an interval of lengths greater than 0, taken as in `check_interval`."""
    if check_interval(checks, value, key) and not getattr(value, key).lower > 0.0:
        checks.report(key, f"must be greater than 0, but starts at {getattr(value, key).lower:g}")
