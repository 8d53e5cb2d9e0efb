"""A surface that shall be covered: its shape, where it is, what of it counts, and how much of that."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, Given, GivenArray, frozen_value, given
from synth.checks import SMALLEST, Checks, wrong_type
from synth.geometry import Box, Capsule, Solid, Sphere, rotation_of
from synth.surfaces.mesh import Scan, TriangleMesh
from synth.surfaces.primitives import Rectangle, Revolved

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from synth.surfaces.cells import Cells

Shape = Revolved | Rectangle | TriangleMesh | Scan
SAMPLES = 2_500  # cells that stand for a surface in a search
_MOST_CELLS = 400_000  # of a whole of which a small part counts
_TRIES = 4


@frozen_value
class Surface:
    """A surface that the end effector shall cover.

    Attributes:
        name: How the result speaks of it.
        shape: The surface in a frame of its own, m.
        tolerance: Largest miss of a point of it that counts as covered, m.
        coverage: Share of its area that shall be covered, above 0 and up to 1.
        position: Where its own frame is in the task frame, shape (3,), m.
        rpy: Roll, pitch and yaw of that frame, shape (3,), rad.
        region: Only what is within one of these solids counts, in the task frame; all if there are none.
        margin: What is nearer than this to the surface's own boundary does not count, m.
    """

    name: str
    shape: Shape
    tolerance: float = 1e-3
    coverage: float = 1.0
    position: GivenArray = given(default_factory=lambda: np.zeros(3))
    rpy: GivenArray = given(default_factory=lambda: np.zeros(3))
    region: Given[Sequence[Solid], tuple[Solid, ...]] = given(default=())
    margin: float = 0.0

    def __post_init__(self) -> None:
        checks = Checks(self)
        checks.name("name")
        checks.is_a("shape", (Revolved, Rectangle, TriangleMesh, Scan))
        checks.number("tolerance", least=SMALLEST)
        checks.number("coverage", above=0.0, most=1.0)
        checks.array("position", (3,))
        checks.array("rpy", (3,))
        checks.number("margin", least=0.0)
        checks.put("region", tuple(self.region))
        for index, solid in enumerate(self.region):
            if wrong := wrong_type(solid, (Sphere, Box, Capsule)):
                checks.report(f"region[{index}]", wrong)
        if not checks.found_in("margin") and self.margin > 0.0 and not self.shape.has_boundary:
            checks.report("margin", "this surface has no boundary of its own to keep from")
        checks.refuse()
        if not len(self.samples):
            smaller = f", or a part smaller than one of its {_MOST_CELLS} cells" * (not self._is_scan)
            checks.report("region" if self.region else "margin", f"leaves nothing of the surface{smaller}")
        checks.refuse()

    @property
    def _is_scan(self) -> bool:
        return isinstance(self.shape, Scan)

    @cached_property
    def samples(self) -> Cells:
        """The cells that stand for it in a search; all points of a scan."""
        return self.cells(SAMPLES)

    def cells(self, count: int) -> Cells:
        """Return about so many cells of what counts of it, in the task frame; a cell counts by its point.

        Args:
            count: How many; of a mesh there are no fewer than its triangles within the region.
        """
        cells, counts = self.divided(count)
        return cells.take(counts)

    def divided(self, count: int) -> tuple[Cells, NDArray[np.bool_]]:
        """Return cells of all of its shape, in the task frame, and which count: about so many of these."""
        asked = count
        for _ in range(_TRIES):
            cells, counts = self._divided(asked)
            left = int(np.count_nonzero(counts))
            if left >= 0.5 * count or asked >= _MOST_CELLS or self._is_scan:
                break
            asked = min(int(asked * min(count / max(left, 1), 30.0)), _MOST_CELLS)
        return cells, counts

    def _divided(self, asked: int) -> tuple[Cells, NDArray[np.bool_]]:
        own = self.shape.cells(asked)
        counts = np.ones(len(own), dtype=bool)
        if self.margin > 0.0:
            counts &= self.shape.boundary_distance(own.points) >= self.margin
        cells = own.placed(self.position, rotation_of(*self.rpy))
        if self.region:
            counts &= np.min([solid.distance(cells.points) for solid in self.region], axis=0) <= 0.0
        return cells, counts


def plane_within(
    point: FloatArray, frame: FloatArray, region: Sequence[Solid]
) -> tuple[Rectangle, FloatArray]:
    """Return a rectangle of a plane without end that holds all of it within a region.

    Args:
        point: A point in the plane, shape (3,), m, in the frame of the region.
        frame: Two directions in the plane and the one across it, as columns, shape (3, 3).
        region: Solids.

    Returns:
        The rectangle in a frame of its own, and where its middle is, shape (3,), m.
    """
    axes = frame.T[:2]
    low = np.min([-solid.support(-axes) for solid in region], axis=0)
    high = np.max([solid.support(axes) for solid in region], axis=0)
    off = 0.5 * (low + high) - axes @ point
    return Rectangle(high - low, has_boundary=False), point + off @ axes
