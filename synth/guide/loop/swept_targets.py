"""What a calibrated arm makes of the targets."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import frozen_value
from synth.guide.loop.outlook import Outlook
from synth.measurement import joints_closest_to, joints_following

if TYPE_CHECKING:
    from synth.arrays import FloatArray
    from synth.measurement import Calibration
    from synth.task import Task

_SAMPLES = 1000


@frozen_value
class SweptTarget:
    """What becomes of a target on the calibrated arm.

    Attributes:
        name: Its name.
        tolerance: Largest miss that counts as reached, m.
        joints: The best joint angles (theta1, theta2), rad; None where the sweep does not show their zeros.
        expected_miss: Its miss on average, m. With unknown zeros that is with joints guided to the least
            miss.
        miss_95: What the miss exceeds once in twenty, m.
        probability_within: Chance that it is within its tolerance.
    """

    name: str
    tolerance: float
    joints: FloatArray | None
    expected_miss: float
    miss_95: float
    probability_within: float


def swept_targets(calibration: Calibration, task: Task) -> list[SweptTarget]:
    """Return what becomes of each target of a task on a calibrated arm."""
    joints = joints_closest_to(calibration.arm, task.positions_in_base)
    arms = calibration.samples(_SAMPLES)
    there = np.broadcast_to(joints, (_SAMPLES, *joints.shape))
    if not calibration.joints_known:
        there = joints_following(arms, there, task.positions_in_base)
    misses = np.linalg.norm(arms.forward(there) - task.positions_in_base, axis=-1)
    outlook = Outlook(joints, misses, task.tolerances)
    return [
        SweptTarget(
            target.name,
            target.tolerance,
            joints[k] if calibration.joints_known else None,
            float(outlook.expected[k]),
            float(outlook.miss_95[k]),
            float(outlook.probability_within[k]),
        )
        for k, target in enumerate(task.targets)
    ]
