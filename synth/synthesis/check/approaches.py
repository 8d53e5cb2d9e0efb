"""In which direction the rigid link points as it arrives at each target: plain numpy."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from synth.robot import turned

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.robot import Arm
    from synth.task import Task

ANGLE_SLACK = 1e-6  # what rounding may do, rad


def pointing_astray(
    task: Task, arm: Arm, joints: FloatArray, chosen: NDArray[np.intp] | slice = slice(None)
) -> FloatArray:
    """Return the angles between where the rigid link points and where the task asks it to, shape (..., n).

    Args:
        task: The task.
        arm: The robot in a shape.
        joints: Joint angles for each target, shape (..., n, 2), rad.
        chosen: Indices of the targets, if these are not all.

    Returns:
        Angles, rad; NaN where no direction is asked for.
    """
    rows = task.table.approaches
    if rows is None:
        return np.full(joints.shape[:-1], np.nan)
    rotation, _ = arm.end_frame
    sine, cosine = np.sin(joints[..., 1, None]), np.cos(joints[..., 1, None])
    pointing = turned(sine * rotation[:, 1] - cosine * rotation[:, 2], joints[..., 0])
    wanted = rows[chosen, :3] @ arm.base.rotation
    apart = np.linalg.norm(np.cross(pointing, wanted), axis=-1)
    return np.asarray(np.arctan2(apart, np.einsum("...i,...i", pointing, wanted)))


def points_elsewhere(
    task: Task, arm: Arm, joints: FloatArray, chosen: NDArray[np.intp] | slice = slice(None)
) -> NDArray[np.bool_]:
    """Return whether the rigid link points farther beside the direction asked for than it may.

    Args: as for `pointing_astray`.

    Returns:
        Whether, shape (..., n); not where no direction is asked for.
    """
    rows = task.table.approaches
    if rows is None:
        return np.zeros(joints.shape[:-1], dtype=np.bool_)
    return np.asarray(pointing_astray(task, arm, joints, chosen) > rows[chosen, 3] + ANGLE_SLACK)
