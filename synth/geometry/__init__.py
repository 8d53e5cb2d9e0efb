"""Geometry of a 2-DOF arm with two skew axes, from distances to the workspace and back.

Eight squared distances between P1, P2 on axis 1, P3, P4 on axis 2 and the end effector P5 describe an
arm (`ArmDistances`). Five points in space have no four-dimensional volume: their Cayley-Menger
determinant vanishes, and read as an equation for P5 that is the workspace surface (`WorkspaceSurface`).

Distances say more than the surface knows, since P3 and P4 may slide along axis 2. What remains is the
circle that P5 runs on (`SweptCircle`), five numbers without a frame (`Invariants`), and the names that
special arms have (`Category`). `realise` turns distances into points, `squared_distances` points into
distances:

    ArmDistances <-> points <-> SweptCircle <-> Invariants -> CategoryDistances -> Category
         +------> WorkspaceSurface <----+

The way back from targets is exact for few of them: five have at most two designs, four with a known R at
most six (`arms_through_five`, `arms_through_four`), fewer have families (`sample_exact_arms`), and so
have targets in a plane or on a sphere (`planes_through`, `spheres_through`, `circle_through`); of many,
arms through a few are led near all (`arms_near`). Every arm
has one `cognate`, another arm with the same surface.

Beside the arm there are solids to keep clear of (`Sphere`, `Box`, `Capsule`), and least values that are
certain (`least_values`).

SI units; axis 1 is z and P1 the origin; all values are frozen. Plain numpy, and no solver.
"""

from synth.geometry.categories import Category, CategoryDistances, classify
from synth.geometry.circle import SweptCircle
from synth.geometry.distances import (
    ArmDistances,
    cayley_menger,
    cayley_menger_bideterminant,
    realise,
    squared_distances,
)
from synth.geometry.exact import (
    ExactArms,
    PlaneFamily,
    SphereFamily,
    arms_near,
    arms_through_five,
    arms_through_four,
    circle_through,
    cognate,
    is_generic,
    planes_through,
    sample_exact_arms,
    spheres_through,
)
from synth.geometry.gamma import WorkspaceSurface, distance_polynomials, gamma_determinant
from synth.geometry.invariants import Invariants
from synth.geometry.least_value import least_values
from synth.geometry.rotations import roll_pitch_yaw, rotation_of
from synth.geometry.solids import Box, Capsule, Solid, Sphere
from synth.geometry.trigonometric import critical_angles, sampling_angles

__all__ = [
    "ArmDistances",
    "Box",
    "Capsule",
    "Category",
    "CategoryDistances",
    "ExactArms",
    "Invariants",
    "NearArms",
    "PlaneFamily",
    "Solid",
    "Sphere",
    "SphereFamily",
    "SweptCircle",
    "WorkspaceSurface",
    "arms_near",
    "arms_through_five",
    "arms_through_four",
    "cayley_menger",
    "cayley_menger_bideterminant",
    "circle_through",
    "classify",
    "cognate",
    "critical_angles",
    "distance_polynomials",
    "gamma_determinant",
    "is_generic",
    "least_values",
    "planes_through",
    "realise",
    "roll_pitch_yaw",
    "rotation_of",
    "sample_exact_arms",
    "sampling_angles",
    "spheres_through",
    "squared_distances",
]
