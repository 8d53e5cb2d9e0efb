"""`synth check`: the link as it stands, from markers: lock it, correct it, or leave it at that."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import numpy as np

from synth.cli.exit_codes import ExitCode
from synth.cli.say import say
from synth.export import check_to_json, json_bytes, refusal_to_json, write_all
from synth.guide import (
    Verdict,
    best_settings,
    check_arm,
    check_text,
    hold_posture,
)
from synth.measurement import (
    Deed,
    StandingArm,
    aim_of_check,
    examine_file,
    hand_error,
    load_hand,
    sigma_of,
)
from synth.solution_file import load_solved

if TYPE_CHECKING:
    from pathlib import Path

    from synth.arrays import FloatArray
    from synth.measurement import ArmFit, HandError


def check_file(
    measured: Path,
    solution: Path,
    output: Path | None,
    *,
    as_json: bool,
    corrections: int,
    marker_error: float,
    base_calibrated: bool,
    confidence: float,
    stiff: bool,
    settings_within: float,
    after: Path | None,
    hand: Path | None,
    markers: str,
) -> ExitCode:
    """Check a file of markers against a solution and say what to do.

    Args:
        measured: The file of markers.
        solution: The file of the solution.
        output: Directory for `check.json`, or None.
        as_json: Whether JSON is printed, and nothing else.
        corrections: How many corrections the operator is still willing to make.
        marker_error: Mean 3D error of a marker, m.
        base_calibrated: Whether axis 1 is the z axis of the frame, found by turning joint 1.
        confidence: Chance that all targets are within tolerance from which on the link is locked.
        stiff: Whether the link was stiff already when it was measured.
        settings_within: How far base and tool can be set after locking, m; 0: not at all.
        after: The file of the check before, whose correction was carried out, or after which the link was
            stiffened; None if the link was just placed.
        hand: The file of the hand that bends it; None: as published.
        markers: Names of the markers that the arm bears, where the file does not say which is which.

    Returns:
        The exit code.
    """
    found = load_solved(solution)
    task, designs, arm = found.task, found.designs, found.robot
    joint1 = hold_posture(task, arm).joint1
    before = None if after is None else aim_of_check(after)
    bent_by = None if hand is None else load_hand(hand)
    wanted, sigma = StandingArm.of(arm, joint1), sigma_of(marker_error)
    examination = examine_file(
        measured, task.robot, wanted, sigma, base_calibrated=base_calibrated, markers=markers
    )
    if examination.fit is None:
        content, text = refusal_to_json(examination), f"{measured}: {examination.refusal}"
        code = ExitCode.WRONG_INPUT
    else:
        fit = examination.fit
        check = check_arm(
            task, designs, fit, corrections=corrections, confidence=confidence, stiff=stiff, hand=bent_by
        )
        told = _told_of_hand(fit, wanted, before, stiff=stiff)
        settings = (
            best_settings(task, task.robot, fit, check.now.joints, base=settings_within, tool=settings_within)
            if settings_within > 0.0
            else None
        )
        content = check_to_json(check, examination, settings, told)
        text = check_text(check, settings, examination.rejected)
        code = ExitCode.DONE if check.verdict is Verdict.LOCK else ExitCode.NOT_MET
    for warning in examination.used.warnings:
        say(warning, on_stderr=True)
    for path in [] if output is None else write_all({"check.json": json_bytes(content)}, output):
        say(f"wrote {path}", on_stderr=True)
    if as_json:
        say(json.dumps(content, indent=2, allow_nan=False))
    else:
        say(text, on_stderr=code is ExitCode.WRONG_INPUT)
    return code


def _told_of_hand(
    fit: ArmFit,
    wanted: StandingArm,
    before: tuple[FloatArray, FloatArray, FloatArray] | None,
    *,
    stiff: bool,
) -> HandError | None:
    """Return what an arm tells of the hand, by where the check before wanted it, or else the solution."""
    if not fit.shows_axes:
        return None
    if before is None:
        return None if stiff else hand_error(fit, Deed.PLACED, wanted.end, wanted.axis, np.zeros(6))
    end, axis, asked = before
    deed = Deed.CORRECTED if asked.any() else Deed.STIFFENED
    return hand_error(fit, deed, end, axis, asked)
