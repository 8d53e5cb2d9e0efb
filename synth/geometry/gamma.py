"""The workspace surface Gamma(x, y, z) = 0 as a quartic, and as the determinant it comes from."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, GivenArray, frozen, frozen_value
from synth.errors import GeometryError
from synth.geometry._gamma_polynomials import workspace_polynomials
from synth.geometry.distances import ArmDistances, cayley_menger

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


@frozen_value
class WorkspaceSurface:
    """The quartic surface on which the end effector of a 2-DOF arm moves.

    Gamma = q0 N^2 + q1 d12 z N + q2 (x^2 + y^2) + q3 z^2 + q4 d12 z + q5, N = x^2 + y^2 + z^2,
    in the base frame. Gamma is D(1,2,3,4,5) without a further factor, so that q0 = -(s12 s34 / 4)
    sin^2(alpha), alpha the angle of the axes, and Gamma is positive inside the tube and negative far away.

    Gamma is no distance. Where the axes are parallel or intersect it is minus a square, and vanishes
    together with its gradient: see `SweptCircle.distance` for the distance in metres.

    Attributes:
        d12: Distance of P1 and P2, m; a factor of the terms of q1 and q4.
        q: Coefficients q0, ..., q5, shape (6,); m^4, m^4, m^6, m^6, m^6, m^8.

    Source: Clark and Rojas (2020), section II; q is derived in `synth.geometry.derivation`.
    """

    d12: float
    q: GivenArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "q", frozen(self.q))

    @classmethod
    def from_squared_distances(cls, distances: ArmDistances) -> WorkspaceSurface:
        """Return the surface of the arm with these squared distances, m^2.

        Raises:
            GeometryError: If P1 and P2 coincide and leave axis 1 without a direction.
        """
        if not distances.s12 > 0.0:
            raise GeometryError("P1 and P2 coincide: axis 1 has no direction.")
        q, _ = workspace_polynomials(*distances)
        return cls(math.sqrt(distances.s12), frozen(q))

    def value(self, points: ArrayLike) -> FloatArray:
        """Return Gamma at points, shape (..., 3), m; of shape (...), m^8."""
        x, y, z = np.moveaxis(np.asarray(points, dtype=np.float64), -1, 0)
        radial, height = x**2 + y**2, self.d12 * z
        n = radial + z**2
        q0, q1, q2, q3, q4, q5 = self.q
        return np.asarray(q0 * n**2 + q1 * height * n + q2 * radial + q3 * z**2 + q4 * height + q5)

    def gradient(self, points: ArrayLike) -> FloatArray:
        """Return the gradient of Gamma at points, shape (..., 3), m; of shape (..., 3), m^7."""
        p = np.asarray(points, dtype=np.float64)
        n = np.sum(p**2, axis=-1)
        q0, q1, q2, q3, q4, _ = self.q
        along_axis = self.d12 * (q1 * n + q4)
        radial = 2.0 * (2.0 * q0 * n + q1 * self.d12 * p[..., 2])
        gradient = (radial[..., None] + 2.0 * np.array([q2, q2, q3])) * p
        gradient[..., 2] += along_axis
        return np.asarray(gradient)

    def residual(self, points: ArrayLike) -> FloatArray:
        """Return |Gamma| over the most that its terms could add up to as far away from P1.

        With r = |p| that is |q0| r^4 + |q1| d12 r^3 + (|q2| + |q3|) r^2 + |q4| d12 r + |q5|, not the sum
        of the terms at p: those are all zero on a plane z = 0, where nothing would be left to compare
        rounding with. Dimensionless, between 0 and 1, and the same for every scale of Gamma and of
        length: for checking that points satisfy the equation to rounding, not for how far they miss.
        For coincident axes it says nothing, since all coefficients are rounding.

        Args:
            points: Shape (..., 3), m.

        Returns:
            Shape (...).
        """
        r = np.linalg.norm(np.asarray(points, dtype=np.float64), axis=-1)
        q0, q1, q2, q3, q4, q5 = np.abs(self.q)
        bound = np.polynomial.polynomial.polyval(r, [q5, self.d12 * q4, q2 + q3, self.d12 * q1, q0])
        return np.asarray(np.abs(self.value(points)) / np.where(bound > 0.0, bound, 1.0))


def gamma_determinant(distances: ArmDistances, points: ArrayLike) -> FloatArray:
    """Return Gamma at points as the Cayley-Menger determinant D(1,2,3,4,5).

    It shares no formula with `WorkspaceSurface`, and so can judge it.

    Args:
        distances: The squared distances of the arm.
        points: Positions of P5 in the base frame, shape (..., 3), m.

    Returns:
        Shape (...), m^8.
    """
    p = np.asarray(points, dtype=np.float64)
    p2 = np.array([0.0, 0.0, math.sqrt(distances.s12)])
    return cayley_menger(distances.matrix(np.sum(p**2, axis=-1), np.sum((p - p2) ** 2, axis=-1)))


def distance_polynomials(distances: ArmDistances) -> FloatArray:
    """Return the determinant as a quadratic in the two distances of P5 from axis 1.

    D(1,2,3,4,5) = c0 + c1 s15 + c2 s25 + c3 s15^2 + c4 s15 s25 + c5 s25^2, with no frame chosen.

    Returns:
        c0, ..., c5, shape (6,); m^8, m^6, m^6, m^4, m^4, m^4.
    """
    _, c = workspace_polynomials(*distances)
    return frozen(c)
