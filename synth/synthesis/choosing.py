"""Which rigid link, and which place of the base: a search for each choice, quick ones before thorough ones.

In each of these runs the rigid link is given, and so is the place; where the base is free in ranges `placing`
finds it. So nothing behind these two modules knows that there was a choice.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from synth.robot import BaseChoices, BaseRange
from synth.rounding import counted, rounded_up
from synth.synthesis.placing import best_run, in_range, least_objective, run_at

if TYPE_CHECKING:
    from collections.abc import Sequence

    from synth.synthesis.run import Run
    from synth.task import Task
    from synth.watch import Watch

_QUICK = 2  # start points for each of several choices, before any is searched thoroughly
_TOLD = 8  # choices that were not taken, of which it is told how they do


def leaves_a_choice(task: Task) -> bool:
    """Whether a task leaves it open where the base stands, or which rigid link of a catalogue is taken."""
    return task.places is not None or task.robot.rigid_links is not None


def chosen(task: Task, seed: int, watch: Watch, alternatives: int) -> Run:
    """Search with each rigid link and at each place, and choose what has the shape that is wanted most.

    Args:
        task: The task, which leaves a choice.
        seed: Seed of the random shapes and places.
        watch: Its time.
        alternatives: As for `solve`.

    Returns:
        The run of the choice: its shapes are found, and it can be proven and told.
    """
    with_each = [
        replace(task, robot=replace(task.robot, rigid_link=link)) for link in task.robot.possible_rigid_links
    ]
    if isinstance(task.places, BaseRange):
        runs = _in_range(with_each, task.places, seed, watch)
        for run in runs:
            run.look_beside(alternatives)
        best = best_run(runs)
    else:
        poses = [task.base] if task.places is None else task.places.poses
        runs = [run_at(each, pose, seed, watch) for each in with_each for pose in poses]
        best = _searched(runs, alternatives, watch)
    best.places = task.places
    best.others = tuple(run for run in runs if run is not best)
    best.elsewhere |= len(runs) < len(with_each)
    best.notes += _told(best, watch)
    return best


def _in_range(tasks: Sequence[Task], places: BaseRange, seed: int, watch: Watch) -> list[Run]:
    """Search for a place in ranges with one rigid link after the other, while there is time."""
    runs = []
    for task in tasks:
        runs.append(in_range(task, places, seed, watch))
        if watch.is_up():
            break
    return runs


def _searched(runs: Sequence[Run], alternatives: int, watch: Watch) -> Run:
    """Search in each run, but in those that are known to be impossible only if all are; return the best."""
    searched = [run for run in runs if not run.impossible] or runs
    for most in (_QUICK, None):
        unmet = [run for run in searched if not run.search.polishing.found]
        for run in unmet:
            with run.kept(), watch.keeping_back(run.kept_back):
                run.search.run(most)
            if watch.is_up():
                break
        for run in unmet:
            if run.search.polishing.found:
                run.look_beside(alternatives)
        best = best_run(runs)
        if best.does_all or watch.is_up():
            break
    return best


def _told(best: Run, watch: Watch) -> list[str]:
    """Return sentences on what was found with what was not chosen, and of a miss with what it was chosen."""
    told = []
    if best.others and not best.does_all and best.search.polishing.designs:
        told.append(f"what is shown is the shape {_where(best)}")
    order = sorted(best.others, key=lambda run: (not run.search.polishing.found, least_objective(run)))
    some = {id(run) for run in (order if len(order) <= _TOLD + 1 else order[:_TOLD])}
    told += [_of_another(run, watch) for run in best.others if id(run) in some]
    left = len(order) - len(some)
    return [*told, f"{counted(left, 'other choice')} did no better"] if left else told


def _of_another(run: Run, watch: Watch) -> str:
    where, designs = _where(run), run.search.polishing.designs
    looked_at = f"of the {len(run.part.targets)} targets that were looked at"
    if run.search.polishing.found:
        if run.was_looked_through and not run.does_all:
            return f"{where} each {looked_at} first is reached, but not all that is asked"
        what = "every target" if run.sees_all or run.was_looked_through else f"each {looked_at}"
        return f"{where} {what} is reached, too, by a shape that is less wanted"
    if run.impossible:
        return f"{where} no shape can do it: {run.impossible[0]}"
    if designs:
        worst = min(float(np.max(design.verification.misses)) for design in designs)
        told = f"{where} the best shape found misses by {rounded_up(worst, digits=2)} mm"
        return told if run.sees_all else f"{told} at the worst {looked_at}"
    if watch.interrupted and not run.search.starts:
        return f"{where} nothing was looked for: the time was up"
    return f"{where} no shape was found that the hardware can take"


def _where(run: Run) -> str:
    """Return with which rigid link and at which place a run was made, as far as there was a choice."""
    robot, places = run.task.robot, run.places
    link = robot.name_of_rigid_link(robot.rigid_link.d35.lower, robot.rigid_link.d45.lower)
    place = places.name_of(run.task.base) if isinstance(places, BaseChoices) else ""
    return " ".join([*([f"with {link}"] if link else []), *([f"at {place}"] if place else [])])
