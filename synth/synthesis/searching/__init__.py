"""The search among few targets: start points, polished by the nonlinear program, checked and kept."""

from synth.synthesis.searching.polishing import Polishing
from synth.synthesis.searching.search import ALTERNATIVES, Search

__all__ = ["ALTERNATIVES", "Polishing", "Search"]
