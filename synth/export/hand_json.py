"""What is known of a hand as plain data, `synth.hand/1`, and what one check tells of it; m and rad."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from synth.export.json_data import plain
from synth.measurement import HAND_SCHEMA
from synth.version import __version__

if TYPE_CHECKING:
    from collections.abc import Mapping

    from synth.measurement import Deed, Hand, HandError


def hand_to_json(hand: Hand, counts: Mapping[Deed, int]) -> dict[str, Any]:
    """Return a hand that was learned as plain data.

    Args:
        hand: The hand.
        counts: From how many checks of each kind it was learned.
    """
    errors = {"placement": hand.placement, "floor": hand.floor, "drift": hand.drift}
    parts = {name: {"shift": shift, "turn": turn} for name, (shift, turn) in errors.items()}
    counted = {deed.value: count for deed, count in counts.items()}
    return plain(
        {"schema": HAND_SCHEMA, "version": __version__, "share": hand.share, **parts, "checks": counted}
    )


def hand_error_to_json(error: HandError) -> dict[str, object]:
    """Return what a check tells of the hand as data for `plain`."""
    return {"deed": error.deed.value, "asked": error.asked, "error": error.error, "noise": error.noise}
