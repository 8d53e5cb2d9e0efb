"""The conics of a pencil that belong to arms with a known radius: the roots of a sextic on a circle.

A pencil is a projective line: its members are cos(phi) q + sin(phi) q'. In w = exp(2 i phi) it is the unit
circle, a form of degree 6 becomes a polynomial of degree 6, and real conics are roots with |w| = 1. So
no root is near infinity, and interpolation at seven points of the circle is a Fourier transform.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from synth.arrays import FloatArray
    from synth.geometry.exact.conics import BoolArray, Conics

ComplexArray = NDArray[np.complex128]

_DEGREE = 6
_NODES: FloatArray = np.linspace(0.0, np.pi, _DEGREE + 1, endpoint=False)
# One round of roots to see where they crowd, two on the circle mapped such that they do so less.
_ROUNDS = 3
# Roots this close to the circle, as |log |w||, are tried as real: a double root may have split.
_NEARLY_REAL = 0.2


def members_of_radius(conics: Conics, radius: FloatArray) -> tuple[FloatArray, BoolArray]:
    """Return the six members that may have arms of the radius R, and whether they are nearly real.

    Args:
        conics: Pencils (d = 2) of S sets.
        radius: R, shape (S, 1), m.

    Returns:
        Conics q0, ..., q5, shape (S, 6, 6), and for each whether it is a root off the real ones by
        no more than rounding may be, shape (S, 6). Those that are not are no conics through the targets
        of such arms, only the nearest real ones.
    """
    basis, roots = conics.basis, _roots(conics, conics.basis, radius)
    for _ in range(_ROUNDS - 1):
        basis = _spread(basis, roots)
        roots = _roots(conics, basis, radius)
    log_modulus = np.log(np.maximum(np.abs(roots), np.finfo(np.float64).tiny))
    return _members(basis, 0.5 * np.angle(roots)), np.abs(log_modulus) < _NEARLY_REAL


def _members(basis: FloatArray, angles: FloatArray) -> FloatArray:
    """Return members of pencils, shape (S, k, 6), at angles phi, shape (S, k) or (k,), rad."""
    first, second = basis[:, None, 0], basis[:, None, 1]
    return np.asarray(np.cos(angles)[..., None] * first + np.sin(angles)[..., None] * second)


def _roots(conics: Conics, basis: FloatArray, radius: FloatArray) -> ComplexArray:
    """Return the roots w of the sextic, shape (S, 6), as eigenvalues."""
    spectrum = np.fft.fft(conics.radius_defect(_members(basis, _NODES), radius))
    # The frequencies are -3, ..., 3 in 2 phi; times w^3 they are the coefficients of w^0, ..., w^6.
    polynomial = np.roll(spectrum, _DEGREE // 2, axis=-1)
    # The first and the last are conjugate. Both vanish if a root is 0 and its conjugate is infinite.
    leading = polynomial[:, -1:]
    floor = 1e-14 * np.max(np.abs(polynomial), axis=-1, keepdims=True) + np.finfo(np.float64).tiny
    leading = np.where(np.abs(leading) < floor, floor, leading)
    companion = np.zeros((len(basis), _DEGREE, _DEGREE), dtype=np.complex128)
    companion[:, 1:, :-1] = np.eye(_DEGREE - 1)
    companion[:, :, -1] = -polynomial[:, :-1] / leading
    return np.asarray(np.linalg.eigvals(companion))


def _spread(basis: FloatArray, roots: ComplexArray) -> FloatArray:
    """Return a basis of the same pencils in which the roots lie more evenly about the circle.

    The circle is mapped onto itself by w = (w' + c) / (1 + conj(c) w'), c the mean of the roots once
    projected onto it, so that what is at c comes to the centre. On (cos(phi), sin(phi)) that is the
    linear map 1 + [[Re c, Im c], [Im c, -Re c]].
    """
    # Short of the circle itself, where the map would be singular.
    c = 0.999 * np.mean(np.exp(1j * np.angle(roots)), axis=-1)[:, None]
    first, second = basis[:, 0], basis[:, 1]
    spread = [(1.0 + c.real) * first + c.imag * second, c.imag * first + (1.0 - c.real) * second]
    return np.asarray(np.stack(spread, axis=1) / np.sqrt(1.0 - np.abs(c) ** 2)[..., None])
