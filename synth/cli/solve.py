"""`synth solve`: from a task file to a shape and its guide."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import click

from synth.cli.exit_codes import ExitCode
from synth.cli.session import interruptible, search_progress
from synth.cli.terminal import show
from synth.errors import SynthError
from synth.export import prepare_directory, solution_to_json, write_files
from synth.guide import solution_text
from synth.synthesis import Status, explain, showing, solve
from synth.task import load_task

if TYPE_CHECKING:
    from pathlib import Path


def solve_file(
    file: Path,
    output: Path | None,
    *,
    form: str,
    show_all: bool,
    shape: int,
    seed: int,
    prove: bool,
    why: bool,
    time_limit: float,
) -> ExitCode:
    """Solve the task of a file and say what was found.

    Args:
        file: The task file.
        output: Directory for the files, or None.
        form: "text" or "json".
        show_all: Whether the text shows the alternative shapes.
        shape: Which of the shapes is shown, counted from 1, the best.
        seed: Seed of the search.
        prove: Whether to prove how much better any shape may be.
        why: Whether to look for what would release a task that is not met.
        time_limit: Time after which the best shape so far is given, s.

    Returns:
        The exit code.
    """
    try:
        task = load_task(file)
        if output is not None:
            prepare_directory(output)
        with interruptible() as stop, search_progress() as progress:
            solution = solve(
                task, seed=seed, prove=prove, time_limit=time_limit, stop=stop, progress=progress
            )
            if why:
                solution = explain(solution, stop=stop)
        if shape != 1:
            solution = showing(solution, shape)
        if form == "json":
            click.echo(json.dumps(solution_to_json(solution), indent=2, allow_nan=False))
        else:
            show(solution_text(solution, alternatives=show_all))
        for path in [] if output is None else write_files(solution, output):
            click.echo(f"wrote {path}", err=True)
    except SynthError as error:  # `solve` itself raises none: it returns what became of the search
        click.echo(str(error), err=True)
        return ExitCode.WRONG_INPUT
    if solution.status is Status.FAILED:
        return ExitCode.BROKEN
    return ExitCode.DONE if solution.found else ExitCode.NOT_MET
