"""A surface in pieces: what stands for it in a search, and bounds what lies between."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen, frozen_value

if TYPE_CHECKING:
    from numpy.typing import NDArray


@frozen_value
class Cells:
    """Pieces that together are a surface, each known by a point of it.

    Attributes:
        points: A point in each, shape (n, 3), m.
        normals: Unit normals of the surface there, shape (n, 3); NaN where no surface is known.
        areas: Area of each, shape (n,), m^2; 1 each where no surface is known.
        radii: No point of the piece is farther than this from its point on a way along the surface, shape
            (n,), m; infinite where no surface is known between the points.
        curvatures: No normal curvature of the surface is larger in each, shape (n,), 1/m.
        corners: Corners of each, whose convex hull it is, shape (n, k, 3), m; None where they are not flat.
    """

    points: FloatArray
    normals: FloatArray
    areas: FloatArray
    radii: FloatArray
    curvatures: FloatArray
    corners: FloatArray | None = None

    def __post_init__(self) -> None:
        for name in ("points", "normals", "areas", "radii", "curvatures"):
            object.__setattr__(self, name, frozen(getattr(self, name)))
        object.__setattr__(self, "corners", None if self.corners is None else frozen(self.corners))

    def __len__(self) -> int:
        return len(self.areas)

    @property
    def are_joined(self) -> bool:
        """Whether a surface is known between the points."""
        return bool(np.isfinite(self.radii).all())

    def take(self, chosen: NDArray[np.bool_] | NDArray[np.intp]) -> Cells:
        """Return some of the cells."""
        columns = (self.points, self.normals, self.areas, self.radii, self.curvatures)
        points, normals, areas, radii, curvatures = (column[chosen] for column in columns)
        corners = None if self.corners is None else self.corners[chosen]
        return Cells(points, normals, areas, radii, curvatures, corners)

    def placed(self, position: FloatArray, rotation: FloatArray) -> Cells:
        """Return the cells of the surface moved to a position, shape (3,), and turned, (3, 3)."""
        points, normals = self.points @ rotation.T + position, self.normals @ rotation.T
        corners = None if self.corners is None else self.corners @ rotation.T + position
        return Cells(points, normals, self.areas, self.radii, self.curvatures, corners)
