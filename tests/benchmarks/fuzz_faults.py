"""What may be wrong with an answer, and when a number in a sentence is true."""

from __future__ import annotations

from typing import NamedTuple

_SAME = 1e-9  # of a number: what two implementations differ by


class Fault(NamedTuple):
    """What is wrong: a kind, by which faults are counted, and a sentence."""

    kind: str
    sentence: str


def wrongly_told(what: str, said: str, true: float, side: str, rounding: float = 1e-6) -> list[Fault]:
    """Return a fault if a number in a sentence is not the true one, rounded to the side asked for.

    Args:
        what: What it is the number of.
        said: The number as it is printed; its last digit says how fine it is.
        true: What it should be, in the same unit.
        side: "up" for what must not be less than is true, "down" for what must not be more, "near".
        rounding: By how much the true number may be another by rounding, in the unit.
    """
    digit = 10.0 ** -len(said.partition(".")[2])
    slack = rounding + _SAME * abs(true)
    low, high = {"up": (0.0, digit), "down": (-digit, 0.0), "near": (-0.5 * digit, 0.5 * digit)}[side]
    if low - slack <= float(said) - true <= high + slack:
        return []
    return [Fault("untrue", f"{what}: said {said}, it is {true:.9g}, to be rounded {side}")]
