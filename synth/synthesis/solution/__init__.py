"""The solution, and what is told of it."""

from synth.synthesis.solution.message import Status, ending, message, note_on_ways, why_no_better
from synth.synthesis.solution.outcome import Outcome, Release
from synth.synthesis.solution.shape_text import clearance_told, shape_line
from synth.synthesis.solution.solution import NotFoundError, Solution, showing
from synth.synthesis.solution.summary import help_told, proof_sentence, reasons_told
from synth.synthesis.solution.surface_text import sampled_lines

__all__ = [
    "NotFoundError",
    "Outcome",
    "Release",
    "Solution",
    "Status",
    "clearance_told",
    "ending",
    "help_told",
    "message",
    "note_on_ways",
    "proof_sentence",
    "reasons_told",
    "sampled_lines",
    "shape_line",
    "showing",
    "why_no_better",
]
