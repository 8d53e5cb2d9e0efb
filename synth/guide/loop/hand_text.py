"""A hand that was learned, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from synth.measurement import SUPPOSED_COUNT, Deed, Hand
from synth.rounding import Unit, rounded_up
from synth.sentences import bulleted, headed

if TYPE_CHECKING:
    from collections.abc import Mapping


def hand_text(hand: Hand, counts: Mapping[Deed, int]) -> str:
    """Return what was learned of a hand as a headline and a few bullets.

    Args:
        hand: The hand.
        counts: From how many checks of each kind it was learned.
    """
    supposed = Hand()
    told = (
        (
            f"places the link's end {_off(hand.placement)} off",
            _off(supposed.placement),
            counts.get(Deed.PLACED, 0),
        ),
        (
            f"is {_percent(hand.share)} of a correction off, and {_off(hand.floor)} at least",
            f"{_percent(supposed.share)}, and {_off(supposed.floor)}",
            counts.get(Deed.CORRECTED, 0),
        ),
        (
            f"the link moves by {_off(hand.drift)} as it stiffens",
            _off(supposed.drift),
            counts.get(Deed.STIFFENED, 0),
        ),
    )
    lines = [f"{what}; of any hand {usual} is supposed; times seen: {count}" for what, usual, count in told]
    lines.append(f"what is supposed counts as seen {SUPPOSED_COUNT} times; all are root mean squares")
    return headed("this hand", map(bulleted, lines))


def _off(error: tuple[float, float]) -> str:
    return f"{rounded_up(error[0])} mm and {rounded_up(error[1], Unit.DEG, 1)} deg"


def _percent(share: float) -> str:
    return f"{100.0 * share:.0f} %"
