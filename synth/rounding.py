"""Numbers in sentences, rounded to the side on which the sentence stays true.

A lower bound, a clearance, or a tolerance to keep is rounded down; an upper bound, a miss, or a change that
will do is rounded up. "At least 274.6 mm" is false where 274.585 mm exists; "at least 274.5 mm" is not.
"""

from __future__ import annotations

import math
from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal
from enum import Enum

_ANY_DOUBLE = Context(prec=400)  # digits: 308 before the point, and what follows it
_MOST_DIGITS = 12  # decimals: finer than any limit is checked


class Unit(Enum):
    """What a number is told in: its symbol, and how many of it are one in SI."""

    MM = "mm", 1e3
    DEG = "deg", math.degrees(1.0)
    PERCENT = "%", 1e2
    M = "m", 1.0

    @property
    def symbol(self) -> str:
        """How it is written behind a number."""
        return self.value[0]

    def of(self, value: float) -> Decimal:
        """Return a value in SI units in this one.

        A power of ten only moves the decimal point, so that 0.3 mm from a file is 0.3 and no less.
        """
        factor = self.value[1]
        if self is Unit.DEG:
            return Decimal(repr(float(value) * factor))
        return Decimal(repr(float(value))) * Decimal(repr(factor))


def rounded_down(value: float, unit: Unit = Unit.MM, digits: int = 1) -> str:
    """Return the largest number with so many decimals that is no more than a value.

    Args:
        value: In SI units; also negative or infinite.
        unit: What to tell it in.
        digits: Decimals.
    """
    return _rounded(value, unit, digits, ROUND_FLOOR)


def rounded_up(value: float, unit: Unit = Unit.MM, digits: int = 1) -> str:
    """Return the smallest number with so many decimals that is no less than a value; see `rounded_down`."""
    return _rounded(value, unit, digits, ROUND_CEILING)


def at_least(value: float, unit: Unit = Unit.MM, digits: int = 1) -> str:
    """Return a lower bound in words, such as "at least 274.5 mm"; see `rounded_down`."""
    return f"at least {rounded_down(value, unit, digits)} {unit.symbol}"


def at_most(value: float, unit: Unit = Unit.MM, digits: int = 1) -> str:
    """Return an upper bound in words, such as "at most 456.9 mm"; see `rounded_up`."""
    return f"at most {rounded_up(value, unit, digits)} {unit.symbol}"


def told_apart(value: float, limit: float, unit: Unit = Unit.MM, digits: int = 1) -> tuple[str, str]:
    """Return a value and the limit that it breaks, with as many decimals as it takes not to look alike.

    Both are rounded towards each other: the value breaks the limit by no less than is shown.

    Args:
        value: In SI units, above the limit or below it.
        limit: In SI units.
        unit: What to tell them in.
        digits: Decimals, if these tell them apart.
    """
    inward, outward = (rounded_down, rounded_up) if value > limit else (rounded_up, rounded_down)
    for more in range(digits, _MOST_DIGITS):
        told = inward(value, unit, more), outward(limit, unit, more)
        if told[0] != told[1] and (float(told[0]) > float(told[1])) == (value > limit):
            break
    return told


def _rounded(value: float, unit: Unit, digits: int, rounding: str) -> str:
    if not math.isfinite(value):
        return f"{value}"
    number = unit.of(value).quantize(Decimal(1).scaleb(-digits), rounding, _ANY_DOUBLE)
    return f"{number:f}" if number else f"{abs(number):f}"  # no "-0.0"


def counted(count: int, what: str) -> str:
    """Return a number of things, such as "1 start" and "2 starts"."""
    return f"{count} {what}" if count == 1 else f"{count} {what}s"


def written_apart(first: float, second: float) -> tuple[str, str]:
    """Write two different numbers with as few digits as show that they differ, six at least."""
    for digits in range(6, 17):
        texts = f"{first:.{digits}g}", f"{second:.{digits}g}"
        if texts[0] != texts[1]:
            return texts
    return repr(first), repr(second)
