"""Between a shape and the values of the unknowns, by their names in the table in `program`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from synth.robot import Arm, LinkShape

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike

    from synth.arrays import FloatArray
    from synth.task import Task


def packed(
    task: Task, arm: Arm, joints: FloatArray, overlaps: int, weights: FloatArray
) -> dict[str, ArrayLike]:
    """Return the values of the unknowns for a shape, also of those that a program may not have.

    Args:
        task: The task.
        arm: The robot in that shape, of equal arcs.
        joints: Its joint angles for each target, shape (n, 2), rad.
        overlaps: How many overlaps are among the unknowns; they start from zero.
        weights: Of the squared misses in the objective, shape (n,), 1/m^2.
    """
    misses = arm.base.to_base(arm.forward_kinematics(joints[:, 0], joints[:, 1])) - task.positions_in_base
    offset, radius = arm.robot.end_effector_circle(arm.d35, arm.d45)
    return {
        "curvature": (arm.shape.curvatures * task.robot.link.min_bend_radius).T,
        "length": arm.shape.length,
        "s": arm.squared_distances[[0, 0, 1, 1], [2, 3, 2, 3]],
        "s35": arm.d35**2,
        "s45": arm.d45**2,
        "from_p3": offset + arm.robot.tip_offset,
        "radius": radius,
        "theta1": joints[:, 0],
        "theta2": joints[:, 1],
        "miss": misses,
        "overlap": np.zeros(overlaps),
        "astray": np.zeros(len(joints) if task.approaches_in_base is not None else 0),
        "worst": np.max(weights * np.sum(misses**2, axis=1)),
    }


def unpacked(task: Task, values: Mapping[str, FloatArray]) -> tuple[Arm, FloatArray]:
    """Return the shape that values of the unknowns describe, rounded into the bounds of the hardware.

    Args:
        task: The task.
        values: Values of the unknowns by their names, in their shapes.

    Returns:
        The robot in that shape, and its joint angles for each target, shape (n, 2), rad.
    """
    robot, rigid, limits = task.robot, task.robot.rigid_link, task.robot.joint_limits
    curvature = values["curvature"].T
    # The solver may overstep a bound by its own tolerance, 1e-8.
    curvature = curvature / np.maximum(1.0, np.linalg.norm(curvature, axis=1))[:, None]
    length = robot.link.length.nearest(values["length"].item())
    shape = LinkShape(curvature * robot.link.max_curvature, np.full(len(curvature), length / len(curvature)))
    d35, d45 = rigid.d35.lower, rigid.d45.lower
    if not rigid.is_fixed:
        d35 = rigid.d35.nearest(math.sqrt(values["s35"].item()))
        d45 = rigid.d45.nearest(math.sqrt(values["s45"].item()))
    joints = np.clip(
        np.hstack([values["theta1"], values["theta2"]]),
        [limits.base.lower, limits.second.lower],
        [limits.base.upper, limits.second.upper],
    )
    return Arm(robot, shape, d35, d45, task.base), joints
