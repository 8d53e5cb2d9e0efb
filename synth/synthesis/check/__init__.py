"""The independent check of a shape, by forward kinematics; it imports no other part of the synthesis."""

from synth.synthesis.check.between import between_samples, proven_between, verify
from synth.synthesis.check.chain import cheapest_chain
from synth.synthesis.check.clearances import clear_of_everything, seen_by
from synth.synthesis.check.covering import Between, Covering, counted
from synth.synthesis.check.followed import Followed
from synth.synthesis.check.following import followed
from synth.synthesis.check.surroundings import Surroundings, way_is_clear
from synth.synthesis.check.target_results import TargetResult, joints_reaching, target_results, worst_targets
from synth.synthesis.check.verification import Verification, verify_targets, what_counts
from synth.synthesis.check.violations import Violation

__all__ = [
    "Between",
    "Covering",
    "Followed",
    "Surroundings",
    "TargetResult",
    "Verification",
    "Violation",
    "between_samples",
    "cheapest_chain",
    "clear_of_everything",
    "counted",
    "followed",
    "joints_reaching",
    "proven_between",
    "seen_by",
    "target_results",
    "verify",
    "verify_targets",
    "way_is_clear",
    "what_counts",
    "worst_targets",
]
