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
@click.argument(
    "task_files", metavar="TASK.yaml...", type=click.Path(path_type=Path), nargs=-1, required=True
)
@click.option(
    "-o", "--output", metavar="DIR", type=click.Path(path_type=Path),
    help="Write solution.json, guide.pdf, guide.html and markers.csv into this directory; of many tasks, "
    "into one for each, with all solutions in sweep.sqlite.",
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
@click.option(
    "--jobs", metavar="N", type=click.IntRange(min=1), default=1, show_default=True,
    help="Solve so many tasks at once, each in a process of its own.",
)  # fmt: skip
def solve(
    task_files: tuple[Path, ...],
    output: Path | None,
    *,
    as_json: bool,
    show_all: bool,
    shape: int,
    seed: int,
    prove: bool,
    why: bool,
    time_limit: float,
    jobs: int,
) -> None:
    """Find a shape of the link for the targets in TASK.yaml.

    Of several tasks, or of all in a folder, a table is printed, and with -o what was solved before is not
    solved again. The time limit is then that of each task.

    Ctrl-C stops the search and gives the best shape so far; a second one ends at once.
    """
    from synth.cli.session import Session, run

    many = len(task_files) > 1 or task_files[0].is_dir()
    if many and (show_all or why or shape != 1):
        raise click.UsageError("--all, --shape and --why are for one task.")
    if not many and jobs != 1:
        raise click.UsageError("--jobs is for several tasks.")

    def sweep(session: Session) -> ExitCode:
        from synth.cli.sweep import solve_files

        return solve_files(
            session, task_files, output,
            as_json=as_json, seed=seed, prove=prove, time_limit=time_limit, jobs=jobs,
        )  # fmt: skip

    def command(session: Session) -> ExitCode:
        from synth.cli.solve import solve_file

        form = "json" if as_json else "text"
        return solve_file(
            session, task_files[0], output,
            form=form, show_all=show_all, shape=shape, seed=seed, prove=prove, why=why,
        )  # fmt: skip

    sys.exit(run(sweep, math.inf) if many else run(command, time_limit))


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
