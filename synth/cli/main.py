"""The commands of `synth`."""

from __future__ import annotations

import json
import math
import sys
from pathlib import Path

import click

from synth.version import __version__

FOUND, NOT_FOUND, WRONG_INPUT, BROKEN = 0, 1, 2, 3


@click.group(context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.version_option(__version__, prog_name="synth")
def main() -> None:
    """Topology synthesis for malleable robots.

    Given target points, find the shape of the malleable link with which the end effector reaches
    them, and say where the markers must be when the link is bent.

    \b
    Exit codes:
      0  found: every target is within its tolerance
      1  not found; the best effort is still given
      2  wrong input: every mistake is named
      3  the solver broke down
    """


@main.command()
@click.argument("task_file", metavar="TASK.yaml", type=click.Path(path_type=Path))
@click.option(
    "-o", "--output", metavar="DIR", type=click.Path(path_type=Path),
    help="Write solution.json, guide.pdf and markers.csv into this directory.",
)  # fmt: skip
@click.option("--json", "as_json", is_flag=True, help="Print the solution as JSON and nothing else.")
@click.option("--all", "show_all", is_flag=True, help="Show the alternative shapes, too.")
@click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True, help="Seed of the search.")
@click.option(
    "--time-limit", metavar="S", type=click.FloatRange(min=0.0, min_open=True), default=math.inf,
    help="Stop after this many seconds and give the best shape so far.  [default: none]",
)  # fmt: skip
def solve(
    task_file: Path, output: Path | None, *, as_json: bool, show_all: bool, seed: int, time_limit: float
) -> None:
    """Find a shape of the link for the targets in TASK.yaml.

    Ctrl-C stops the search and gives the best shape so far.
    """
    from synth.cli.session import interruptible, search_progress
    from synth.errors import InputError, SynthError
    from synth.export import prepare_directory, solution_to_json, write_files
    from synth.guide import solution_text
    from synth.synthesis import Status
    from synth.synthesis import solve as solve_task
    from synth.task import load_task

    try:
        task = load_task(task_file)
        if output is not None:
            prepare_directory(output)
    except (InputError, SynthError) as error:
        click.echo(str(error), err=True)
        sys.exit(WRONG_INPUT)
    with interruptible() as stop, search_progress() as progress:
        solution = solve_task(task, seed=seed, time_limit=time_limit, stop=stop, progress=progress)
    if as_json:
        click.echo(json.dumps(solution_to_json(solution), indent=2, allow_nan=False))
    else:
        click.echo(solution_text(solution, alternatives=show_all))
    if output is not None:
        try:
            files = write_files(solution, output)
        except SynthError as error:
            click.echo(str(error), err=True)
            sys.exit(WRONG_INPUT)
        for file in files:
            click.echo(f"wrote {file}", err=True)
    if solution.status is Status.FAILED:
        sys.exit(BROKEN)
    sys.exit(FOUND if solution.found else NOT_FOUND)
