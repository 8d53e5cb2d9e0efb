"""A calibrated arm as plain data of the schema `synth.calibration/1`, in metres and radians, base frame."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from synth.export.json_data import plain
from synth.geometry import squared_distances
from synth.guide import swept_targets
from synth.version import __version__

if TYPE_CHECKING:
    from synth.measurement import Calibration
    from synth.task import Task

SCHEMA = "synth.calibration/1"


def calibration_to_json(calibration: Calibration, task: Task) -> dict[str, Any]:
    """Return a calibration as plain data.

    Args:
        calibration: The calibration, refused or not.
        task: What is asked of the arm.

    Returns:
        Dictionaries, lists, strings, numbers and None, for `json.dumps`. Joint angles are None
        where the sweep had none: their zeros are not known then.
    """
    arm, robot = calibration.arm, task.robot
    p3 = arm.end - robot.tip_offset * arm.axis
    p4 = p3 + robot.d34 * arm.axis
    between = np.sqrt(squared_distances(np.vstack([[0.0, 0.0, 0.0], [0.0, 0.0, robot.d12], p3, p4])))
    from_p3 = float(arm.offset) + robot.tip_offset
    content: dict[str, object] = {
        "schema": SCHEMA,
        "version": __version__,
        "accepted": not calibration.refusal,
        "message": calibration.refusal or "the sweep determines the surface",
        "distances": {
            **{f"{i + 1}{j + 1}": between[i, j] for i in range(4) for j in range(i + 1, 4)},
            "35": float(np.hypot(from_p3, arm.radius)),
            "45": float(np.hypot(robot.d34 - from_p3, arm.radius)),
        },
        "invariants": asdict(calibration.invariants),
        "covariance": calibration.invariants_covariance,
        "surface_rms": calibration.surface_rms,
        "plausibility": calibration.plausibility,
        "axis2": {"point": arm.end, "direction": arm.axis},
        "points_used": int(calibration.used.sum()),
        "outliers": np.flatnonzero(~calibration.used),
        "joints_known": calibration.joints_known,
        "targets": [] if calibration.refusal else swept_targets(calibration, task),
    }
    return plain(content)
