"""The circle of P5 in cells: affine lower bounds of the distance of each cell from its target.

Every inequality is proven in docs/bound.md.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen_value

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.synthesis.bound.boxes import Boxes
    from synth.synthesis.bound.cells import Cells

_TINY = 1e-300


@frozen_value
class Forms:
    """Affine lower bounds of the distance of each candidate's target from its cell, in units of the box.

    Attributes:
        values: In the middle of box and cell, on both sides, shape (2, C), m.
        slopes: By the first four parameters, over the half-width of the box, shape (4, 2, C), m.
        along_cell: By the angle phi in the cell, shape (2, C), m / rad.
        half: Half the width of the cells, rad.
        distance: Of the middle of the cell from the target, shape (C,), m.
        floor: `distance` less all that moves, shape (C,), m.
        highest: Largest height in the cell, shape (C,), m.
    """

    values: FloatArray
    slopes: FloatArray
    along_cell: FloatArray
    half: float
    distance: FloatArray
    floor: FloatArray
    highest: FloatArray

    def take(self, chosen: NDArray[np.bool_]) -> Forms:
        """Return those of some of the cells."""
        return Forms(
            self.values[:, chosen],
            self.slopes[..., chosen],
            self.along_cell[:, chosen],
            self.half,
            self.distance[chosen],
            self.floor[chosen],
            self.highest[chosen],
        )

    @property
    def in_cell(self) -> FloatArray:
        """What the angle in the cell may take off the values, shape (2, C), m."""
        return np.asarray(np.abs(self.along_cell) * (self.half + self.half**3 / 6.0))

    def least(self) -> FloatArray:
        """Return lower bounds over the whole box and cell, shape (C,), m."""
        over_box = self.values - np.abs(self.slopes).sum(axis=0) - self.in_cell
        return np.asarray(np.maximum(over_box.max(axis=0), self.floor))


@frozen_value
class Circle:
    """Where P5 is to reach: the circle of P5 about axis 2, and the targets.

    Attributes:
        offset: From the link's end to the centre of the circle along axis 2, m.
        radius: Radius R of the circle, m.
        rho: Distances of the targets from axis 1, shape (n,), m.
        z: Their heights, shape (n,), m.
    """

    offset: float
    radius: float
    rho: FloatArray
    z: FloatArray

    @property
    def arm(self) -> float:
        """Distance of P5 from the link's end, m."""
        return math.hypot(self.offset, self.radius)

    def moved(self, boxes: Boxes) -> FloatArray:
        """Return how far any point of the circle moves in each box from its middle, shape (N,), m."""
        return boxes.end_radius + self.arm * np.minimum(boxes.turn, 2.0)

    def forms(self, boxes: Boxes, cells: Cells) -> Forms:
        """Return for each cell two affine functions of the box that its distance is nowhere less than."""
        at = _Points(self, boxes, cells)
        out, up = at.rho - self.rho[cells.target], at.z - self.z[cells.target]
        distance = np.hypot(out, up)
        regular = at.rho > 2.0 * at.moved
        bulge = at.across() ** 2 / (2.0 * np.where(regular, at.rho - at.moved, 1.0))
        rim, rim_z = at.cos * at.outward[2] - at.sin * at.outward[1], at.cos * at.up[2] - at.sin * at.up[1]
        steep = np.maximum(np.hypot(rim, rim_z), _TINY)
        # The normal that serves best: from the target to the nearest point of the cell, taken as straight.
        tangent_rho, tangent_z = rim / steep, rim_z / steep
        sideways = out * tangent_rho + up * tangent_z
        beyond = np.maximum(np.abs(sideways) - self.radius * cells.half * steep, 0.0)
        beyond = np.copysign(beyond, sideways) - sideways
        to_rho, to_z = out + beyond * tangent_rho, up + beyond * tangent_z
        length = np.maximum(np.hypot(to_rho, to_z), _TINY)
        to_rho, to_z, far = to_rho / length, to_z / length, length > at.moved
        count = len(distance)
        values, slopes, along_cell = np.empty((2, count)), np.empty((4, 2, count)), np.empty((2, count))
        for side, sign in enumerate((1.0, -1.0)):
            n_rho = np.where(far, to_rho, -sign * tangent_z)
            n_z = np.where(far, to_z, sign * tangent_rho)
            by_parameters, by_phi, remainder = at.projected(n_rho, n_z)
            value = n_rho * out + n_z * up - remainder - np.maximum(-n_rho, 0.0) * bulge
            values[side] = np.where(regular, value, distance - at.moved)
            for k, slope in enumerate(by_parameters):
                slopes[k, side] = np.where(regular, slope, 0.0)
            along_cell[side] = np.where(regular, by_phi, 0.0)
        return Forms(values, slopes, along_cell, cells.half, distance, distance - at.moved, at.z + at.moved)


