"""Whether an arm is clear of everything at joint angles: what a sampling planner asks thousands of times."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from synth.checks import refuse_unless
from synth.robot.arm import Arm
from synth.robot.body import ArmBody
from synth.robot.clearance import clear_of_obstacles, clear_of_tube, tube_clear_of_itself

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from synth.arrays import FloatArray
    from synth.geometry import Solid

_SLACK = 1e-6  # what rounding may do, m
_TOGETHER = 2000  # joint angles that are looked at together


def keeps_clear(
    arm: Arm, joints: ArrayLike, solids: Sequence[Solid] = (), *, floor: float | None = None
) -> NDArray[np.bool_]:
    """Return whether an arm is within its joint limits, and clear of solids, the floor and itself.

    By lower bounds along the whole of link and rod, not at samples: where it says yes, that is certain, up
    to a micrometre; within about 0.02 mm of touching it may say no.

    Args:
        arm: The arm.
        joints: Angles (theta1, theta2), shape (..., 2), rad.
        solids: Solids in the task frame to keep clear of.
        floor: Height in the base frame that link, joint 2 and end effector stay above, m; None for no floor.

    Returns:
        Whether each is, shape (...).
    """
    refuse_unless("arm", arm, Arm)
    given = np.asarray(joints, dtype=np.float64)
    flat = given.reshape(-1, 2)
    body = ArmBody(arm)
    clear = arm.robot.joint_limits.contain(flat)
    if tube_clear_of_itself(body) < -_SLACK or (floor is not None and _tube_is_below(arm, body, floor)):
        clear[:] = False
    if floor is not None:
        clear[clear] = _rod_heights(arm, body, flat[clear, 1]) >= floor - _SLACK
    seen = [solid.seen_from(arm.base.position, arm.base.rotation) for solid in solids]
    left = np.flatnonzero(clear)
    for some in np.split(left, range(_TOGETHER, len(left), _TOGETHER)):
        there = flat[some]
        # A way that ends where it starts is one of which nobody asks how deep it is in something.
        least = clear_of_tube(body, there[:, 1], there[:, 1], enough=0.0)
        if seen:
            from_solids = clear_of_obstacles(body, there, seen, end=there, enough=0.0)
            least = np.minimum(least, from_solids.min(axis=(1, 2)))
        clear[some] = least >= -_SLACK
    return clear.reshape(given.shape[:-1])


def _tube_is_below(arm: Arm, body: ArmBody, floor: float) -> bool:
    lowest = min(body.lowest(), float(arm.axis_points[2:, 2].min()))
    return lowest < floor - _SLACK


def _rod_heights(arm: Arm, body: ArmBody, theta2: FloatArray) -> FloatArray:
    """Return the height of the lowest point of the end effector, shape (n,), m; joint 1 keeps it."""
    return np.asarray(arm.kinematics.forward(0.0, theta2)[..., 2] - body.rod_radius)
