"""Surfaces to be covered: their shapes, the cells that stand for them, and the files that hold them."""

from synth.surfaces.cells import Cells
from synth.surfaces.mesh import Scan, TriangleMesh
from synth.surfaces.mesh_file import read_corners
from synth.surfaces.points_file import read_points
from synth.surfaces.primitives import Profile, Rectangle, Revolved
from synth.surfaces.surface import SAMPLES, Shape, Surface, plane_within

__all__ = [
    "SAMPLES",
    "Cells",
    "Profile",
    "Rectangle",
    "Revolved",
    "Scan",
    "Shape",
    "Surface",
    "TriangleMesh",
    "plane_within",
    "read_corners",
    "read_points",
]
