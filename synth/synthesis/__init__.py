"""The synthesis: screen, polish, verify; `solve` is its one verb."""

from synth.synthesis.bound import Bound
from synth.synthesis.motion import MOST_MOTIONS, Motion, motions
from synth.synthesis.release import explain
from synth.synthesis.solution import Design, NotFoundError, Release, Solution, Status, TargetResult
from synth.synthesis.solve import solve
from synth.synthesis.verification import Verification, Violation, verify
from synth.synthesis.watch import Progress, Timing

__all__ = [
    "MOST_MOTIONS",
    "Bound",
    "Design",
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
    "explain",
    "motions",
    "solve",
    "verify",
]
