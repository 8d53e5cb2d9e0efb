"""Roots of trigonometric polynomials: where circles turn back, come close or stand still."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.arrays import FloatArray

    ComplexArray = NDArray[np.complex128]


def sampling_angles(degree: int) -> FloatArray:
    """Return the angles at which `root_angles` wants a polynomial of this degree, shape (4 degree,), rad."""
    return np.asarray(0.5 * np.pi / degree * np.arange(4 * degree), dtype=np.float64)


def root_angles(samples: FloatArray) -> FloatArray:
    """Return the angles at which trigonometric polynomials may vanish, in no particular order.

    A polynomial of degree n in t is w^-n times one of degree 2 n in w = exp(i t), whose roots are the
    eigenvalues of its companion matrix. Every real root is among the 2 n angles returned: a simple one
    to rounding, one of multiplicity m to about 1e-16^(1/m). The others are angles of complex roots,
    and of a polynomial that is zero everywhere they mean nothing.

    Args:
        samples: Values at `sampling_angles(n)`, shape (..., 4 n).

    Returns:
        Shape (..., 2 n), in [-pi, pi], rad.
    """
    return _root_angles(_coefficients(samples))


def critical_angles(samples: FloatArray) -> FloatArray:
    """Return the angles at which the derivatives of trigonometric polynomials may vanish.

    Args:
        samples: Values of the polynomials themselves, otherwise as for `root_angles`.

    Returns:
        Shape (..., 2 n), in [-pi, pi], rad.
    """
    degree = samples.shape[-1] // 4
    return _root_angles(_coefficients(samples) * 1j * np.arange(-degree, degree + 1))


def _coefficients(samples: FloatArray) -> ComplexArray:
    """Return the coefficients of w^-n, ..., w^n, up to a common factor."""
    degree = samples.shape[-1] // 4
    return np.roll(np.fft.fft(samples), degree, axis=-1)[..., : 2 * degree + 1]


def _root_angles(polynomial: ComplexArray) -> FloatArray:
    """Return the angles of the roots of complex polynomials, the constant coefficient first."""
    count = polynomial.shape[-1] - 1
    # A leading coefficient of zero would send roots to infinity: far away is enough, and milder.
    leading = polynomial[..., -1:]
    floor = 1e-10 * np.max(np.abs(polynomial), axis=-1, keepdims=True) + np.finfo(np.float64).tiny
    leading = np.where(np.abs(leading) < floor, floor, leading)
    companion = np.zeros((*polynomial.shape[:-1], count, count), dtype=np.complex128)
    companion[..., 1:, :-1] = np.eye(count - 1)
    companion[..., -1] = -polynomial[..., :-1] / leading
    return np.asarray(np.angle(np.linalg.eigvals(companion)))
