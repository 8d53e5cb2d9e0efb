"""The synthesis: screen, polish, verify; `solve` is its one verb."""

from synth.synthesis.solution import Design, NotFoundError, Solution, Status, TargetResult, Timing
from synth.synthesis.solve import Progress, solve
from synth.synthesis.verification import Verification, Violation, verify

__all__ = [
    "Design",
    "NotFoundError",
    "Progress",
    "Solution",
    "Status",
    "TargetResult",
    "Timing",
    "Verification",
    "Violation",
    "solve",
    "verify",
]
