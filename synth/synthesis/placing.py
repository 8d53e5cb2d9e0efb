"""Where a base that is free in ranges should stand: shapes and places are searched for together.

Shapes and the pose of the base are refined together, many at once; each start then stands somewhere, and from
there on the task is one whose base is given. So nothing behind this module knows of a base that is free.
"""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import islice
from typing import TYPE_CHECKING

import numpy as np

from synth.synthesis.run import Run
from synth.synthesis.starts import Start, start_points
from synth.synthesis.wanted import best_of, objective, preferred_designs
from synth.synthesis.whole import part_of, without_partial

if TYPE_CHECKING:
    from collections.abc import Sequence

    from synth.robot import BasePose, BaseRange
    from synth.task import Task
    from synth.watch import Watch

# Start points, each with its own place, until a shape reaches every target there; and so many of those that
# miss by more than the tolerances, the first of which promises the most.
_TRIED, _TRIED_THAT_MISS = 12, 3
# A place is told in round numbers where that will do: to so much, m and rad, the coarsest first.
_ROUND = ((1e-3, math.radians(0.1)), (1e-4, math.radians(0.01)))


def in_range(task: Task, places: BaseRange, seed: int, watch: Watch) -> Run:
    """Refine shapes and places together, and stay at the first place where a shape does all.

    Args:
        task: The task, whose base is free in ranges.
        places: These ranges.
        seed: Seed of the random shapes and places.
        watch: Its time.

    Returns:
        The run at the place found.
    """
    part = part_of(task, seed, watch)
    runs: list[Run] = []
    impossible = _is_out_of_reach(task, places)
    for start in islice(start_points(part, seed, quick=impossible, watch=watch), _TRIED):
        if start.cost > float(part.tolerances.max()) ** 2 and len(runs) == _TRIED_THAT_MISS:
            break
        runs.append(_started(task, part, start, seed, watch))
        if runs[-1].does_all or watch.is_up():
            break
    if not runs:
        return run_at(task, task.base, seed, watch)
    best = best_run(runs)
    best.elsewhere = not impossible  # then it is so where the base stands now, too
    if best.does_all:
        best = _at_round_numbers(task, places, best, seed, watch)
    return best


def run_at(task: Task, base: BasePose, seed: int, watch: Watch, part: Task | None = None) -> Run:
    """Return a run with the base somewhere; `part` is what start points were searched with, if they were."""
    there = task.standing_at(base)
    if part is None or part is task:
        part = part_of(there, seed, watch)
    seen = there if part is there else part.standing_at(base)
    return Run(there, seen, seed, watch, alternatives=0, places=task.places)


def _started(task: Task, part: Task, start: Start, seed: int, watch: Watch) -> Run:
    """Return a run where a start point stands, which is polished."""
    run = run_at(task, start.arm.base, seed, watch, part)
    with run.kept(), watch.keeping_back(run.kept_back):
        run.search.polish(start)
    return run


def _at_round_numbers(task: Task, places: BaseRange, run: Run, seed: int, watch: Watch) -> Run:
    """Return a run at a place nearby that can be told in round numbers, if a shape does it there, too."""
    design = next(design for design in run.search.polishing.designs if design.verification.found)
    for grid in _ROUND:
        base = _rounded(places, design.arm.base, *grid)
        arm = replace(design.arm, base=base)
        joints, _ = arm.closest_joints(run.part.table.positions)
        there = _started(task, run.part, Start(arm, joints), seed, watch)
        if there.does_all:
            return there
        if watch.is_up():
            break
    return run


def _is_out_of_reach(task: Task, places: BaseRange) -> bool:
    """Whether some target that must be reached is farther from wherever P1 may be than the straight arm."""
    asked = without_partial(task)
    if asked is None:
        return False
    robot, (lower, upper) = task.robot, places.bounds[:, :3]
    reach = robot.d12 + robot.link.length.upper + abs(robot.tip_offset) + robot.rigid_link.d35.upper
    targets = asked.table.positions
    away = np.linalg.norm(targets - np.clip(targets, lower, upper), axis=1) - asked.tolerances
    return bool(away.max() > reach)


def _rounded(places: BaseRange, base: BasePose, length: float, angle: float) -> BasePose:
    row = np.array([*base.position, base.roll, base.pitch, base.yaw])
    steps = np.repeat([length, angle], 3)
    return places.pose(places.into_limits(np.round(row / steps) * steps))


def best_run(runs: Sequence[Run]) -> Run:
    """Return the run that does all with the shape that is wanted most, or misses least."""
    found = [run for run in runs if run.search.polishing.found]
    if found:
        best = [best_of(run.part, run.search.polishing.designs)[0] for run in found]
        order: list[Run] = [found[index] for index in preferred_designs(best).tolist()]
        return next((run for run in order if run.does_all), order[0])
    with_shape = [run for run in runs if run.search.polishing.designs]
    return min(with_shape or runs, key=least_objective)


def least_objective(run: Run) -> float:
    """Return the objective of a run's best shape, a norm of its misses; infinite if it has none."""
    return min((objective(run.part, design) for design in run.search.polishing.designs), default=math.inf)
