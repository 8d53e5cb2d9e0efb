"""Where shapes miss some of all targets, or what is between them: searches that know these, too."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from synth.robot import Interval, JointLimits
from synth.synthesis.searching import Search
from synth.synthesis.starts import relative_misses
from synth.synthesis.wanted import Design, best_of, may_be_met, objective
from synth.synthesis.whole.for_all import WholeTask, for_all_targets
from synth.synthesis.whole.part import PART
from synth.task import PointTarget, TargetTable

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.robot import Arm
    from synth.task import Task
    from synth.watch import Watch

LED_BETWEEN = 3  # times that shapes are led to what they miss, or where nothing is proven
_A_FEW = 0.2  # share of the targets: of more a shape misses not only what is in a dead zone
_ANY_TURN = Interval(0.0, 2.0 * np.pi)
_MOST = 0.5  # share of what is missed
_STAY = 25  # targets of a part, where others are missed more by what was found for it
_ALIKE = 2e-3  # part by which a worst miss, squared, may be above the least there is
_BETWEEN, _STARTS_BETWEEN = 20, 6  # points that join the targets of a search; starts polished then


def led_to_missed(part: Task, whole: WholeTask, seed: int, watch: Watch) -> WholeTask:
    """Return designs that reach all targets, if where the best misses a few of them others do.

    A part may say nothing of where joint 1 has its dead zone: what is missed there joins it. What is missed
    because the targets lie on no workspace would only draw the search aside.

    Args:
        part: The task of few targets that they were found for.
        whole: The designs, with the task of all targets.
        seed: Seed of the search.
        watch: When it is up, the designs are left as they are.
    """
    task, best = whole.task, whole
    for number in range(LED_BETWEEN):
        if not best.designs or best.unseen or task.is_partial or watch.is_up():
            break
        check = best.designs[0].verification
        missed = ~np.array(check.within_tolerance)
        if check.found or np.mean(missed) > _A_FEW:
            break
        if not (may_be_met(task, best.designs) or _limits_keep(best.designs[0].arm, task, missed)):
            break
        with watch.on("solving"):
            part, beside = led_to(part, best.designs, task.table.positions[missed], seed + number, watch)
        best = for_all_targets(task, beside, seed, watch)
    return best if best.designs and best.designs[0].verification.found else whole


def _limits_keep(arm: Arm, task: Task, missed: NDArray[np.bool_]) -> bool:
    """Whether it is the joint limits that keep an arm from most of what it misses."""
    unlimited = replace(arm, robot=replace(arm.robot, joint_limits=JointLimits(_ANY_TURN, _ANY_TURN)))
    misses = unlimited.closest_joints(task.table.positions[missed])[1]
    return bool(np.mean(misses <= task.tolerances[missed]) > _MOST)


def led_to_binding(whole: WholeTask, seed: int, watch: Watch) -> WholeTask:
    """Return designs that a search for the least worst miss found, which knows the targets that bind.

    The least worst miss of a part is no more than that of all. So a shape that has about as much for all is
    one of the least, as far as the search tells; until then what it misses most joins the part.

    Args:
        whole: The designs, with the task of all targets.
        seed: Seed of the search.
        watch: When it is up, the designs are left as they are.
    """
    task, best, chosen = whole.task, whole, None
    if not best.designs or best.unseen or task.is_partial:
        return whole
    arm = best.designs[0].arm
    for number in range(LED_BETWEEN):
        if best.designs[0].verification.found or watch.is_up():
            break
        chosen = _binding(task, arm, chosen)
        part = task.asking_for(task.table.take(chosen))
        search = Search(part, seed + number, watch, lambda: False, alternatives=0)
        with watch.on("solving"):
            search.run()
        beside = best_of(part, search.polishing.designs, watch.is_up)
        led = for_all_targets(task, beside, seed, watch)
        if not led.designs or led.unseen:
            break
        arm, least = beside[0].arm, objective(part, beside[0])
        best = min(best, led, key=lambda each: objective(task, each.designs[0]))
        if objective(task, best.designs[0]) <= (1.0 + _ALIKE) * least:
            break
    return best


def _binding(task: Task, arm: Arm, chosen: NDArray[np.intp] | None) -> NDArray[np.intp]:
    """Return which targets say most of the worst miss: those that an arm misses most.

    Args:
        task: The task with all its targets.
        arm: The robot in a shape.
        chosen: Those that it was found for, most of which stay; None if these say nothing of the worst miss.
    """
    relative = relative_misses(task, arm)
    order = np.argsort(-relative, kind="stable")
    if chosen is None:
        return np.sort(order[:PART])
    stay = chosen[np.argsort(-relative[chosen], kind="stable")[:_STAY]]
    return np.union1d(stay, order[: PART - _STAY])


def led_to(
    part: Task, designs: Sequence[Design], points: FloatArray, seed: int, watch: Watch
) -> tuple[Task, list[Design]]:
    """Return the part with points that shapes miss, or of which nothing is proven, and shapes led there, too.

    Mostly a shape that covers all samples ends short of a surface's edge: there joint 1 has its dead zone.
    Without points other shapes are looked for.

    Args:
        part: The task of few targets that the shapes were found for.
        designs: The shapes.
        points: The points in the task frame, shape (k, 3), m: of very many, some.
        seed: Seed of the random shapes.
        watch: Its time.
    """
    if not len(points):
        search = Search(part, seed + 1, watch, lambda: False)
        search.run(_STARTS_BETWEEN)
        return part, list(best_of(part, search.polishing.designs, watch.is_up))
    some = points[np.random.default_rng([seed, 15]).permutation(len(points))[:_BETWEEN]]
    first = len(part.targets)
    more = [
        PointTarget(f"between the samples {first + number}", point, float(part.tolerances.min()))
        for number, point in enumerate(some, start=1)
    ]
    task = part.asking_for(part.table.followed_by(TargetTable.of(more)))
    search = Search(task, seed, watch, lambda: False, alternatives=0)
    if not search.follow(designs):
        search.run(_STARTS_BETWEEN)
    return task, list(best_of(task, search.polishing.designs, watch.is_up))
