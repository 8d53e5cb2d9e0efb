"""Why a path is not followed, as far as that is known."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from synth.robot import Interval, JointLimits
from synth.rounding import counted

if TYPE_CHECKING:
    from synth.arrays import FloatArray
    from synth.synthesis.wanted import Design
    from synth.task import Task

_FREE = JointLimits(Interval(-math.pi, math.pi), Interval(-math.pi, math.pi))
_BEYOND = 1e-3  # rad


def beyond_joint_limits(task: Task, design: Design) -> tuple[str, ...]:
    """Return a sentence for each path that a shape would be on all along if its joints turned farther.

    Args:
        task: The task.
        design: The nearest shape found.
    """
    arm, check = design.arm, design.verification
    free = replace(arm, robot=replace(arm.robot, joint_limits=_FREE))
    limits, told = arm.robot.joint_limits, []
    for number, path in enumerate(task.paths):
        missed = np.flatnonzero((task.path_of_targets == number) & ~np.array(check.within_tolerance))
        points = task.table.positions[missed]
        joints, misses = free.closest_joints(points)
        if not len(missed) or np.any(misses > path.tolerance):
            continue
        beyond = [
            bool(np.any(_beyond(angles, limit) > _BEYOND))
            for angles, limit in zip(joints.T, (limits.base, limits.second), strict=True)
        ]
        if any(beyond):
            blocking = " and ".join(f"joint {index + 1}" for index in np.flatnonzero(beyond))
            told.append(
                f"{path.name}: {counted(len(missed), 'point')} of it would be reached, too, if {blocking} "
                "turned farther than its limits allow: they leave a dead zone, which it crosses"
            )
    return tuple(told)


def _beyond(angles: FloatArray, limit: Interval) -> FloatArray:
    """Return by how much angles, a turn more or less being all one, are beyond limits, shape (n,), rad."""
    turned = angles[:, None] + 2.0 * math.pi * np.arange(-2, 3)
    return np.asarray(np.maximum(np.maximum(limit.lower - turned, turned - limit.upper), 0.0).min(axis=1))
