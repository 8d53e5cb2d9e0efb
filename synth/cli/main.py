"""The commands of `synth` and their options; what they do is in the modules of their names."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from synth.cli.new import new
from synth.version import __version__

if TYPE_CHECKING:
    from synth.cli.exit_codes import ExitCode


class Seconds(click.FloatRange):
    """A time: a number in a range, and no NaN, which is in every range."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """Return the number."""
        seconds = super().convert(value, param, ctx)
        if math.isnan(seconds):
            self.fail(f"{value!r} is not a number of seconds.", param, ctx)
        return float(seconds)


@click.group(
    commands=[new], context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100}
)
@click.version_option(__version__, "-V", "--version", prog_name="synth")
def main() -> None:
    """Topology synthesis for malleable robots.

    Given target points, find the shape of the malleable link with which the end effector reaches
    them, and say where the markers must be when the link is bent.

    \b
    Exit codes:
      0  found: every target is within its tolerance
      1  not found; the best effort is still given
      2  wrong input: every mistake is named
      3  something broke down; what was found before that is kept
    130  ended at once by a second Ctrl-C; nothing more was written
    """


@main.command()
@click.argument("task_file", metavar="TASK.yaml", type=click.Path(path_type=Path))
@click.option(
    "-o", "--output", metavar="DIR", type=click.Path(path_type=Path),
    help="Write solution.json, guide.pdf and markers.csv into this directory.",
)  # fmt: skip
@click.option("--json", "as_json", is_flag=True, help="Print the solution as JSON and nothing else.")
@click.option("--all", "show_all", is_flag=True, help="Show the alternative shapes, too.")
@click.option(
    "--shape", metavar="K", type=click.IntRange(min=1), default=1,
    help="Show the K-th best shape, in text, JSON and files.  [default: 1, the best]",
)  # fmt: skip
@click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True, help="Seed of the search.")
@click.option("--prove", is_flag=True, help="Prove how much better than the best shape found any may be.")
@click.option(
    "--why", is_flag=True,
    help="If a target is missed, say which limit blocks the task and what would release it.",
)  # fmt: skip
@click.option(
    "--time-limit", metavar="S", type=Seconds(min=0.0, min_open=True), default=math.inf,
    help="Stop after this many seconds and give the best shape so far.  [default: none]",
)  # fmt: skip
def solve(
    task_file: Path,
    output: Path | None,
    *,
    as_json: bool,
    show_all: bool,
    shape: int,
    seed: int,
    prove: bool,
    why: bool,
    time_limit: float,
) -> None:
    """Find a shape of the link for the targets in TASK.yaml.

    Ctrl-C stops the search and gives the best shape so far; a second one ends at once.
    """
    from synth.cli.session import Session, run

    def command(session: Session) -> ExitCode:
        from synth.cli.solve import solve_file

        return solve_file(
            session,
            task_file,
            output,
            form="json" if as_json else "text",
            show_all=show_all,
            shape=shape,
            seed=seed,
            prove=prove,
            why=why,
        )

    sys.exit(run(command, time_limit))


@main.command()
@click.argument("config_file", metavar="CONFIG.yaml", type=click.Path(path_type=Path))
@click.option(
    "-o", "--output", metavar="DIR", type=click.Path(path_type=Path),
    help="Write inspect.json and a picture of each workspace into this directory.",
)  # fmt: skip
@click.option("--json", "form", flag_value="json", help="Print JSON and nothing else.")
@click.option("--markdown", "form", flag_value="markdown", help="Print a table in Markdown.")
@click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True, help="Seed of the samples.")
@click.option(
    "--samples", type=click.IntRange(1, 100_000), default=4000, show_default=True,
    help="How many shapes to draw for the ranges.",
)  # fmt: skip
def inspect(config_file: Path, output: Path | None, form: str | None, seed: int, samples: int) -> None:
    """Look at a shape that was measured, as distances or markers in CONFIG.yaml.

    Says whether points in space have these distances, what they leave open, and whether the link can
    take the pose.

    \b
    Exit codes:
      0  realisable: points in space have all distances within their bounds
      1  not realisable, or a number is impossible
      2  wrong input: every mistake is named
      3  something broke down; what was found before that is kept
    130  ended at once by a second Ctrl-C; nothing more was written
    """
    from synth.cli.session import Session, run

    def command(session: Session) -> ExitCode:
        from synth.cli.inspect import inspect_file

        return inspect_file(session, config_file, output, form=form or "text", seed=seed, samples=samples)

    sys.exit(run(command, math.inf))


@main.command()
@click.argument("measured", metavar="MEASURED", type=click.Path(path_type=Path))
@click.argument("solution", metavar="SOLUTION", type=click.Path(path_type=Path))
@click.option(
    "-o", "--output", metavar="DIR", type=click.Path(path_type=Path),
    help="Write check.json into this directory.",
)  # fmt: skip
@click.option("--json", "as_json", is_flag=True, help="Print the check as JSON and nothing else.")
@click.option(
    "--corrections-left", type=click.IntRange(min=0), default=3, show_default=True,
    help="How many corrections you are still willing to make.",
)  # fmt: skip
@click.option(
    "--marker-error", metavar="MM", type=click.FloatRange(0.001, 100.0), default=0.455, show_default=True,
    help="Mean error of a marker in space.",
)  # fmt: skip
@click.option(
    "--base-calibrated", is_flag=True,
    help="Axis 1 is the z axis of the frame, found by turning joint 1; else its markers show it.",
)  # fmt: skip
@click.option(
    "--confidence", type=click.FloatRange(0.5, 0.999), default=0.95, show_default=True,
    help="Chance that all targets are within tolerance from which on to lock.",
)  # fmt: skip
@click.option("--stiff", is_flag=True, help="The link was stiff when it was measured: it will move no more.")
@click.option(
    "--settings", "settings_within", metavar="MM", type=click.FloatRange(0.0, 1000.0), default=0.0,
    help="Say how to set base and tool after locking, each within so many millimetres.",
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
) -> None:
    """Say what to do with the link as it stands: lock it, correct it, or leave it at that.

    MEASURED holds markers in the base frame, marker,x_mm,y_mm,z_mm; SOLUTION is the solution.json of the
    task.

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
            settings_within=settings_within / 1000.0,
        )  # fmt: skip

    sys.exit(run(command, math.inf))


@main.command()
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
