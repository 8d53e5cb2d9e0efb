"""The guide: from a solution to what a person does with the robot's link."""

from synth.guide.instructions import base_sentence, instructions
from synth.guide.loop import (
    Check,
    Correction,
    Settings,
    Verdict,
    best_settings,
    check_arm,
    check_text,
    correction_sentence,
    hand_text,
    headline_sentence,
    swept_targets,
)
from synth.guide.markers import LINK_END, MARKERS, Guide, Placement, make_guide
from synth.guide.posture import HoldPosture, hold_posture
from synth.guide.sensitivity import ShapeTolerance
from synth.guide.text import guide_text, points_sentence, solution_text

__all__ = [
    "LINK_END",
    "MARKERS",
    "Check",
    "Correction",
    "Guide",
    "HoldPosture",
    "Placement",
    "Settings",
    "ShapeTolerance",
    "Verdict",
    "base_sentence",
    "best_settings",
    "check_arm",
    "check_text",
    "correction_sentence",
    "guide_text",
    "hand_text",
    "headline_sentence",
    "hold_posture",
    "instructions",
    "make_guide",
    "points_sentence",
    "solution_text",
    "swept_targets",
]
