"""The loop with the hand: check what was bent, aim anew, settle on joint angles."""

from synth.guide.loop.check_text import check_text, correction_sentence, headline_sentence
from synth.guide.loop.checking import Check, Correction, Verdict, check_arm
from synth.guide.loop.hand_text import hand_text
from synth.guide.loop.settings import Settings, best_settings
from synth.guide.loop.swept_targets import swept_targets

__all__ = [
    "Check",
    "Correction",
    "Settings",
    "Verdict",
    "best_settings",
    "check_arm",
    "check_text",
    "correction_sentence",
    "hand_text",
    "headline_sentence",
    "swept_targets",
]
