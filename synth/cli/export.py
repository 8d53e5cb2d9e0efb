"""`synth export`: the files of a solution for planners and simulators."""

from __future__ import annotations

from typing import TYPE_CHECKING

from synth.cli.exit_codes import ExitCode
from synth.cli.say import say
from synth.export import write_planner_files
from synth.solution_file import load_solved
from synth.synthesis import showing

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path


def export_file(file: Path, output: Path, kinds: Sequence[str], shape: int) -> ExitCode:
    """Write files of a solution for planners and simulators, all of them or none.

    Args:
        file: The file of the solution.
        output: Directory for the files.
        kinds: Which kinds of files; none for all.
        shape: Which of the shapes in the file, counted from 1.

    Returns:
        The exit code.
    """
    solution = load_solved(file)
    if shape != 1:
        solution = showing(solution, shape)
    for path in write_planner_files(solution, output, kinds):
        say(f"wrote {path}", on_stderr=True)
    return ExitCode.DONE
