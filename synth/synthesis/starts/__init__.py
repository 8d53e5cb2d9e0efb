"""Start points: shapes at random, led to the targets, the most promising first."""

from synth.synthesis.starts.exact_arms import exact_designs, nearest_to_designs
from synth.synthesis.starts.overlaps import overlaps
from synth.synthesis.starts.postures import Aims, Postures
from synth.synthesis.starts.refined import Refined, relative_weights
from synth.synthesis.starts.refinement import level, refine
from synth.synthesis.starts.screening import estimated_misses
from synth.synthesis.starts.shapes import ARCS, ARM_LENGTH, Population, in_equal_arcs, into_limits
from synth.synthesis.starts.start_points import Start, starts
from synth.synthesis.starts.thinning import thinned
from synth.synthesis.starts.turned_arms import (
    SAMPLE,
    as_it_is_and_turned,
    improved,
    random_part,
    relative_misses,
)

__all__ = [
    "ARCS",
    "ARM_LENGTH",
    "SAMPLE",
    "Aims",
    "Population",
    "Postures",
    "Refined",
    "Start",
    "as_it_is_and_turned",
    "estimated_misses",
    "exact_designs",
    "improved",
    "in_equal_arcs",
    "into_limits",
    "level",
    "nearest_to_designs",
    "overlaps",
    "random_part",
    "refine",
    "relative_misses",
    "relative_weights",
    "starts",
    "thinned",
]
