"""Denavit-Hartenberg parameters of an arm, in the standard (distal) convention.

Each joint turns about the z axis of the frame before it: T_i = Rz(theta_i) Tz(d_i) Tx(a_i) Rx(alpha_i), with
theta_1 = joint1 + offset_1 and theta_2 = joint2 + offset_2. T_1 T_2 leads from the base frame to P5: z0 is
axis 1, z1 axis 2 from P3 to P4, and x1 the common normal of the two.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from synth.robot import Arm

_PARALLEL, _TOGETHER = 1e-8, 1e-12


def dh_parameters(arm: Arm) -> dict[str, object]:
    """Return the parameters of both joints, m and rad, as plain data.

    Args:
        arm: The arm.
    """
    (ux, uy, _), centre, invariants = arm.circle.axis, arm.circle.centre, arm.invariants
    foot = centre - invariants.h * arm.circle.axis  # of the common normal, on axis 2
    if math.hypot(ux, uy) < _PARALLEL:
        normal = math.atan2(foot[1], foot[0]) if invariants.a > _TOGETHER else 0.0
        alpha = invariants.alpha
    else:
        # x1 is along z0 x z1, or against it, whichever points from axis 1 to axis 2.
        sign = 1.0 if foot[0] * -uy + foot[1] * ux >= 0.0 else -1.0
        normal, alpha = math.atan2(sign * ux, sign * -uy), sign * invariants.alpha
    x1 = np.array([math.cos(normal), math.sin(normal), 0.0])
    y1 = np.cross(arm.circle.axis, x1)
    frame = arm.end_frame[0]
    # At joint 2 = 0 P5 is at the centre of its circle less R t.
    second = math.atan2(-float(frame[:, 2] @ y1), -float(frame[:, 2] @ x1))
    joints = [
        {"joint": "joint1", "offset": normal, "d": invariants.z0, "a": invariants.a, "alpha": alpha},
        {"joint": "joint2", "offset": second, "d": invariants.h, "a": invariants.R, "alpha": 0.0},
    ]
    base = {key: getattr(arm.base, key) for key in ("yaw", "pitch", "roll")}
    base["position"] = arm.base.position.tolist()
    return {
        "convention": "standard Denavit-Hartenberg (distal)",
        "transform": "Rz(joint + offset) Tz(d) Tx(a) Rx(alpha), twice: from the base frame to P5",
        "base": base,
        "joints": joints,
    }
