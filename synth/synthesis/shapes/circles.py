"""Circles of P5 as they stand to axis 1, whatever they are turned about it: to find shapes near an arm."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from synth.arrays import FloatArray
    from synth.robot import Kinematics

ARM_LENGTH = 0.5  # m; an axis 1 rad off puts P5 about this far off
_ON_AXIS = 1e-12  # m


def circles_of_shapes(kinematics: Kinematics) -> FloatArray:
    """Return rho and z of the centre, axis 2 outward, around and up by ARM_LENGTH, and R, shape (N, 6), m.

    Args:
        kinematics: The joints of the shapes, of shape (N,).
    """
    centre, axis = kinematics.centre, kinematics.frame[..., 0]
    rho = np.hypot(centre[..., 0], centre[..., 1])
    outward = centre[..., :2] / np.maximum(rho, _ON_AXIS)[..., None]
    radial = np.einsum("...i,...i", axis[..., :2], outward)
    around = outward[..., 0] * axis[..., 1] - outward[..., 1] * axis[..., 0]
    direction = ARM_LENGTH * np.stack([radial, around, axis[..., 2]], axis=-1)
    numbers = [rho[..., None], centre[..., 2:], direction, kinematics.radius[..., None]]
    return np.concatenate(numbers, axis=-1)


def circles_of_designs(designs: FloatArray) -> FloatArray:
    """Return the same of designs, each in its four forms, shape (4 k, 6), m.

    A design leaves open which of two mirror images it is, and which way axis 2 points.

    Args:
        designs: a, alpha, z0, h, R, shape (k, 5), m and rad.
    """
    a, alpha, z0, h, radius = designs.T
    sine, along = np.sin(alpha), h * np.sin(alpha)
    rho = np.hypot(a, along)
    safe = np.maximum(rho, _ON_AXIS)
    radial, around, up = sine * np.where(rho > _ON_AXIS, along / safe, 1.0), sine * a / safe, np.cos(alpha)
    height = z0 + h * np.cos(alpha)
    forms = [
        np.column_stack(
            [
                rho,
                height,
                *(sense * ARM_LENGTH * each for each in (radial, chirality * around, up)),
                radius,
            ]
        )
        for sense, chirality in product((1.0, -1.0), (1.0, -1.0))
    ]
    return np.concatenate(forms)
