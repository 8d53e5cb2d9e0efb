"""`synth check`: the link as it stands, from markers: lock it, correct it, or leave it at that."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from synth.cli.exit_codes import ExitCode
from synth.cli.say import say
from synth.export import check_to_json, json_bytes, refusal_to_json, write_all
from synth.guide import Verdict, best_settings, check_arm, check_text, hold_posture
from synth.measurement import StandingArm, examine, load_readings, sigma_of
from synth.solution_file import load_solved

if TYPE_CHECKING:
    from pathlib import Path


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

    Returns:
        The exit code.
    """
    found = load_solved(solution)
    task, designs, arm = found.task, found.designs, found.robot
    joint1 = hold_posture(task, arm).joint1
    readings = load_readings(measured, task.robot, joint1)
    wanted = StandingArm.of(arm, joint1)
    examination = examine(
        readings, wanted, task.robot, sigma_of(marker_error), base_calibrated=base_calibrated
    )
    if examination.fit is None:
        content, text = refusal_to_json(examination), f"{measured}: {examination.refusal}"
        code = ExitCode.WRONG_INPUT
    else:
        fit = examination.fit
        check = check_arm(task, designs, fit, corrections=corrections, confidence=confidence, stiff=stiff)
        settings = (
            best_settings(task, task.robot, fit, check.now.joints, base=settings_within, tool=settings_within)
            if settings_within > 0.0
            else None
        )
        content = check_to_json(check, examination, settings)
        text = check_text(check, settings, examination.rejected)
        code = ExitCode.DONE if check.verdict is Verdict.LOCK else ExitCode.NOT_MET
    for warning in readings.warnings:
        say(warning, on_stderr=True)
    for path in [] if output is None else write_all({"check.json": json_bytes(content)}, output):
        say(f"wrote {path}", on_stderr=True)
    if as_json:
        say(json.dumps(content, indent=2, allow_nan=False))
    else:
        say(text, on_stderr=code is ExitCode.WRONG_INPUT)
    return code
