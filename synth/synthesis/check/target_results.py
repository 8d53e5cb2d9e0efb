"""What becomes of each target in a shape."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen, frozen_value
from synth.synthesis.check.approaches import points_elsewhere
from synth.synthesis.check.clearances import clear_of_everything

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.robot import Arm
    from synth.synthesis.check.verification import Verification
    from synth.task import Approach, Task


@frozen_value
class TargetResult:
    """What becomes of one target. Positions in the task frame, m.

    Attributes:
        name: The target's name.
        position: Where it is, shape (3,).
        tolerance: Largest miss that counts as reached, m.
        reached: Where the end effector gets to, shape (3,).
        miss: Distance between the two, m; infinite where there is no shape.
        within_tolerance: Whether the target is reached.
        approach: In which direction the rigid link is to point there; None if that is all one.
        astray: By how much the rigid link points elsewhere than asked, rad; NaN if no direction is asked for.
        clearance: How far the arm at least keeps from the obstacles there, m; at most 0.1 m is reported, and
            infinite without obstacles.
        joints: Joint angles (theta1, theta2), rad.
        alternatives: Other joint angles that reach it within its tolerance, shape (k, 2), rad, as clear of
            everything.
    """

    name: str
    position: FloatArray
    tolerance: float
    reached: FloatArray
    miss: float
    within_tolerance: bool
    approach: Approach | None
    astray: float
    clearance: float
    joints: FloatArray
    alternatives: FloatArray


def joints_reaching(
    task: Task, arm: Arm, check: Verification, chosen: NDArray[np.intp] | None = None
) -> list[FloatArray]:
    """Return for each target all joint angles at which it is reached, clear of everything, the best first.

    Args:
        task: The task.
        arm: The robot in the shape.
        check: What it does for the task.
        chosen: Indices of the targets that are asked for; by default all of them.

    Returns:
        Pairs (theta1, theta2), shape (k, 2), rad; the closest alone where the target is missed.
    """
    chosen = np.arange(len(task.targets)) if chosen is None else chosen
    best = check.joints[chosen]
    branches = arm.inverse_kinematics(task.table.positions[chosen])
    other = np.abs(branches.joints - best[:, None]).max(axis=-1) > 1e-3
    other &= branches.miss <= task.tolerances[chosen, None]
    other &= np.array(check.within_tolerance)[chosen, None]
    every_branch = np.moveaxis(branches.joints, -2, 0)
    other &= ~points_elsewhere(task, arm, every_branch, chosen).T
    other[other] = clear_of_everything(task, arm, branches.joints[other])
    return [np.vstack([joints, branches.joints[index][other[index]]]) for index, joints in enumerate(best)]


def target_results(
    task: Task, arm: Arm, check: Verification, chosen: NDArray[np.intp] | None = None
) -> tuple[TargetResult, ...]:
    """Return what becomes of each target of a task in one shape, or of those chosen by their indices."""
    chosen = np.arange(len(task.targets)) if chosen is None else chosen
    joints = joints_reaching(task, arm, check, chosen)
    return tuple(
        TargetResult(
            name=task.table.names[index],
            position=task.table.positions[index],
            tolerance=float(task.tolerances[index]),
            reached=frozen(check.reached[index]),
            miss=float(check.misses[index]),
            within_tolerance=check.within_tolerance[index],
            approach=task.targets[index].approach,
            astray=float(check.astray[index]),
            clearance=float(check.clearances[index]),
            joints=frozen(joints[row][0]),
            alternatives=frozen(joints[row][1:]),
        )
        for row, index in enumerate(chosen.tolist())
    )


def worst_targets(task: Task, check: Verification, most: int) -> NDArray[np.intp]:
    """Return the indices of the targets that are missed most in a shape, by their tolerances, worst first.

    Args:
        task: The task.
        check: What it does for the task.
        most: How many at most.
    """
    return np.argsort(-check.misses / task.tolerances, kind="stable")[:most]
