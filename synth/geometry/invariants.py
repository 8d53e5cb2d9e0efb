"""What a shape of the arm means for its workspace, in five numbers."""

from __future__ import annotations

import math
from dataclasses import astuple, dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from synth.errors import GeometryError
from synth.geometry.circle import SweptCircle

if TYPE_CHECKING:
    from synth.geometry.distances import ArmDistances

# With sin(alpha) = e the common normal stands about 1 m / e away, and its height carries rounding of
# 1e-16 / e; taking the axes for parallel instead moves them by e. Both are 1e-8 m here.
_PARALLEL = 1e-8


@dataclass(frozen=True)
class Invariants:
    """The five numbers of two lines and a circle that determine the workspace surface.

    With N = x^2 + y^2 + z^2, K = a^2 + h^2 + R^2, A = a^2 / sin^2(alpha) and zc = z0 + h cos(alpha):

        Gamma / q0 = (N - 2 z0 z + z0^2 - K)^2 + 4 A (z - zc)^2 - 4 a^2 R^2.

    Axis 2 is oriented from P3 to P4; turning it round changes (alpha, h) into (pi - alpha, -h) and
    leaves the surface alone. Mirror images have the same invariants and the same surface.

    Attributes:
        a: Distance of the axes, at least 0, m. It is 0 where they meet, at the height z0.
        alpha: Angle between the oriented axes, in [0, pi], rad.
        z0: Height of the common normal on axis 1, from P1 towards P2, m.
        h: From the common normal to the centre of the circle of P5, along axis 2, m: positive from
            P3 towards P4. Parallel axes (sin(alpha) below 1e-8) have a common normal everywhere: it is
            then taken through the centre, h = 0.
        R: Radius of the circle, at least 0, m.

    Raises:
        GeometryError: If a number is not finite or out of its range.
    """

    a: float
    alpha: float
    z0: float
    h: float
    R: float

    def __post_init__(self) -> None:
        if not all(math.isfinite(value) for value in astuple(self)):
            raise GeometryError("The invariants of an arm must be finite numbers.")
        if self.a < 0.0 or self.R < 0.0 or not 0.0 <= self.alpha <= math.pi:
            raise GeometryError("Invariants need a >= 0, R >= 0 and alpha between 0 and pi.")

    @classmethod
    def from_circle(cls, circle: SweptCircle) -> Invariants:
        """Return the invariants of an axis 2 and the circle about it, given in the base frame."""
        (cx, cy, cz), (ux, uy, uz) = circle.centre.tolist(), circle.axis.tolist()
        sine = math.hypot(ux, uy)
        if sine < _PARALLEL:
            return cls(math.hypot(cx, cy), 0.0 if uz > 0.0 else math.pi, cz, 0.0, circle.radius)
        # The foot of the common normal is the point of axis 2 nearest to axis 1, seen along z.
        h = (cx * ux + cy * uy) / sine**2
        return cls(abs(circle.moment) / sine, math.atan2(sine, uz), cz - h * uz, h, circle.radius)

    @classmethod
    def from_squared_distances(cls, distances: ArmDistances) -> Invariants:
        """Return the invariants of the arm with these squared distances, m^2.

        Distances see a only through D(1,2,3,4) = s12 s34 sin^2(alpha) a^2: of axes that meet, rounding
        leaves a up to about 1e-6 m with axis points 50 mm apart.

        Raises:
            GeometryError: If no points in space have these distances or an axis has no direction.
        """
        return cls.from_circle(SweptCircle.from_squared_distances(distances))

    @property
    def centre_height(self) -> float:
        """Height zc = z0 + h cos(alpha) of the centre of the circle, m."""
        return self.z0 + self.h * math.cos(self.alpha)

    def circle(self, chirality: Literal[1, -1] = 1) -> SweptCircle:
        """Return axis 2 and its circle, with the centre in the half-plane x >= 0, y = 0.

        A centre on axis 1 leaves the turn about z open: axis 2 is then put into that half-plane.

        Args:
            chirality: Sign of the orientation of (P1, P2, P3, P4), so of u_y: which mirror image.
        """
        sine, cosine = math.sin(self.alpha), math.cos(self.alpha)
        # Seen along z: the centre, from axis 1, along the common normal and along axis 2.
        across, along = self.a, self.h * sine
        rho = math.hypot(across, along)
        tilt = (along / rho, across / rho) if rho > 0.0 else (1.0, 0.0)
        axis = [sine * tilt[0], chirality * sine * tilt[1], cosine]
        return SweptCircle(np.array([rho, 0.0, self.centre_height]), np.array(axis), self.R)
