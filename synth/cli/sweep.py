"""`synth solve` with several tasks: all of them, with a table of what became of each."""

from __future__ import annotations

import json
import math
import re
import signal
import sys
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing import get_context
from pathlib import Path
from typing import TYPE_CHECKING

from synth.cli.exit_codes import ExitCode
from synth.cli.say import say
from synth.cli.terminal import as_shown
from synth.errors import InputError, Mistake, SynthError
from synth.export import SOLUTION_FILES, prepare_directory, write_what_can_be
from synth.rounding import rounded_up
from synth.sweep import SweepProgress, TaskOutcome, solve_many
from synth.synthesis import Status

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from synth.cli.session import Session

STORE = "sweep.sqlite"
_SUFFIXES = {".yaml", ".yml", ".json"}
# What only a task states at its top.
_TASK = re.compile(r"""^\s{0,2}["']?(?:targets|surface)["']?\s*:""", re.MULTILINE)


def solve_files(
    session: Session,
    given: Sequence[Path],
    output: Path | None,
    *,
    as_json: bool,
    seed: int,
    prove: bool,
    time_limit: float,
    jobs: int,
) -> ExitCode:
    """Solve the tasks of many files and say what became of each.

    Args:
        session: The run of the command.
        given: Task files, and folders of them.
        output: Directory for a folder of each task and the store, or None.
        as_json: Whether each solution is printed as JSON on a line of its own, and nothing else.
        seed: Seed of each search.
        prove: Whether to prove how much better any shape may be.
        time_limit: Time for each task, s.
        jobs: How many are solved at once.

    Returns:
        The exit code: the worst of all tasks.
    """
    files = task_files(given)
    if output is not None:
        prepare_directory(output)
    folders = [] if output is None else list(_folders(files, output))
    with _executor(jobs) as executor:
        outcomes = solve_many(
            [file for file, _ in files],
            executor=executor,
            store=None if output is None else output / STORE,
            progress=_tell if sys.stderr is not None and sys.stderr.isatty() else None,
            seed=seed,
            prove=prove,
            time_limit=time_limit,
            stop=session.stop,
        )
    written = [_write(outcome, folder) for outcome, folder in zip(outcomes, folders, strict=False)]
    names = [name for _, name in files]
    if as_json:
        for name, outcome in zip(names, outcomes, strict=True):
            say(json.dumps({"file": name, **_told(outcome)}, allow_nan=False))
    else:
        say(as_shown("\n".join(table(names, outcomes)), sys.stdout))
    return max(map(_code, outcomes)) if all(written) else ExitCode.BROKEN


def task_files(given: Sequence[Path]) -> list[tuple[Path, str]]:
    """Return task files with what each is called: its path, from the folder on that was given.

    Raises:
        InputError: A folder holds none.
    """
    files: list[tuple[Path, str]] = []
    for path in given:
        if not path.is_dir():
            files.append((path, path.as_posix()))
            continue
        inside = sorted(file for file in path.rglob("*") if file.suffix in _SUFFIXES and _is_task(file))
        if not inside:
            raise InputError([Mistake("holds no task file", str(path))])
        files += [(file, file.relative_to(path).as_posix()) for file in inside]
    return files


def _is_task(file: Path) -> bool:
    try:
        return file.is_file() and _TASK.search(file.read_text("utf-8-sig")) is not None
    except (OSError, UnicodeDecodeError):
        return False


def _folders(files: Sequence[tuple[Path, str]], output: Path) -> Iterator[Path]:
    """Yield a folder for each task within the output's, no two alike and none beside it."""
    taken: set[Path] = set()
    for _, name in files:
        parts = [part for part in Path(name).with_suffix("").parts if part not in {"/", "..", "."}]
        folder, number = output.joinpath(*parts), 2
        while folder in taken:
            folder = output.joinpath(*parts[:-1], f"{parts[-1]}-{number}")
            number += 1
        taken.add(folder)
        yield folder


@contextmanager
def _executor(jobs: int) -> Iterator[ProcessPoolExecutor | None]:
    """Yield processes that leave Ctrl-C to this one; None for one job, which this one does."""
    if jobs == 1:
        yield None
        return
    pool = ProcessPoolExecutor(jobs, get_context("spawn"), signal.signal, (signal.SIGINT, signal.SIG_IGN))
    try:
        yield pool
    finally:
        pool.shutdown(cancel_futures=True)


def _tell(progress: SweepProgress) -> None:
    outcome = progress.outcome
    say(f"{progress.done} of {progress.total}: {outcome.name}: {_word(outcome)}", on_stderr=True)


def _word(outcome: TaskOutcome) -> str:
    if outcome.solved:
        return str(outcome.status.value)
    return "wrong input" if outcome.wrong_input else "not solved"


def _told(outcome: TaskOutcome) -> dict[str, object]:
    if not outcome.solved:
        return {"solution": None, "error": outcome.error}
    return {"solution": json.loads(outcome.text), "error": None}


def _write(outcome: TaskOutcome, folder: Path) -> bool:
    """Write the files of a task, and say which; whether all of them are there."""
    if not outcome.solved or (outcome.stored and _is_there(outcome, folder)):
        return True
    try:
        written = write_what_can_be(outcome.solution, folder)
    except SynthError as error:
        say(str(error), on_stderr=True)
        return False
    for sentence in written.sentences:
        say(f"{folder}: {sentence}", on_stderr=True)
    return not written.failed


def _is_there(outcome: TaskOutcome, folder: Path) -> bool:
    """Whether the files of a solution were written by an earlier run."""
    if not all((folder / name).is_file() for name in SOLUTION_FILES):
        return False
    try:
        content = json.loads((folder / SOLUTION_FILES[0]).read_text("utf-8"))
    except (OSError, ValueError):
        return False
    return bool(content == json.loads(outcome.text))


def table(names: Sequence[str], outcomes: Sequence[TaskOutcome]) -> Iterator[str]:
    """Yield the lines of a table of many tasks, and then what is wrong with those that have no solution.

    Args:
        names: What the files are called.
        outcomes: What became of their tasks.
    """
    rows = [("task", "status", "worst miss", "time")]
    for name, outcome in zip(names, outcomes, strict=True):
        miss = f"{rounded_up(outcome.worst_miss, digits=2)} mm" if math.isfinite(_miss(outcome)) else "-"
        time = "stored" if outcome.stored else f"{outcome.seconds:.1f} s"
        rows.append((name, _word(outcome), miss, time if outcome.solved else "-"))
    widths = [max(len(row[column]) for row in rows) for column in range(4)]
    for name, status, miss, time in rows:
        yield f"{name:<{widths[0]}}  {status:<{widths[1]}}  {miss:>{widths[2]}}  {time:>{widths[3]}}".rstrip()
    found = sum(outcome.found for outcome in outcomes)
    yield f"{found} of {len(outcomes)} found"
    yield from (outcome.error for outcome in outcomes if not outcome.solved)


def _miss(outcome: TaskOutcome) -> float:
    return outcome.worst_miss if outcome.solved else math.inf


def _code(outcome: TaskOutcome) -> ExitCode:
    if outcome.wrong_input:
        return ExitCode.WRONG_INPUT
    if outcome.solved and outcome.status is not Status.FAILED:
        return ExitCode.DONE if outcome.found else ExitCode.NOT_MET
    return ExitCode.BROKEN
