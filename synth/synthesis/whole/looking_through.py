"""What shapes found for a part of a task do of all that is asked: every target, and what is between them."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from synth.synthesis.check import proven_between
from synth.synthesis.wanted import Design, best_of
from synth.synthesis.whole.for_all import WholeTask, for_all_targets
from synth.synthesis.whole.leading import LED_BETWEEN, led_to, led_to_binding, led_to_missed
from synth.task import Objective

if TYPE_CHECKING:
    from collections.abc import Sequence

    from synth.task import Task
    from synth.watch import Watch

_PROVEN_BETWEEN = 3  # shapes that are told where surfaces and paths are to be looked at between samples


def looked_through(task: Task, part: Task, known: Sequence[Design], seed: int, watch: Watch) -> WholeTask:
    """Return what is known for a part of a task as what it is for all that is asked.

    Args:
        task: The task with all its targets.
        part: The task of few targets that the designs were found for; the task itself if it has no more.
        known: These designs.
        seed: Seed of what is searched for beside them.
        watch: When it is up, as little more is looked at as may be.
    """
    best = best_of(part, known, watch.is_up)
    if part is task:
        return proven_whole(part, WholeTask(task, best), seed, watch)
    whole = for_all_targets(task, _and_others(best, known), seed, watch)
    if task.objective is Objective.MINIMAX:
        led = led_to_binding(whole, seed, watch)
    else:
        led = led_to_missed(part, whole, seed, watch)
    led = replace(led, blocked=whole.blocked)
    return proven_whole(part, led, seed, watch)


def _and_others(best: tuple[Design, ...], known: Sequence[Design]) -> tuple[Design, ...]:
    """Return designs, and behind them those that are like one of them for a part of the targets.

    For all targets they may not be: one has its dead zone where no target is, or nearly so.
    """
    taken = {id(design.arm) for design in best}
    return (*best, *(design for design in known if id(design.arm) not in taken))


def proven_whole(part: Task, whole: WholeTask, seed: int, watch: Watch) -> WholeTask:
    """Return designs, one first whose surfaces and paths are proven between samples, if there is one.

    Args:
        part: The task of few targets that they were found for.
        whole: The designs, with the task of all targets.
        seed: Seed of the search for shapes that cover what is between samples, where the first do not.
        watch: When it is up, nothing finer is looked at.
    """
    if not (whole.task.surfaces or whole.task.paths) or whole.unseen:
        return whole
    task = whole.task
    proven = led = _proven_first(task, whole.designs, watch)
    for number in range(LED_BETWEEN):
        if not led or led[0].verification.found or watch.is_up():
            break
        if not (led[0].verification.between or led[0].verification.followed):
            break
        unproven = [each.unproven for each in led[0].verification.between]
        points = np.concatenate([np.empty((0, 3)), *unproven])
        with watch.on("solving"):
            part, beside = led_to(part, led, points, seed + number, watch)
        led = _proven_first(task, for_all_targets(task, beside, seed, watch).designs, watch)
    return replace(whole, designs=led if led and led[0].verification.found else proven)


def only_proven(task: Task, design: Design) -> Design:
    """Return a design; of one that was looked at only at samples, where more matters, all is not reached."""
    check = design.verification
    joined = any(surface.samples.are_joined for surface in task.surfaces)
    if (joined and not check.between) or (task.paths and not check.followed):
        return replace(design, verification=replace(check, reaches_all=False))
    return design


def _proven_first(task: Task, designs: tuple[Design, ...], watch: Watch) -> tuple[Design, ...]:
    """Return the first few designs with what is proven of each, those first that do what they should."""
    with watch.on("verifying"):
        proven = [
            replace(each, verification=proven_between(task, each.arm, each.verification, watch))
            for each in designs[:_PROVEN_BETWEEN]
        ]
    return tuple(sorted(proven, key=lambda each: not each.verification.found))
