"""The hand that bends the link: what is supposed of any, and what checks tell of one."""

from synth.measurement.hand.hand import Hand, random_errors
from synth.measurement.hand.hand_files import (
    CHECK_SCHEMA,
    HAND_SCHEMA,
    aim_of_check,
    errors_of_checks,
    load_hand,
)
from synth.measurement.hand.learning import SUPPOSED_COUNT, Deed, HandError, hand_error, learned_hand

__all__ = [
    "CHECK_SCHEMA",
    "HAND_SCHEMA",
    "SUPPOSED_COUNT",
    "Deed",
    "Hand",
    "HandError",
    "aim_of_check",
    "errors_of_checks",
    "hand_error",
    "learned_hand",
    "load_hand",
    "random_errors",
]
