"""The circle of P5 in cells: affine lower bounds of the distance of each cell from its target.

Every inequality is proven in docs/bound.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.synthesis.bound.boxes import Boxes

_PARTS = 4  # into which a cell is cut
_TINY = 1e-300


@dataclass(frozen=True, eq=False)
class Cells:
    """Pairs of a target and a cell of the circle of P5 in some boxes, sorted by box and target."""

    box: NDArray[np.intp]
    target: NDArray[np.intp]
    phi: FloatArray
    half: float

    def take(self, chosen: NDArray[np.bool_]) -> Cells:
        """Return some of the cells."""
        return Cells(self.box[chosen], self.target[chosen], self.phi[chosen], self.half)

    def cut(self) -> Cells:
        """Return each cell cut into equal parts."""
        shifts = self.half * ((2.0 * np.arange(_PARTS) + 1.0) / _PARTS - 1.0)
        phi = (self.phi[:, None] + shifts).ravel()
        return Cells(np.repeat(self.box, _PARTS), np.repeat(self.target, _PARTS), phi, self.half / _PARTS)


@dataclass(frozen=True, eq=False)
class Forms:
    """Affine lower bounds of the distance of each candidate's target from its cell, in units of the box.

    Attributes:
        values: In the middle of box and cell, on both sides, shape (2, C), m.
        slopes: By the first four parameters, over the half-width of the box, shape (2, C, 4), m.
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
            self.slopes[:, chosen],
            self.along_cell[:, chosen],
            self.half,
            self.distance[chosen],
            self.floor[chosen],
            self.highest[chosen],
        )

    def least(self) -> FloatArray:
        """Return lower bounds over the whole box and cell, shape (C,), m."""
        in_cell = np.abs(self.along_cell) * (self.half + self.half**3 / 6.0)
        over_box = self.values - np.abs(self.slopes).sum(axis=2) - in_cell
        return np.asarray(np.maximum(over_box.max(axis=0), self.floor))


@dataclass(frozen=True, eq=False)
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
        box = cells.box
        u, e1, e2 = (direction[box] for direction in boxes.frame)
        cos, sin = np.cos(cells.phi)[:, None], np.sin(cells.phi)[:, None]
        outward, tangent = cos * e1 + sin * e2, cos * e2 - sin * e1
        arm = self.offset * u + self.radius * outward
        point = boxes.end[box] + arm
        rho = np.hypot(point[:, 0], point[:, 1])
        off_axis = np.maximum(rho, _TINY)
        out, up = rho - self.rho[cells.target], point[:, 2] - self.z[cells.target]
        distance = np.hypot(out, up)
        turn = np.minimum(boxes.turn, 2.0)
        along = 2.0 * self.radius * math.sin(0.5 * cells.half)
        moved = self.moved(boxes)[box] + along
        regular = rho > 2.0 * moved
        x, y = point[:, 0] / off_axis, point[:, 1] / off_axis

        # What is of second order in the box and the cell, whatever the direction.
        a, b = boxes.half[:, 2], boxes.half[:, 3]
        second = (0.5 * self.arm * (a**2 + b**2 + a * b))[box] + turn[box] * along
        by_alpha = np.cross(e2, arm)
        by_beta = np.cross(boxes.beta_axis[box], arm)
        rim = x * tangent[:, 0] + y * tangent[:, 1]
        steep = np.maximum(np.hypot(rim, tangent[:, 2]), _TINY)
        # The normal that serves best: from the target to the nearest point of the cell, taken as straight.
        tangent_rho, tangent_z = rim / steep, tangent[:, 2] / steep
        sideways = out * tangent_rho + up * tangent_z
        beyond = np.sign(sideways) * np.maximum(np.abs(sideways) - self.radius * cells.half * steep, 0.0)
        to_rho = out + (beyond - sideways) * tangent_rho
        to_z = up + (beyond - sideways) * tangent_z
        length = np.maximum(np.hypot(to_rho, to_z), _TINY)
        far = length > moved
        values, slopes, along_cell = [], [], []
        for side in (1.0, -1.0):
            n_rho = np.where(far, to_rho / length, -side * tangent_z)
            n_z = np.where(far, to_z / length, side * tangent_rho)
            normal = np.stack([n_rho * x, n_rho * y, n_z], axis=-1)
            bulge = np.maximum(np.einsum("ci,ci->c", normal, outward), 0.0)
            value = n_rho * out + n_z * up - second - self.radius * (1.0 - math.cos(cells.half)) * bulge
            value -= np.maximum(-n_rho, 0.0) * moved**2 / (2.0 * np.where(regular, rho - moved, 1.0))
            slope = np.stack(
                [
                    normal[:, 0],
                    normal[:, 2],
                    np.einsum("ci,ci->c", normal, by_alpha),
                    np.einsum("ci,ci->c", normal, by_beta),
                ],
                axis=-1,
            )
            values.append(np.where(regular, value, distance - moved))
            slopes.append(np.where(regular[:, None], slope * boxes.half[box, :4], 0.0))
            rate = self.radius * np.einsum("ci,ci->c", normal, tangent)
            along_cell.append(np.where(regular, rate, 0.0))
        return Forms(
            np.stack(values),
            np.stack(slopes),
            np.stack(along_cell),
            cells.half,
            distance,
            distance - moved,
            point[:, 2] + moved,
        )


def wrapped(angle: FloatArray) -> FloatArray:
    """Return angles moved by whole turns into [-pi, pi], rad."""
    return np.asarray(angle - 2.0 * math.pi * np.rint(angle / (2.0 * math.pi)))
