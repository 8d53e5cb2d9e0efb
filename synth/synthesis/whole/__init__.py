"""All that is asked, where the search knows a part of it: many targets, surfaces, paths."""

from synth.synthesis.whole.for_all import WholeTask, verified_in_time
from synth.synthesis.whole.looking_through import looked_through, only_proven
from synth.synthesis.whole.part import part_of, without_partial

__all__ = ["WholeTask", "looked_through", "only_proven", "part_of", "verified_in_time", "without_partial"]
