"""What blocks a task that cannot be met, and what would release it: found by relaxing each limit in turn.

A limit blocks if the task is met once that limit alone is relaxed far enough; the amount is then found by
tightening it again, halving after halving, each time with a shape that is verified. So every release is
certain to do; that a smaller one would not is not certain, nor that a limit that is not named could not.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from synth.checks import refuse_unless
from synth.rounding import rounded_up
from synth.synthesis.base_moved import base_moved
from synth.synthesis.check import verify
from synth.synthesis.relaxed_limits import limits_of, without_limits
from synth.synthesis.solution import Release, Solution
from synth.synthesis.solve import follow
from synth.synthesis.starts import exact_arms
from synth.watch import Watch

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from synth.synthesis.relaxed_limits import Limit
    from synth.synthesis.wanted import Design
    from synth.watch import Progress

# How far a limit is relaxed, as a share of the most, and how many starts are polished then.
_RELAXED = ((0.04, 8), (0.25, 8), (1.0, 6))
_RESOLUTION = 0.03  # of an amount
_NOTHING = 1e-6  # of a limit


def explain(
    solution: Solution,
    *,
    time_limit: float = math.inf,
    stop: Callable[[], bool] | None = None,
    progress: Callable[[Progress], None] | None = None,
) -> Solution:
    """Return a solution with what would release its task, if it was not met; it takes some seconds.

    Args:
        solution: What a synthesis found; of one that found every target nothing blocks.
        time_limit: Time after which what is known so far is returned, s.
        stop: Polled many times a second; return True to stop with what is known so far.
        progress: Told of each limit that is looked at, and many times a second that it goes on.

    Returns:
        The same with `releases`, one for each limit that does alone, the least change first, the base
        last. Where there are none, `notes` says whether all of them together would do; if the time was up,
        how far the search got. Should a shape turn up that meets the task as it is, the solution with
        this shape.
    """
    refuse_unless("solution", solution, Solution)
    if solution.found:
        return solution
    task, places = solution.task, solution.task.places
    # Of a base that is free it is asked what blocks the task where it stands; `base_moved` looks elsewhere.
    solution = replace(solution, task=task.standing_at(task.base))
    # What is begun is still verified when the time is up, which takes as long as it took before.
    watch = Watch(max(time_limit - solution.time.verifying, 0.0), stop=stop, report=progress)
    found, limits = [], tuple(limits_of(solution.task))
    # Of a surface it is mostly the base; else all around it is searched only where nothing else helps.
    moved = _base(solution, watch, far=True) if solution.task.surfaces else None
    looked_at = []
    for limit in limits:
        watch.tell(phase=f"relaxing: {limit.name}")
        if watch.is_up():
            break
        release = _released(limit, solution, watch)
        if release is not None and release.share < _NOTHING:
            met = follow(solution.task, [release.design], seed=solution.seed, watch=watch.aside())
            return replace(met, task=replace(met.task, places=places))
        if release is not None:
            found.append(release)
        if not watch.is_up():
            looked_at.append(limit.name)
    found.sort(key=lambda release: release.share)
    moved = _base(solution, watch, far=not found) if not solution.task.surfaces else moved
    releases = tuple(found if moved is None else [*found, moved])
    watch.tell(phase="relaxing all limits together")
    notes = [] if releases or watch.is_up() else [_why_none_does(solution, watch)]
    if watch.interrupted:
        notes = [_how_far(looked_at, [limit.name for limit in limits])]
    notes = [*solution.notes, *notes]
    return replace(solution, task=task, releases=releases, notes=tuple(notes), explained=True)


def _base(solution: Solution, watch: Watch, *, far: bool) -> Release | None:
    watch.tell(phase="moving the base")
    return None if watch.is_up() else base_moved(solution, watch, far=far)


def _how_far(looked_at: Sequence[str], names: Sequence[str]) -> str:
    """Return a sentence about a search for releases that ended early."""
    done = f"{len(looked_at)} of {len(names)} limits were looked at in full"
    listed = f" ({', '.join(dict.fromkeys(looked_at))})" if looked_at else ""
    return f"the search for what would release the task was stopped early: {done}{listed}; others may do, too"


def _why_none_does(solution: Solution, watch: Watch) -> str:
    """Return a sentence where no single change does: do several together, or does the surface not fit?

    That no surface at all fits is proven where algebra says so; else the nearest one found is told.
    """
    none = "neither one limit relaxed alone nor another place of the base was found that would do"
    free = follow(without_limits(solution.task), solution.designs, starts=_RELAXED[0][1], watch=watch.aside())
    if not free.designs:
        return f"{none}, nor any shape at all with all limits relaxed together"
    if free.found:
        return f"{none}; with all limits relaxed together the task is met, so several of them block it"
    nearest = rounded_up(float(free.best.verification.misses.max()), digits=2)
    no_arm = _algebra_knows_none(solution)
    passes = "by algebra none passes exactly" if no_arm else "none was found that passes"
    return (
        f"{none}, nor all limits relaxed together: the workspace of an arm of two joints is one surface of "
        f"revolution about axis 1, and {passes} through all the targets with this rigid link; "
        f"the nearest one found misses none by more than {nearest} mm"
    )


def _algebra_knows_none(solution: Solution) -> bool:
    """Whether no arm with this rigid link reaches the targets exactly, whatever its link: a proof."""
    return exact_arms(solution.task) == ()


def _released(limit: Limit, solution: Solution, watch: Watch) -> Release | None:
    """Relax one limit more and more, then tighten it: as far as a shape allows, then as shapes follow."""
    for share, starts in _RELAXED:
        most = share * limit.most
        designs = follow(limit.relaxed(most), solution.designs, starts=starts, watch=watch.aside()).designs
        needs = [_needed(limit, design, most, watch) for design in designs]
        if needs and min(needs) < math.inf:
            break
    else:
        return None
    best = int(np.argmin(needs))
    too_little, enough, design = 0.0, needs[best], designs[best]
    while enough - too_little > _RESOLUTION * enough and not watch.is_up():
        amount = 0.5 * (too_little + enough)
        followed = follow(limit.relaxed(amount), [design], watch=watch.aside())
        if followed.found:
            enough, design = amount, followed.best
        else:
            too_little = amount
    return Release(
        limit.name,
        float(enough),
        float(enough / limit.scale),
        limit.sentence(enough),
        design,
        limit.relaxed(enough),
    )


def _needed(limit: Limit, design: Design, most: float, watch: Watch) -> float:
    """Return the amount by which a limit has to give way for one shape, infinite if that does not help it."""
    if not design.verification.found:
        return math.inf

    def does(amount: float) -> bool:
        task = limit.relaxed(amount)
        return verify(task, replace(design.arm, robot=task.robot), design.verification.joints).found

    if does(0.0):
        return 0.0
    too_little, enough = 0.0, most
    while enough - too_little > 0.1 * _RESOLUTION * enough and not watch.is_up():
        amount = 0.5 * (too_little + enough)
        if does(amount):
            enough = amount
        else:
            too_little = amount
    return enough
