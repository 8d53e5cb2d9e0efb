"""The check of a link as plain data of the schema `synth.check/1`, in metres and radians, base frame."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from synth.export.hand_json import hand_error_to_json
from synth.export.json_data import plain
from synth.guide import Verdict, correction_sentence, headline_sentence
from synth.measurement import CHECK_SCHEMA
from synth.version import __version__

if TYPE_CHECKING:
    from synth.guide import Check, Correction, Settings
    from synth.measurement import Examination, HandError


def refusal_to_json(examination: Examination) -> dict[str, Any]:
    """Return readings that are not believed as plain data."""
    return plain(
        {
            "schema": CHECK_SCHEMA,
            "version": __version__,
            "status": Verdict.UNUSABLE.value,
            "message": examination.refusal,
            "lock": False,
            "probability_all_within": None,
            "measured": {"rejected": _rejected(examination)},
            "targets": [],
            "correction": None,
            "settings": None,
            "hand": None,
        }
    )


def check_to_json(
    check: Check, examination: Examination, settings: Settings | None, hand: HandError | None = None
) -> dict[str, Any]:
    """Return a check as plain data.

    Args:
        check: The check.
        examination: What it stands on.
        settings: What to set after locking, or None.
        hand: What it tells of the hand, or None.

    Returns:
        Dictionaries, lists, strings, numbers and None, for `json.dumps(..., allow_nan=False)`.
    """
    fit, now = check.fit, check.now
    zero = np.cross(fit.arm.frame[:, 0], fit.arm.frame[:, 2])
    content = {
        "schema": CHECK_SCHEMA,
        "version": __version__,
        "status": check.verdict.value,
        "message": headline_sentence(check),
        "lock": check.verdict is Verdict.LOCK,
        "probability_all_within": now.probability_all_within,
        "probability_after_stiffening": check.stiffened.probability_all_within,
        "confidence": check.confidence,
        "measured": {
            "joint1": fit.arm.joint1,
            "axis1": {"point": fit.arm.point, "direction": fit.arm.direction},
            "axis2": {
                "point": fit.arm.end,
                "direction": fit.arm.axis,
                "point_sigma": fit.point_sigma,
                "direction_sigma": fit.direction_sigma,
            },
            # The link's direction t at its end: with joint 2 at pi the rigid link goes on along it.
            "joint2_zero": {"straight_on": fit.arm.frame[:, 2], "across": -zero, "sigma": fit.roll_sigma},
            "residual": float(np.sqrt(np.mean(np.sum(fit.residuals**2, axis=1)))),
            "markers_used": list(dict.fromkeys(examination.used.names)),
            "rejected": _rejected(examination),
        },
        "targets": [
            {
                "name": target.name,
                "tolerance": target.tolerance,
                "joints": joints,
                "expected_miss": expected,
                "miss_95": most,
                "probability_within": chance,
            }
            for target, joints, expected, most, chance in zip(
                check.task.targets, now.joints, now.expected, now.miss_95, now.probability_within, strict=True
            )
        ],
        "expected_worst_miss": now.expected_worst,
        "correction": None if check.correction is None else _correction(check, check.correction),
        "settings": None if settings is None else _settings(settings),
        "hand": None if hand is None else hand_error_to_json(hand),
    }
    return plain(content)


def _rejected(examination: Examination) -> list[dict[str, str]]:
    return [{"marker": name, "why": why} for name, why in examination.rejected]


def _correction(check: Check, correction: Correction) -> dict[str, object]:
    aim, robot = correction.aim, check.task.robot
    p3 = aim.end - robot.tip_offset * aim.axis
    # P5 with joint 2 straight on, and joint 1 where it stands now.
    p5 = aim.forward(np.array([[aim.joint1, np.pi]]))[0]
    shape = correction.shape
    return {
        "move": correction.move,
        "rotate": correction.rotate,
        "free": ["turn about axis 1", "roll about axis 2"],
        "markers": {"P3": p3, "P4": p3 + robot.d34 * aim.axis, "P5": p5},
        "expected_worst_miss": correction.outlook.expected_worst,
        "words": correction_sentence(correction, check.fit),
        "solution": None
        if shape is None
        else {
            "arcs": [
                {"curvature": k, "length": length}
                for k, length in zip(shape.curvatures, shape.lengths, strict=True)
            ]
        },
    }


def _settings(settings: Settings) -> dict[str, object]:
    return {
        "base": {"move": settings.base},
        "rigid_link": {
            "along_axis2": settings.along,
            "radius": settings.radius,
            "d35": settings.d35,
            "d45": settings.d45,
        },
        "joints": settings.outlook.joints,
        "expected_worst_miss": settings.outlook.expected_worst,
    }
