"""The guide: from a solution to what a person does with the robot's link."""

from synth.guide.guide import LINK_END, MARKERS, Guide, Placement, make_guide
from synth.guide.sensitivity import ShapeTolerance
from synth.guide.text import guide_text, solution_text, summary_text

__all__ = [
    "LINK_END",
    "MARKERS",
    "Guide",
    "Placement",
    "ShapeTolerance",
    "guide_text",
    "make_guide",
    "solution_text",
    "summary_text",
]
