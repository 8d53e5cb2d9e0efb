"""The sentence itself: task -> start points -> nonlinear program -> independent check -> solution."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from synth.synthesis.arguments import checked_task
from synth.synthesis.choosing import chosen, leaves_a_choice
from synth.synthesis.proving import prove_run
from synth.synthesis.run import Run
from synth.synthesis.searching import ALTERNATIVES
from synth.synthesis.whole import part_of
from synth.watch import Watch

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Mapping, Sequence

    from synth.synthesis.solution import Solution
    from synth.synthesis.wanted import Design
    from synth.task import Task
    from synth.watch import Progress


def solve(
    task: Task | str | os.PathLike[str] | Mapping[str, object],
    *,
    seed: int = 0,
    warm_start: Solution | None = None,
    alternatives: int = ALTERNATIVES,
    prove: bool = False,
    time_limit: float = math.inf,
    stop: Callable[[], bool] | None = None,
    progress: Callable[[Progress], None] | None = None,
) -> Solution:
    """Find a shape of the malleable link with which the end effector reaches the targets.

    Args:
        task: What is asked: a task, the path of its file, or a mapping as in a file.
        seed: Seed of the search.
        warm_start: The solution of a task nearby, of the same robot: targets a few millimetres or
            centimetres away. If one of its two best shapes, polished for this task, reaches every target
            it is returned, with no other shapes beside it. If not, the whole search follows. Where the
            base is free, or the rigid link is chosen from a catalogue, it is not used.
        alternatives: How many other shapes are looked for once one reaches every target: those that a person
            would want, which see `ranking`; where there are none, so many other start points are polished.
            Where no shape reaches every target, at most two are polished that promise nothing better than the
            best. 0 gives the first shape, several times as fast, wherever it leans.
        prove: Whether to bound how little any shape can miss; that takes seconds, or about a minute.
        time_limit: Time after which the best shape so far is returned, s.
        stop: Polled many times a second; return True to stop with the best shape so far.
        progress: Told of each step: of the search for start points, of each one polished, of the proof.

    Returns:
        The solution, whatever was found; its status says what it is worth. Where something broke that nobody
        foresaw, what was found before, and in `reasons` what broke.

    Raises:
        InputError: An argument is wrong, or the sizes of the task cannot be meant; with every mistake.
        TimeLimitError: The time was up before the file of the task was read.
    """
    watch = Watch(time_limit, stop=stop, report=progress)
    task = checked_task(
        task,
        seed=seed,
        warm_start=warm_start,
        alternatives=alternatives,
        time_limit=time_limit,
        is_up=watch.is_up,
    )
    if leaves_a_choice(task):
        run = chosen(task, seed, watch, alternatives)
    else:
        run = Run(task, part_of(task, seed, watch), seed, watch, alternatives)
        near = warm_start.designs if warm_start is not None and warm_start.task.robot == task.robot else ()
        with run.kept(), watch.keeping_back(run.kept_back):
            if not run.search.follow(near):
                run.search.run()
    if prove and run.broke_off is None:
        with run.kept(), watch.keeping_back(run.kept_back):
            prove_run(run)
    return run.solution()


def follow(
    task: Task,
    designs: Sequence[Design],
    *,
    starts: int = 0,
    seed: int = 0,
    watch: Watch | None = None,
) -> Solution:
    """Polish shapes for a task nearby, maybe of a robot nearly the same, and search little farther.

    Args:
        task: The task.
        designs: Shapes, the most promising first.
        starts: How many start points are polished, too, if none of the shapes will do.
        seed: As for `solve`.
        watch: Says when to end with what there is.
    """
    run = Run(task, part_of(task, seed), seed, watch or Watch())
    with run.kept(), run.watch.keeping_back(run.kept_back):
        if not run.search.follow(designs) and starts:
            run.search.run(starts)
    return run.solution()
