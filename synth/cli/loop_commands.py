"""The commands of the loop, and their options; what they do is in the modules of their names."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from collections.abc import Callable

    from synth.cli.exit_codes import ExitCode


# What `synth check` and the live guide ask alike, in the order of the help.
_HOW_TO_CHECK = (
    click.option(
        "--corrections-left", type=click.IntRange(min=0), default=3, show_default=True,
        help="How many corrections you are still willing to make.",
    ),
    click.option(
        "--marker-error", metavar="MM", type=click.FloatRange(0.001, 100.0), default=0.455, show_default=True,
        help="Mean error of a marker in space.",
    ),
    click.option(
        "--base-calibrated", is_flag=True,
        help="Axis 1 is the z axis of the frame, found by turning joint 1; else its markers show it.",
    ),
    click.option(
        "--confidence", type=click.FloatRange(0.5, 0.999), default=0.95, show_default=True,
        help="Chance that all targets are within tolerance from which on to lock.",
    ),
    click.option(
        "--stiff", is_flag=True, help="The link was stiff when it was measured: it will move no more.",
    ),
    click.option(
        "--hand", metavar="HAND", type=click.Path(path_type=Path),
        help="hand.json of who bends the link, by `synth learn`; a hand as published unless told.",
    ),
)  # fmt: skip


def how_to_check(command: Callable[..., None]) -> Callable[..., None]:
    """Give a command the options that say how markers are checked."""
    for option in reversed(_HOW_TO_CHECK):
        command = option(command)
    return command


@click.command()
@click.argument("measured", metavar="MEASURED", type=click.Path(path_type=Path))
@click.argument("solution", metavar="SOLUTION", type=click.Path(path_type=Path))
@click.option(
    "-o", "--output", metavar="DIR", type=click.Path(path_type=Path),
    help="Write check.json into this directory.",
)  # fmt: skip
@click.option("--json", "as_json", is_flag=True, help="Print the check as JSON and nothing else.")
@how_to_check
@click.option(
    "--settings", "settings_within", metavar="MM", type=click.FloatRange(0.0, 1000.0), default=0.0,
    help="Say how to set base and tool after locking, each within so many millimetres.",
)  # fmt: skip
@click.option(
    "--after", metavar="CHECK", type=click.Path(path_type=Path),
    help="check.json of the check before, after which the link was corrected as told, or stiffened.",
)  # fmt: skip
@click.option(
    "--markers", metavar="NAMES", default="",
    help='Markers that the arm bears, such as "P1 P2 P3 P4 P5", where the file does not say which is which.',
)  # fmt: skip
def check(
    measured: Path,
    solution: Path,
    output: Path | None,
    *,
    as_json: bool,
    corrections_left: int,
    marker_error: float,
    base_calibrated: bool,
    confidence: float,
    stiff: bool,
    settings_within: float,
    after: Path | None,
    hand: Path | None,
    markers: str,
) -> None:
    """Say what to do with the link as it stands: lock it, correct it, or leave it at that.

    MEASURED holds markers in the base frame, marker,x_mm,y_mm,z_mm, or is a recording of the arm at rest:
    Motive CSV, TRC, QTM TSV, C3D or a ROS 2 bag. SOLUTION is the solution.json of the task.

    \b
    Exit codes:
      0  lock
      1  do not lock: correct it as told, or there is nothing to gain
      2  the measurement is not believed, or wrong input
    """
    from synth.cli.session import Session, run

    def command(_session: Session) -> ExitCode:
        from synth.cli.check import check_file

        return check_file(
            measured, solution, output,
            as_json=as_json, corrections=corrections_left, marker_error=marker_error / 1000.0,
            base_calibrated=base_calibrated, confidence=confidence, stiff=stiff,
            settings_within=settings_within / 1000.0, after=after, hand=hand, markers=markers,
        )  # fmt: skip

    sys.exit(run(command, math.inf))


@click.command()
@click.argument("points", metavar="POINTS", type=click.Path(path_type=Path))
@click.argument("solution", metavar="SOLUTION", type=click.Path(path_type=Path))
@click.option("--json", "as_json", is_flag=True, help="Print the calibration as JSON and nothing else.")
@click.option(
    "--marker-error", metavar="MM", type=click.FloatRange(0.001, 100.0), default=0.455, show_default=True,
    help="Mean error of a point in space.",
)  # fmt: skip
@click.option(
    "--surface-rms", metavar="MM", type=click.FloatRange(0.001, 100.0), default=0.3, show_default=True,
    help="How well the surface must be known, root mean square.",
)  # fmt: skip
@click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True, help="Seed of the starts.")
def calibrate(
    points: Path, solution: Path, *, as_json: bool, marker_error: float, surface_rms: float, seed: int
) -> None:
    """Find the real arm from points of its end effector, after the link was stiffened.

    POINTS holds x_mm,y_mm,z_mm in the base frame and, if they are known, joint1_deg,joint2_deg; SOLUTION is
    the solution.json of the task.

    \b
    Exit codes:
      0  the surface is known as well as asked
      1  the points do not determine it, or fit no arm
      2  wrong input
    """
    from synth.cli.session import Session, run

    def command(_session: Session) -> ExitCode:
        from synth.cli.calibrate import calibrate_file

        return calibrate_file(
            points, solution,
            as_json=as_json, marker_error=marker_error / 1000.0, surface_rms=surface_rms / 1000.0, seed=seed,
        )  # fmt: skip

    sys.exit(run(command, math.inf))


@click.command()
@click.argument("checks", metavar="CHECK...", type=click.Path(path_type=Path), nargs=-1, required=True)
@click.option(
    "-o", "--output", metavar="FILE", type=click.Path(path_type=Path), help="Write the hand into this file."
)  # fmt: skip
@click.option("--json", "as_json", is_flag=True, help="Print the hand as JSON and nothing else.")
def learn(checks: tuple[Path, ...], output: Path | None, *, as_json: bool) -> None:
    """Learn one person's hand from the checks of what that person bent.

    CHECK is a file that `synth check -o` wrote, or a folder of them. What was asked of the hand each time is
    known where the check before was named by --after. `synth check --hand` then expects of a correction what
    this hand makes of it.

    \b
    Exit codes:
      0  learned
      2  wrong input, or nothing to learn from
    """
    from synth.cli.session import Session, run

    def command(_session: Session) -> ExitCode:
        from synth.cli.learn import learn_files

        return learn_files(checks, output, as_json=as_json)

    sys.exit(run(command, math.inf))


COMMANDS = (calibrate, check, learn)
