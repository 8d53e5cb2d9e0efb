"""The other arm with the same workspace surface."""

from __future__ import annotations

import math
from dataclasses import astuple

from synth.geometry.invariants import Invariants


def cognate(design: Invariants) -> Invariants:
    """Return the other arm with the same workspace surface: there is always exactly one.

    Seen along axis 1, the circle is an ellipse whose foci are f = R sin(alpha) away from its centre, along
    the common normal. With d+ and d- the distances of the foci from axis 1, the cognate has

        R' = (d+ + d-) / 2,  a' = a R / R',  sin(alpha') = f / R',  z0' = z0,  h' cos(alpha') = h cos(alpha),

    and the cognate of the cognate is the arm itself. Parallel axes swap a and R, and axes that meet the
    angles of axis 2 to axis 1 and to P5. R' is half the major axis of the confocal ellipse through axis 1:
    the two arms are one where the circle meets axis 1, and near there targets determine them badly.

    Returns:
        The representative with alpha' <= pi/2, and h' >= 0 where h cos(alpha) = 0.

    Source: derived here, by a second root of the cubic in `conics`; tested as a law.
    """
    a, alpha, z0, h, radius = astuple(design)
    sine, cosine = math.sin(alpha), math.cos(alpha)
    f, y = radius * sine, h * sine
    d_plus, d_minus = math.hypot(a + f, y), math.hypot(a - f, y)
    major = 0.5 * (d_plus + d_minus)
    if major == 0.0:  # Axes that coincide, a = 0, or a point on axis 1.
        return Invariants(radius if sine == 0.0 else 0.0, 0.0, z0, h, 0.0)
    # R'^2 - f^2, the squared half minor axis, and R'^2 - a^2: then h' = cot(alpha) sqrt(R'^2 - a^2).
    product = d_plus * d_minus
    minor2 = _half_sum(a**2 + y**2 - f**2, product, (f * y) ** 2)
    excess2 = _half_sum(y**2 + f**2 - a**2, product, (a * y) ** 2)
    # It is 0 where h = 0 and where the axes are parallel; in both cases h' = h cos(alpha) up to its sign.
    offset = abs(cosine) * math.sqrt(excess2) / sine if excess2 > 0.0 else abs(h * cosine)
    return Invariants(
        a=a * radius / major,
        alpha=math.atan2(f, math.sqrt(minor2)),
        z0=z0,
        h=-offset if h * cosine < 0.0 else offset,
        R=major,
    )


def _half_sum(term: float, root: float, product: float) -> float:
    """Return (term + root) / 2 with root^2 = term^2 + 4 product, without cancellation."""
    return 0.5 * (term + root) if term >= 0.0 else 2.0 * product / (root - term)
