"""What a worker does: it solves some tasks, one after the other, and returns them as text."""

from __future__ import annotations

import os
import threading
import time
from typing import TYPE_CHECKING

from synth.errors import InputError, in_a_line
from synth.export import json_text, solution_to_json
from synth.sweep.outcome import TaskOutcome
from synth.synthesis import solve

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from synth.task import Task

_GLANCE = 1.0  # s, between looks for the parent


def solved_chunk(
    tasks: Sequence[Task],
    seed: int,
    options: Mapping[str, object],
    parent: int = 0,
    stop: Callable[[], bool] | None = None,
) -> list[TaskOutcome]:
    """Return what becomes of some tasks; one that breaks is an outcome as any other.

    Args:
        tasks: The tasks.
        seed: Seed of the search.
        options: What else is given to `solve`.
        parent: The process that asked; a worker that it started ends with it.
        stop: As for `solve`.
    """
    if parent and os.getppid() == parent:
        _end_with(parent)
    return [_solved(task, seed, options, stop) for task in tasks]


def _solved(
    task: Task, seed: int, options: Mapping[str, object], stop: Callable[[], bool] | None
) -> TaskOutcome:
    began = time.perf_counter()
    try:
        solution = solve(task, seed=seed, stop=stop, **options)  # type: ignore[arg-type]
        text = json_text(solution_to_json(solution), indent=0)
    except InputError as error:
        return TaskOutcome(task.name, error=str(error), wrong_input=True)
    except Exception as error:  # noqa: BLE001 - a task that breaks is a result, and the others go on
        return TaskOutcome(task.name, error=in_a_line(error))
    return TaskOutcome(task.name, text, seconds=time.perf_counter() - began)


_watched = threading.Lock()


def _end_with(parent: int) -> None:
    """End this process once its parent is gone: nobody waits for what it solves."""

    def watch() -> None:
        while os.getppid() == parent:
            time.sleep(_GLANCE)
        os._exit(1)

    if _watched.acquire(blocking=False):  # once in a process
        threading.Thread(target=watch, daemon=True).start()