class _Points:
    """P5 in the middles of cells, and its derivatives: (1) to (4) and (13) of docs/bound.md.

    Vectors are told by their components along u, e1 and e2, which are arrays of shape (C,).

    Attributes:
        cos: Of phi.
        sin: Of phi.
        rho: Distance from axis 1, m.
        z: Height, m.
        outward: The horizontal direction e from axis 1 to P5.
        sideways: The horizontal direction across that.
        up: The vertical.
        moved: How far P5 moves in box and cell at most, m.
    """

    def __init__(self, circle: Circle, boxes: Boxes, cells: Cells) -> None:
        box, self.offset, self.radius = cells.box, circle.offset, circle.radius
        (ux, uy, uz), (e1x, e1y, e1z), (e2x, e2y, e2z) = (axis.T[:, box] for axis in boxes.frame)
        self.cos, self.sin = np.cos(cells.phi), np.sin(cells.phi)
        self.b1, b2 = self.radius * self.cos, self.radius * self.sin
        x = boxes.middle[box, 0] + self.offset * ux + self.b1 * e1x + b2 * e2x
        y = self.offset * uy + self.b1 * e1y + b2 * e2y
        self.z = boxes.middle[box, 1] + self.offset * uz + self.b1 * e1z + b2 * e2z
        self.rho = np.hypot(x, y)
        off_axis = np.maximum(self.rho, _TINY)
        self.ex, self.ey = x / off_axis, y / off_axis
        self.outward = tuple(self.ex * a + self.ey * b for a, b in ((ux, uy), (e1x, e1y), (e2x, e2y)))
        self.sideways = tuple(self.ex * b - self.ey * a for a, b in ((ux, uy), (e1x, e1y), (e2x, e2y)))
        self.up = (uz, e1z, e2z)

        self.r1, self.r2, self.a, self.b = boxes.half.T[:4, box]
        self.axis_u, self.axis_1 = boxes.beta_axis[:, box]
        self.theta = np.minimum(boxes.turn, 2.0)[box]
        self.along = 2.0 * self.radius * math.sin(0.5 * cells.half)
        self.sine, self.rise = self.radius * math.sin(cells.half), self.radius * (1.0 - math.cos(cells.half))
        self.moved = circle.moved(boxes)[box] + self.along
        self.second = 0.5 * (self.a**2 + self.b**2 + self.a * self.b)
        self.arm = circle.arm

    def by_angles(self, u: FloatArray, e1: FloatArray, e2: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the derivatives of P5 by alpha and beta along a vector."""
        b2 = self.radius * self.sin
        by_beta = self.axis_u * (self.b1 * e2 - b2 * e1) + self.axis_1 * (b2 * u - self.offset * e2)
        return self.offset * e1 - self.b1 * u, by_beta

    def across(self) -> FloatArray:
        """Return how far P5 moves across the half-plane of the cell's middle at most, m."""
        by_alpha, by_beta = self.by_angles(*self.sideways)
        along_rim = np.abs(self.cos * self.sideways[2] - self.sin * self.sideways[1])
        first = np.abs(self.ey) * self.r1 + np.abs(by_alpha) * self.a + np.abs(by_beta) * self.b
        rest = self.second * self.arm + self.theta * self.along + self.rise
        return np.asarray(np.minimum(first + along_rim * self.sine + rest, self.moved))

    def projected(
        self, n_rho: FloatArray, n_z: FloatArray
    ) -> tuple[tuple[FloatArray, ...], FloatArray, FloatArray]:
        """Return how P5 moves along normals of its half-plane.

        Args:
            n_rho: Outward components of the normals.
            n_z: Their vertical components.

        Returns:
            Derivatives by rho, h, alpha and beta times the half-widths of the box, m; by phi, m / rad; and
            what is of higher order takes off at most, m.
        """
        u, e1, e2 = (n_rho * e + n_z * z for e, z in zip(self.outward, self.up, strict=True))
        a, b = self.a, self.b
        radial = self.cos * e1 + self.sin * e2
        by_alpha, by_beta = self.by_angles(u, e1, e2)
        axis = self.axis_u * u + self.axis_1 * e1
        lever = self.axis_u * self.offset + self.axis_1 * self.b1
        in_box = (
            0.5 * np.maximum(self.offset * u + self.b1 * e1, 0.0) * a**2
            + 0.5 * np.maximum(self.offset * u + self.radius * radial - axis * lever, 0.0) * b**2
            + np.abs(lever * e2) * a * b
            + self.arm * (a + b) ** 3 / 6.0
        )
        turned_rim = np.abs(self.sin * u) * a + np.abs(self.axis_1 * self.cos * u - self.axis_u * radial) * b
        in_both = self.sine * (turned_rim + self.second) + self.theta * self.rise
        remainder = (
            np.minimum(in_box, self.second * self.arm)
            + np.minimum(in_both, self.theta * self.along)
            + self.rise * np.maximum(radial, 0.0)
        )
        by_parameters = (n_rho * self.ex * self.r1, n_z * self.r2, by_alpha * a, by_beta * b)
        return by_parameters, self.radius * (self.cos * e2 - self.sin * e1), remainder
