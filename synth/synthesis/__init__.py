"""The synthesis: screen, polish, verify; `solve` is its one verb."""

from synth.synthesis.blocking import explain
from synth.synthesis.bound import Bound
from synth.synthesis.check import TargetResult, Verification, Violation, target_results, verify, worst_targets
from synth.synthesis.search import ALTERNATIVES
from synth.synthesis.shapes import TargetsSeen
from synth.synthesis.solution import (
    NotFoundError,
    Release,
    Solution,
    Status,
    clearance_told,
    ending,
    help_told,
    proof_sentence,
    reasons_told,
    shape_line,
    showing,
)
from synth.synthesis.solve import solve
from synth.synthesis.wanted import (
    MOST_MOTIONS,
    Design,
    Displacements,
    Figures,
    Forgiveness,
    Margins,
    Motion,
    displaced,
    motions,
    rotations,
    way_is_clear,
    ways_and_forgiveness,
)
from synth.watch import Progress, Timing

__all__ = [
    "ALTERNATIVES",
    "HAND_PLACES",
    "HAND_TURNS",
    "MOST_MOTIONS",
    "Bound",
    "Design",
    "Displacements",
    "Figures",
    "Forgiveness",
    "Margins",
    "Motion",
    "NotFoundError",
    "Progress",
    "Release",
    "Solution",
    "Status",
    "TargetResult",
    "TargetsSeen",
    "Timing",
    "Verification",
    "Violation",
    "clearance_told",
    "displaced",
    "ending",
    "explain",
    "help_told",
    "motions",
    "proof_sentence",
    "reasons_told",
    "rotations",
    "shape_line",
    "showing",
    "solve",
    "target_results",
    "verify",
    "way_is_clear",
    "ways_and_forgiveness",
    "worst_targets",
]
