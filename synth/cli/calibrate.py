"""`synth calibrate`: the real arm from positions of its end effector."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING

from synth.cli.exit_codes import ExitCode
from synth.cli.say import say
from synth.export import calibration_to_json
from synth.measurement import StandingArm, calibrate, load_points, sigma_of
from synth.rounding import rounded_up
from synth.sentences import BULLET
from synth.solution_file import load_solved

if TYPE_CHECKING:
    from pathlib import Path


def calibrate_file(
    points: Path, solution: Path, *, as_json: bool, marker_error: float, surface_rms: float, seed: int
) -> ExitCode:
    """Calibrate the arm of a solution by a file of positions.

    Args:
        points: The file of positions.
        solution: The file of the solution.
        as_json: Whether JSON is printed, and nothing else.
        marker_error: Mean 3D error of a position, m.
        surface_rms: How well the surface must be known, root mean square, m.
        seed: Of the starts of the search.

    Returns:
        The exit code.
    """
    solved = load_solved(solution)
    task = solved.task
    positions, joints = load_points(points)
    wanted = StandingArm.of(solved.robot, task.robot.joint_limits.base.middle)
    found = calibrate(positions, joints, wanted, sigma_of(marker_error), most_rms=surface_rms, seed=seed)
    content = calibration_to_json(found, task)
    if as_json:
        say(json.dumps(content, indent=2, allow_nan=False))
    elif found.refusal:
        say(f"{task.name}: {found.refusal}")
    else:
        say(
            f"{task.name}: the surface is known to {rounded_up(found.surface_rms, digits=2)} mm root "
            "mean square, "
            f"from {content['points_used']} points"
        )
        for target in content["targets"]:
            angles = (
                ""
                if target["joints"] is None
                else "joint 1 {:.2f} deg, joint 2 {:.2f} deg; ".format(*map(math.degrees, target["joints"]))
            )
            say(
                f"{BULLET} {target['name']}: {angles}miss below {rounded_up(target['miss_95'], digits=2)} "
                "mm in 19 of 20 cases"
            )
    return ExitCode.NOT_MET if found.refusal else ExitCode.DONE
