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
from synth.geometry.gamma import WorkspaceSurface, distance_polynomials, gamma_determinant
from synth.geometry.invariants import Invariants
from synth.geometry.trigonometric import critical_angles, sampling_angles

__all__ = [
    "ArmDistances",
    "Category",
    "CategoryDistances",
    "Invariants",
    "SweptCircle",
    "WorkspaceSurface",
    "cayley_menger",
    "cayley_menger_bideterminant",
    "classify",
    "critical_angles",
    "distance_polynomials",
    "gamma_determinant",
    "realise",
    "sampling_angles",
    "squared_distances",
]
