"""The synthesis: screen, polish, verify; `solve` is its one verb."""

from synth.synthesis.bound import Bound
from synth.synthesis.design import Design
from synth.synthesis.forgiveness import Forgiveness, hand_forgiveness
from synth.synthesis.motion import MOST_MOTIONS, Motion, motions
from synth.synthesis.release import explain
from synth.synthesis.solution import NotFoundError, Release, Solution, Status, TargetResult
from synth.synthesis.solve import solve
from synth.synthesis.verdict import showing
from synth.synthesis.verification import Verification, Violation, verify
from synth.synthesis.watch import Progress, Timing

__all__ = [
    "MOST_MOTIONS",
    "Bound",
    "Design",
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
    "explain",
    "hand_forgiveness",
    "motions",
    "showing",
    "solve",
    "verify",
]
