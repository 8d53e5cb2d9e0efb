"""The workspace surface as an ellipse in the plane of (z, N), and the conics through given targets.

With N = x^2 + y^2 + z^2, K = a^2 + h^2 + R^2, A = a^2 / sin^2(alpha), P = a^2 R^2, m = h cos(alpha):

    Gamma / q0 = (N - 2 z0 z + z0^2 - K)^2 + 4 A (z - z0 - m)^2 - 4 P

has degree two in (z, N). So the quartic surfaces of 2-DOF arms are ellipses in that plane, five targets
are five points of a conic, and four targets leave a pencil of conics. What an ellipse leaves open is
a^2 = t, as K = t + m^2 A / (A - t) + P / t and a choice of two: the cubic

    f(t) = t^3 - (A + K) t^2 + (P + K A - A m^2) t - P A = 0,   0 < t <= A,

where f(0) = -P A and f(A) = -A^2 m^2 are not positive, so that two roots lie there or none.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from synth.arrays import FloatArray, frozen_value

BoolArray = NDArray[np.bool_]

# Targets count as lying on one sphere or in one plane if they scatter less than this about it, as a
# fraction of their own extent; and as too few if rounding decides the conic: two are on one circle about z.
_FLAT = 1e-9
_RANK = 1e-12
# Newton's method halves its error per step where roots coincide, and squares it elsewhere.
_CUBIC_STEPS = 40
# How far below 0 rounding may bring what a square root is taken of, as a fraction of its terms. It only
# admits starts: they are polished, and what then misses a target is dropped.
_ROOT_SLACK = 1e-3


class Ellipse(NamedTuple):
    """The five constants of a workspace surface, equal for an arm and its cognate; arrays of one shape.

    Attributes:
        A: a^2 / sin^2(alpha), m^2.
        P: a^2 R^2, m^4.
        K: a^2 + h^2 + R^2, m^2.
        m: Height h cos(alpha) of the centre of the circle over the common normal, m.
        z0: Height of the common normal, m.
    """

    A: FloatArray
    P: FloatArray
    K: FloatArray
    m: FloatArray
    z0: FloatArray

    def squared_normals(self) -> tuple[FloatArray, BoolArray]:
        """Return both candidates for t = a^2, shape (S, 2), m^2, and whether they are real, shape (S, 1).

        The constants are of shape (S, 1).

        The third root of f lies in [A, A + K], and Newton's method falls on it from above. Its division
        out of f leaves t^2 - b t + c, with b taken from the linear coefficient of f: of the quadratic one
        little would be left where a is small.
        """
        total, linear = self.A + self.K, self.P + self.A * (self.K - self.m**2)
        third = total
        for _ in range(_CUBIC_STEPS):
            value = ((third - total) * third + linear) * third - self.P * self.A
            third = third - value / ((3.0 * third - 2.0 * total) * third + linear)
        c = self.P * self.A / third
        b = (linear - c) / third
        discriminant = b**2 - 4.0 * c
        larger = 0.5 * (b + np.sqrt(np.maximum(discriminant, 0.0)))
        return np.concatenate([c / larger, larger], axis=-1), discriminant >= -_ROOT_SLACK * b**2

    def designs(self, squared_normal: FloatArray) -> tuple[FloatArray, BoolArray]:
        """Return a, alpha, z0, h, R with t = a^2 given, shape (..., 5), and whether they are real.

        Axis 2 is oriented such that alpha <= pi/2, and h has the sign of m.
        """
        t = squared_normal
        cosine2, h2 = 1.0 - t / self.A, self.K - t - self.P / t
        real = (self.A > 0.0) & (self.P > 0.0) & (t > 0.0) & (cosine2 > -_ROOT_SLACK)
        # Of cos(alpha) and h, one is the root of its square and the other m over it. The root is taken of the
        # larger of the two: in the smaller, rounding may be all there is.
        by_cosine = cosine2 * self.K >= h2
        cosine, h, lift = np.sqrt(np.clip(cosine2, 0.0, 1.0)), np.sqrt(h2), np.abs(self.m)
        cosine, h = (
            np.where(by_cosine, cosine, np.minimum(lift / h, 1.0)),
            np.where(by_cosine, lift / cosine, h),
        )
        values = (np.sqrt(t), np.arccos(cosine), self.z0, np.copysign(h, self.m), np.sqrt(self.P / t))
        return np.stack(np.broadcast_arrays(*values), axis=-1), real


@frozen_value
class Conics:
    """All conics through the targets of each set in the plane of (z, N), as a linear space.

    The plane is first mapped such that the targets scatter by 1 about 0 in both coordinates, for only
    the part of N that is not linear in z tells a surface from a sphere:

        z = mean_z + scale_z u,   N' = mean_n + slope (z - mean_z) + scale_n v,

    N' the squared distance from the point of axis 1 at mean_z. There a conic is
    q0 v^2 + 2 q1 u v + q2 u^2 + 2 q3 v + 2 q4 u + q5 = 0. The shear is a shift of z0 by slope / 2, the
    scales only stretch: nothing is lost, and nearly spherical or plane sets become as good as others.

    Attributes:
        mean_z: Mean height of the targets, shape (S, 1), m.
        mean_n: Mean of N', shape (S, 1), m^2.
        slope: Regression of N' on z, shape (S, 1), m.
        scale_z: Root mean square of z - mean_z, shape (S, 1), m; 1 in a plane.
        scale_n: Root mean square of what the regression leaves of N', shape (S, 1), m^2; 1 on a sphere.
        basis: Coefficients q0, ..., q5 of a basis, shape (S, d, 6).
        generic: Whether the targets fix d = 6 - n conics and lie neither in a plane nor on a sphere
            about a point of axis 1, shape (S,).
    """

    mean_z: FloatArray
    mean_n: FloatArray
    slope: FloatArray
    scale_z: FloatArray
    scale_n: FloatArray
    basis: FloatArray
    generic: BoolArray

    @classmethod
    def through(cls, targets: FloatArray) -> Conics:
        """Return the conics through n targets of each set, shape (S, n, 3), m."""
        mean_z = np.mean(targets[..., 2], axis=-1, keepdims=True)
        z = targets[..., 2] - mean_z
        n = targets[..., 0] ** 2 + targets[..., 1] ** 2 + z**2
        mean_n = np.mean(n, axis=-1, keepdims=True)
        scale_z = np.sqrt(np.mean(z**2, axis=-1, keepdims=True))
        plane = scale_z <= _FLAT * np.sqrt(mean_n)
        scale_z = np.where(plane, 1.0, scale_z)
        slope = np.mean(n * z, axis=-1, keepdims=True) / scale_z**2
        n = n - mean_n - slope * z
        scale_n = np.sqrt(np.mean(n**2, axis=-1, keepdims=True))
        sphere = scale_n <= _FLAT * mean_n
        scale_n = np.where(sphere, 1.0, scale_n)

        u, v = z / scale_z, n / scale_n
        monomials = np.stack([v**2, 2.0 * u * v, u**2, 2.0 * v, 2.0 * u, np.ones_like(u)], axis=-1)
        _, singular, basis = np.linalg.svd(monomials)
        generic = ~(plane | sphere)[..., 0] & (singular[..., -1] > _RANK * singular[..., 0])
        return cls(mean_z, mean_n, slope, scale_z, scale_n, basis[..., targets.shape[-2] :, :], generic)

    def ellipses(self, q: FloatArray) -> Ellipse:
        """Return the constants of conics, shape (S, k, 6), each of shape (S, k).

        They are those of an ellipse where A > 0 and P > 0.
        """
        q0, q1, _, q3, *_ = np.moveaxis(q, -1, 0)
        _, centre_u, minor, determinant = _adjugate(q)
        z0 = 0.5 * self.slope - self._stretch * q1 / q0
        return Ellipse(
            A=self._stretch**2 * minor / q0**2,
            P=-(self.scale_n**2) * determinant / (4.0 * q0 * minor),
            K=z0**2 + self.mean_n - self.scale_n * q3 / q0,
            m=self.scale_z * centre_u / minor - z0,
            z0=z0 + self.mean_z,
        )

    def radius_defect(self, q: FloatArray, radius: FloatArray) -> FloatArray:
        """Return a sextic form in q, shape (S, k), that vanishes where an arm of radius R has the conic q.

        It is f(P / R^2) = 0 without its denominators,

            P^2 - P R^2 (A + K - R^2) - A R^4 (R^2 + m^2 - K) = 0,

        where A + K is linear in q over q0, and K - m^2 the squared distance from axis 1 of the centre of
        the ellipse. The form has degree 6, so that a pencil holds at most six arms of a radius. (Cleared
        of its denominators term by term, the equation has degree 8, and q0^2 as a factor of it.)

        Args:
            q: Conics, shape (S, k, 6).
            radius: R, shape (S, 1), m.
        """
        q0, q1, q2, q3, *_ = np.moveaxis(q, -1, 0)
        centre_v, centre_u, minor, determinant = _adjugate(q)
        volume = 0.25 * self.scale_n**2 * determinant
        extent = (
            self._stretch**2 * q2
            + (0.25 * self.slope**2 + self.mean_n) * q0
            - self._stretch * self.slope * q1
            - self.scale_n * q3
        )
        height = self.scale_z * centre_u
        square = self.mean_n * minor + self.slope * height + self.scale_n * centre_v
        r2 = radius**2
        return np.asarray(
            volume**2
            + r2 * minor * volume * (extent - r2 * q0)
            - (self._stretch * r2) ** 2 * minor * (r2 * minor**2 - minor * square + height**2)
        )

    @property
    def _stretch(self) -> FloatArray:
        """Half the ratio of the scales, shape (S, 1), m."""
        return 0.5 * self.scale_n / self.scale_z


def _adjugate(q: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return the centre of conics as (v, u, weight), and their determinant, each of shape (...)."""
    q0, q1, q2, q3, q4, q5 = np.moveaxis(q, -1, 0)
    v, u, weight = q1 * q4 - q2 * q3, q1 * q3 - q0 * q4, q0 * q2 - q1**2
    return v, u, weight, q3 * v + q4 * u + q5 * weight
