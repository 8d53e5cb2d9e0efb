"""Start points: shapes at random, led to the targets, the most promising first."""

from synth.synthesis.starts.covering import best_covering
from synth.synthesis.starts.descent import EXACT
from synth.synthesis.starts.exact_arms import arms_through_all, exact_arms
from synth.synthesis.starts.random_shapes import RandomShapes
from synth.synthesis.starts.refined import Refined, relative_weights
from synth.synthesis.starts.refinement import level, refine
from synth.synthesis.starts.screening import estimated_misses
from synth.synthesis.starts.start_points import Start, start_points
from synth.synthesis.starts.thinning import thinned
from synth.synthesis.starts.trimming import covered_part, most_covered
from synth.synthesis.starts.turned_arms import (
    SAMPLE,
    as_it_is_and_turned,
    random_part,
    refined_for_all,
    relative_misses,
)

__all__ = [
    "EXACT",
    "SAMPLE",
    "RandomShapes",
    "Refined",
    "Start",
    "arms_through_all",
    "as_it_is_and_turned",
    "best_covering",
    "covered_part",
    "estimated_misses",
    "exact_arms",
    "level",
    "most_covered",
    "random_part",
    "refine",
    "refined_for_all",
    "relative_misses",
    "relative_weights",
    "start_points",
    "thinned",
]
