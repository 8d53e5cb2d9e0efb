"""Many tasks, on any executor, kept in a store: `solve_many` is the one verb."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from concurrent.futures import BrokenExecutor, Executor, Future
from contextlib import nullcontext, suppress
from queue import Empty, SimpleQueue
from typing import TYPE_CHECKING

from synth.checks import wrong_number, wrong_type
from synth.errors import InputError, Mistake, in_a_line
from synth.sweep.outcome import SweepProgress, TaskOutcome
from synth.sweep.store import Store, key_of
from synth.sweep.worker import solved_chunk
from synth.synthesis import ALTERNATIVES
from synth.task import Task, as_task

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

_POLL = 0.2  # s, between questions whether to stop
_STOPPED = "was not solved: the sweep was stopped before"

TaskSource = Task | str | os.PathLike[str] | Mapping[str, object]


def solve_many(
    tasks: Iterable[TaskSource],
    *,
    executor: Executor | None = None,
    chunksize: int = 1,
    store: str | os.PathLike[str] | None = None,
    progress: Callable[[SweepProgress], None] | None = None,
    seed: int = 0,
    alternatives: int = ALTERNATIVES,
    prove: bool = False,
    time_limit: float = math.inf,
    stop: Callable[[], bool] | None = None,
) -> tuple[TaskOutcome, ...]:
    """Solve many tasks, each as `solve` does.

    Args:
        tasks: The tasks, or what `solve` takes for one. A task that is given twice is solved once.
        executor: Who solves: any executor of `concurrent.futures`, or what acts like one (Dask, MPI,
            Slurm). By default this process, one task after the other. Threads will do, but the search
            leaves them little to share: processes are faster.
        chunksize: How many tasks a worker is given at a time; more than one where tasks take less time
            than the way to the worker.
        store: File in which solutions are kept by task, seed, options and version. What it holds is not
            solved again, so a sweep that was killed goes on where it was, on any executor.
        progress: Told of each task as it is done, in the order in which they end.
        seed: Seed of each search.
        alternatives: As for `solve`.
        prove: As for `solve`.
        time_limit: Time for each task, s.
        stop: Asked a few times a second; return True to give up what was not begun.

    Returns:
        What became of each task, in the order of the tasks: wrong input, a worker that broke down and a
        task that was given up are outcomes, too.

    Raises:
        InputError: An argument other than the tasks is wrong.
        SynthError: The store cannot be written.
    """
    _check(executor, chunksize)
    options = {"alternatives": alternatives, "prove": prove, "time_limit": time_limit}
    with nullcontext() if store is None else Store(store) as kept:
        sweep = _Sweep(list(tasks), kept, progress, seed, options)
        if executor is None:
            for index in sweep.left:
                if stop is not None and stop():
                    break
                sweep.put(index, solved_chunk([sweep.tasks[index]], seed, options, stop=stop)[0])
        else:
            _submit(sweep, executor, chunksize, stop)
        return sweep.ended()


def _check(executor: Executor | None, chunksize: int) -> None:
    mistakes = []
    # Executors of other packages need not be subclasses.
    if executor is not None and not hasattr(executor, "submit"):
        mistakes.append(Mistake(wrong_type(executor, Executor), key="executor"))
    if wrong := wrong_number(chunksize, least=1):
        mistakes.append(Mistake(wrong, key="chunksize"))
    if mistakes:
        raise InputError(mistakes)


class _Sweep:
    """The tasks, and what became of them so far.

    Attributes:
        tasks: Those that could be read, by their places in the order given.
        left: Places of those that are still to be solved, each task once.
        seed: Seed of each search.
        options: What else is given to `solve`.
    """

    def __init__(
        self,
        sources: Sequence[TaskSource],
        store: Store | None,
        progress: Callable[[SweepProgress], None] | None,
        seed: int,
        options: Mapping[str, object],
    ) -> None:
        self._store, self._progress = store, progress
        self.seed, self.options = seed, options
        self._outcomes: dict[int, TaskOutcome] = {}
        self._total = len(sources)
        self._keys: dict[int, str] = {}
        self._alike: dict[str, list[int]] = {}
        self.tasks: dict[int, Task] = {}
        for index, source in enumerate(sources):
            try:
                self.tasks[index] = as_task(source)
            except InputError as error:
                name = str(source) if isinstance(source, str | os.PathLike) else f"task {index + 1}"
                self._tell(index, TaskOutcome(name, error=str(error), wrong_input=True))
                continue
            self._keys[index] = key_of(self.tasks[index], seed, options)
            self._alike.setdefault(self._keys[index], []).append(index)
        self.left = [places[0] for places in self._alike.values()]
        if store is not None:
            self._take_from(store)

    def _take_from(self, store: Store) -> None:
        for index in list(self.left):
            known = store.find(self._keys[index])
            if known is not None:
                self.left.remove(index)
                self._tell_alike(index, known)

    def put(self, index: int, outcome: TaskOutcome) -> None:
        """Keep what became of a task, then tell of it."""
        if self._store is not None and outcome.solved:
            self._store.add(self._keys[index], outcome, self.seed, self.options)
        self._tell_alike(index, outcome)

    def ended(self) -> tuple[TaskOutcome, ...]:
        """Return all outcomes; of what was not solved, that."""
        for index, task in self.tasks.items():
            if index not in self._outcomes:
                self._outcomes[index] = TaskOutcome(task.name, error=_STOPPED)
        return tuple(self._outcomes[index] for index in range(self._total))

    def _tell_alike(self, index: int, outcome: TaskOutcome) -> None:
        for each in self._alike[self._keys[index]]:
            self._tell(each, outcome)

    def _tell(self, index: int, outcome: TaskOutcome) -> None:
        self._outcomes[index] = outcome
        if self._progress is not None:
            self._progress(SweepProgress(len(self._outcomes), self._total, index, outcome))


def _submit(sweep: _Sweep, executor: Executor, chunksize: int, stop: Callable[[], bool] | None) -> None:
    """Have an executor solve what is left, and keep what comes back as it comes."""
    chunks = [sweep.left[start : start + chunksize] for start in range(0, len(sweep.left), chunksize)]
    waiting: dict[Future[list[TaskOutcome]], list[int]] = {}
    done: SimpleQueue[Future[list[TaskOutcome]]] = SimpleQueue()  # a thread of the executor's puts them in
    try:
        for chunk in chunks:
            tasks = [sweep.tasks[index] for index in chunk]
            try:
                future = executor.submit(solved_chunk, tasks, sweep.seed, dict(sweep.options), os.getpid())
            except BrokenExecutor as error:
                future = Future()
                future.set_exception(error)
            waiting[future] = chunk
            future.add_done_callback(done.put)
        while waiting and not (stop is not None and stop()):
            with suppress(Empty):
                future = done.get(timeout=None if stop is None else _POLL)
                _collect(sweep, waiting.pop(future), future)
    finally:
        for future in waiting:
            future.cancel()


def _collect(sweep: _Sweep, chunk: Sequence[int], future: Future[list[TaskOutcome]]) -> None:
    """Take over what became of a chunk of tasks."""
    try:
        outcomes = future.result()
    except Exception as error:  # noqa: BLE001 - a worker that breaks down is an outcome of its tasks
        said = f"the worker broke down: {in_a_line(error)}"
        outcomes = [TaskOutcome(sweep.tasks[index].name, error=said) for index in chunk]
    for index, outcome in zip(chunk, outcomes, strict=True):
        sweep.put(index, outcome)
