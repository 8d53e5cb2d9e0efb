"""Exact synthesis: the arms whose workspace surface passes through given targets, by algebra alone."""

from synth.geometry.exact.cognate import cognate
from synth.geometry.exact.consensus import NearArms, arms_near
from synth.geometry.exact.exact_arms import ExactArms, arms_through_five, arms_through_four, is_generic
from synth.geometry.exact.families import (
    PlaneFamily,
    SphereFamily,
    circle_through,
    planes_through,
    spheres_through,
)
from synth.geometry.exact.sampling import sample_exact_arms

__all__ = [
    "ExactArms",
    "NearArms",
    "PlaneFamily",
    "SphereFamily",
    "arms_near",
    "arms_through_five",
    "arms_through_four",
    "circle_through",
    "cognate",
    "is_generic",
    "planes_through",
    "sample_exact_arms",
    "spheres_through",
]
