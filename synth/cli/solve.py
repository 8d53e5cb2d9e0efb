"""`synth solve`: from a task file to a shape and its guide."""

from __future__ import annotations

import os
import sys
from dataclasses import replace
from typing import TYPE_CHECKING

from synth.cli.exit_codes import ExitCode
from synth.cli.say import say
from synth.cli.session import DEBUG, search_progress
from synth.errors import SynthError, TimeLimitError

if TYPE_CHECKING:
    from pathlib import Path

    from synth.cli.session import Session
    from synth.synthesis import Solution


def solve_file(
    session: Session,
    file: Path,
    output: Path | None,
    *,
    form: str,
    show_all: bool,
    shape: int,
    seed: int,
    prove: bool,
    why: bool,
) -> ExitCode:
    """Solve the task of a file and say what was found: first as files, then in words.

    Args:
        session: The run of the command.
        file: The task file.
        output: Directory for the files, or None.
        form: "text" or "json".
        show_all: Whether the text shows the alternative shapes.
        shape: Which of the shapes is shown, counted from 1, the best.
        seed: Seed of the search.
        prove: Whether to prove how much better any shape may be.
        why: Whether to look for what would release a task that is not met.

    Returns:
        The exit code.
    """
    from synth.export import SOLUTION_FILES, prepare_directory
    from synth.task import load_task

    task = load_task(file, is_up=session.is_late)
    written = len(task.targets) if output is not None or form == "json" else 0
    if output is not None:
        prepare_directory(output, SOLUTION_FILES)
    from synth.synthesis import Status, explain, showing, solve

    with search_progress() as progress:
        solution = solve(
            task,
            seed=seed,
            prove=prove,
            time_limit=session.for_search(written),
            stop=session.stop,
            progress=progress,
        )
        if why:
            found = solution
            solution = session.attempt(
                "looking for what would release the task",
                lambda: explain(
                    found,
                    time_limit=session.for_search(written),
                    stop=session.stop,
                    progress=progress,
                ),
                replace(
                    found,
                    explained=True,
                    notes=(*found.notes, "what would release the task was not found out"),
                ),
            )
        if shape != 1:
            solution = showing(solution, shape)
    if solution.breakdown:
        _tell_of_breakdown(solution)
    kept = output is None or _write(session, solution, output)
    said = _say(session, solution, form=form, show_all=show_all)
    if not kept or not (said or output is not None) or session.broken:
        return ExitCode.BROKEN
    if solution.breakdown or solution.status is Status.FAILED:
        return ExitCode.BROKEN
    return ExitCode.DONE if solution.found else ExitCode.NOT_MET


def _tell_of_breakdown(solution: Solution) -> None:
    if os.environ.get(DEBUG):
        say(solution.breakdown, on_stderr=True)
    say(
        f"{solution.reasons[0] if solution.reasons else 'the search broke off'}; "
        f"what was found before is kept; please report this ({DEBUG}=1 shows where)",
        on_stderr=True,
    )


def _write(session: Session, solution: Solution, output: Path) -> bool:
    """Write the files, and say which; whether all of them are there, but for those that were too late."""
    from synth.export import write_what_can_be

    try:
        written = session.attempt(
            "writing", lambda: write_what_can_be(solution, output, is_up=session.is_up), None
        )
    except SynthError as error:  # the disk is full, say: the answer is still to be printed
        say(str(error), on_stderr=True)
        return False
    if written is None:
        return False
    for path in written.paths:
        say(f"wrote {path}", on_stderr=True)
    for sentence in written.sentences:
        say(sentence, on_stderr=True)
    if any(isinstance(error, KeyboardInterrupt) for error in written.failed.values()):
        raise KeyboardInterrupt
    return all(isinstance(error, TimeLimitError) for error in written.failed.values())


def _say(session: Session, solution: Solution, *, form: str, show_all: bool) -> bool:
    """Print the answer; whether it was delivered."""
    from synth.cli.terminal import as_shown
    from synth.export import json_text, solution_to_json
    from synth.guide import solution_text

    def text() -> str:
        if form == "json":
            return json_text(solution_to_json(solution), indent=2)
        return as_shown(solution_text(solution, alternatives=show_all), sys.stdout)

    said = say(session.attempt("putting the answer into words", text, solution.message))
    if not said:
        say("the answer could not be printed: the output is full or broken", on_stderr=True)
    return said
