"""The independent check: what a shape does, by forward kinematics; it imports no other part of the synthesis."""

from synth.synthesis.check.clearances import clear_of_everything, seen_by
from synth.synthesis.check.verification import Verification, Violation, verify

__all__ = ["Verification", "Violation", "clear_of_everything", "seen_by", "verify"]
