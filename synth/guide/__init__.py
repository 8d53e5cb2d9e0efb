"""The guide: from a solution to what a person does with the robot's link."""

from synth.guide.guide import LINK_END, MARKERS, Guide, Placement, make_guide
from synth.guide.instructions import base_sentence, instructions
from synth.guide.posture import HoldPosture
from synth.guide.sensitivity import ShapeTolerance
from synth.guide.text import guide_text, help_told, proof_sentence, reasons_told, solution_text, summary_text

__all__ = [
    "LINK_END",
    "MARKERS",
    "Guide",
    "HoldPosture",
    "Placement",
    "ShapeTolerance",
    "base_sentence",
    "guide_text",
    "help_told",
    "instructions",
    "make_guide",
    "proof_sentence",
    "reasons_told",
    "solution_text",
    "summary_text",
]
