"""The synthesis: screen, polish, verify; `solve` is its one verb."""

from synth.synthesis.blocking import explain
from synth.synthesis.bound import Bound
from synth.synthesis.check import TargetResult, Verification, Violation, target_results, verify, worst_targets
from synth.synthesis.message import ending, showing
from synth.synthesis.solution import NotFoundError, Release, Solution, Status
from synth.synthesis.solve import solve
from synth.synthesis.wanted import (
    HAND_PLACES,
    HAND_TURNS,
    MOST_MOTIONS,
    Design,
    Displacements,
    Forgiveness,
    Motion,
    hand_forgiveness,
    misses_displaced,
    motions,
    rotations,
)
from synth.watch import Progress, Timing

__all__ = [
    "HAND_PLACES",
    "HAND_TURNS",
    "MOST_MOTIONS",
    "Bound",
    "Design",
    "Displacements",
    "Forgiveness",
    "Motion",
    "NotFoundError",
    "Progress",
    "Release",
    "Solution",
    "Status",
    "TargetResult",
    "Timing",
    "Verification",
    "Violation",
    "ending",
    "explain",
    "hand_forgiveness",
    "misses_displaced",
    "motions",
    "rotations",
    "showing",
    "solve",
    "target_results",
    "verify",
    "worst_targets",
]
