"""Between a shape and the values of the unknowns, in the order of the table in `program`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from synth.robot import Arm, LinkShape
from synth.task import Objective

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from synth.arrays import FloatArray
    from synth.task import Task


def pack(task: Task, arm: Arm, joints: FloatArray, overlaps: int, weights: FloatArray) -> FloatArray:
    """Return the values of the unknowns for a shape.

    Args:
        task: The task.
        arm: The robot in that shape, of equal arcs.
        joints: Its joint angles for each target, shape (n, 2), rad.
        overlaps: How many overlaps are among the unknowns; they start from zero.
        weights: Of the squared misses in the objective, shape (n,), 1/m^2.
    """
    radius = task.robot.link.min_bend_radius
    misses = arm.base.to_base(arm.forward_kinematics(joints[:, 0], joints[:, 1])) - task.positions
    squared = arm.squared_distances
    parts: list[ArrayLike] = [
        (arm.shape.curvatures * radius).ravel(),
        [arm.shape.length],
        squared[[0, 0, 1, 1], [2, 3, 2, 3]],
        [] if task.robot.rigid_link.is_fixed else _free_rigid_link(arm),
        joints.T.ravel(),
        misses.T.ravel(),
        np.zeros(overlaps),
    ]
    if task.objective is Objective.MINIMAX:
        parts.append([np.max(weights * np.sum(misses**2, axis=1))])
    return np.concatenate([np.asarray(part, dtype=np.float64) for part in parts])


def _free_rigid_link(arm: Arm) -> list[float]:
    """Return the unknowns of a free rigid link: s35, s45, and the circle of P5."""
    offset, radius = arm.robot.end_effector_circle(arm.d35, arm.d45)
    return [arm.d35**2, arm.d45**2, float(offset) + arm.robot.tip_offset, float(radius)]


def unpack(task: Task, values: FloatArray, arcs: int) -> tuple[Arm, FloatArray]:
    """Return the shape that values of the unknowns describe, rounded into the bounds of the hardware.

    Args:
        task: The task.
        values: Values of the unknowns.
        arcs: Number m of equal arcs of the link.

    Returns:
        The robot in that shape, and its joint angles for each target, shape (n, 2), rad.
    """
    robot, rigid = task.robot, task.robot.rigid_link
    curvature, rest = values[: 2 * arcs].reshape(arcs, 2), values[2 * arcs :]
    # The solver may overstep a bound by its own tolerance, 1e-8.
    curvature = curvature / np.maximum(1.0, np.linalg.norm(curvature, axis=1))[:, None]
    length = float(np.clip(rest[0], robot.link.length.lower, robot.link.length.upper))
    shape = LinkShape(curvature * robot.link.max_curvature, np.full(arcs, length / arcs))
    rest = rest[5:]
    d35, d45 = rigid.d35.lower, rigid.d45.lower
    if not rigid.is_fixed:
        d35 = float(np.clip(math.sqrt(rest[0]), rigid.d35.lower, rigid.d35.upper))
        d45 = float(np.clip(math.sqrt(rest[1]), rigid.d45.lower, rigid.d45.upper))
        rest = rest[4:]
    limits = robot.joint_limits
    joints = rest[: 2 * len(task.targets)].reshape(2, -1).T
    joints = np.clip(
        joints, [limits.base.lower, limits.second.lower], [limits.base.upper, limits.second.upper]
    )
    return Arm(robot, shape, d35, d45, task.base), joints
