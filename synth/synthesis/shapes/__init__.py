"""Many shapes of one robot at once, as arrays: their rows, limits, motions, postures and overlaps."""

from synth.synthesis.shapes.category_offsets import category_offsets, category_slopes
from synth.synthesis.shapes.circles import ARM_LENGTH, circles_of_designs, circles_of_shapes
from synth.synthesis.shapes.columns import ARCS
from synth.synthesis.shapes.overlaps import overlaps
from synth.synthesis.shapes.postures import Postures, dot, pointing_off
from synth.synthesis.shapes.shapes import Shapes, in_equal_arcs
from synth.synthesis.shapes.targets_seen import TargetsSeen

__all__ = [
    "ARCS",
    "ARM_LENGTH",
    "Postures",
    "Shapes",
    "TargetsSeen",
    "category_offsets",
    "category_slopes",
    "circles_of_designs",
    "circles_of_shapes",
    "dot",
    "in_equal_arcs",
    "overlaps",
    "pointing_off",
]
