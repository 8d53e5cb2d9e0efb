"""Lower bounds of the worst miss over all shapes, by branch and bound: `prove` is the one verb."""

from synth.synthesis.bound.ends import LinkEnd
from synth.synthesis.bound.impossibility import why_impossible
from synth.synthesis.bound.search import Bound, prove

__all__ = ["Bound", "LinkEnd", "prove", "why_impossible"]
