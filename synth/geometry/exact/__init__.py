"""Exact synthesis: the arms whose workspace surface passes through given targets, by algebra alone."""

from synth.geometry.exact.cognate import cognate
from synth.geometry.exact.designs import Designs, designs_through_five, designs_through_four, is_generic
from synth.geometry.exact.families import (
    PlaneFamily,
    SphereFamily,
    circle_through,
    planes_through,
    spheres_through,
)
from synth.geometry.exact.sampling import sample_designs

__all__ = [
    "Designs",
    "PlaneFamily",
    "SphereFamily",
    "circle_through",
    "cognate",
    "designs_through_five",
    "designs_through_four",
    "is_generic",
    "planes_through",
    "sample_designs",
    "spheres_through",
]
