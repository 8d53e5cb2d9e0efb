"""Triangles on a workspace surface."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen, frozen_value

if TYPE_CHECKING:
    from numpy.typing import NDArray


@frozen_value
class SurfaceMesh:
    """Triangles on a workspace surface.

    Attributes:
        vertices: Points in the task frame, shape (n, 3), m.
        faces: Indices of the vertices of each triangle, shape (m, 3); of a tube about skew axes
            anticlockwise as seen from outside.
        reachable: Whether each triangle is within the joint limits and above the floor, shape (m,).
    """

    vertices: FloatArray
    faces: NDArray[np.int64]
    reachable: NDArray[np.bool]

    def __post_init__(self) -> None:
        object.__setattr__(self, "vertices", frozen(self.vertices))
        for name in ("faces", "reachable"):
            array = getattr(self, name).copy()
            array.setflags(write=False)
            object.__setattr__(self, name, array)

    @property
    def face_areas(self) -> FloatArray:
        """Area of each triangle, shape (m,), m^2."""
        a, b, c = np.moveaxis(self.vertices[self.faces], 1, 0)
        return np.asarray(0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=-1))
