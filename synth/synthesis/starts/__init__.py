"""Start points: shapes at random, led to the targets, the most promising first."""

from synth.synthesis.starts.columns import ARCS
from synth.synthesis.starts.exact_arms import exact_arms, nearest_to_exact_arms
from synth.synthesis.starts.overlaps import overlaps
from synth.synthesis.starts.postures import Postures, TargetsSeen
from synth.synthesis.starts.refined import Refined, relative_weights
from synth.synthesis.starts.refinement import level, refine
from synth.synthesis.starts.screening import estimated_misses
from synth.synthesis.starts.shape_limits import into_limits
from synth.synthesis.starts.shapes import ARM_LENGTH, Shapes, in_equal_arcs
from synth.synthesis.starts.start_points import Start, start_points
from synth.synthesis.starts.thinning import thinned
from synth.synthesis.starts.turned_arms import (
    SAMPLE,
    as_it_is_and_turned,
    random_part,
    refined_for_all,
    relative_misses,
)

__all__ = [
    "ARCS",
    "ARM_LENGTH",
    "SAMPLE",
    "Postures",
    "Refined",
    "Shapes",
    "Start",
    "TargetsSeen",
    "as_it_is_and_turned",
    "estimated_misses",
    "exact_arms",
    "in_equal_arcs",
    "into_limits",
    "level",
    "nearest_to_exact_arms",
    "overlaps",
    "random_part",
    "refine",
    "refined_for_all",
    "relative_misses",
    "relative_weights",
    "start_points",
    "thinned",
]
