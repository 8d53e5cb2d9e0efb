"""From shapes found for a part of very many targets to shapes that are verified with all of them."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from synth.robot import Interval, JointLimits
from synth.synthesis.check import proven_between, verify_targets
from synth.synthesis.many_targets import least_worst, led_to, ranked, within_tolerances
from synth.synthesis.starts import best_covering, random_part, refined_for_all
from synth.synthesis.wanted import Design, best_of, may_be_met
from synth.task import Objective

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from synth.robot import Arm
    from synth.task import Task
    from synth.watch import Watch

# Targets of all shapes together that are looked at where the search knew only a part of them.
_VERIFIED_AT_MOST = 20_000
_FIRST = 2_000  # of them are verified first, to see how long one takes
_OF_TIME_LEFT = 0.8  # in which others are
_LED_BETWEEN = 3  # times that shapes are led to what they miss, or where nothing is proven
_A_FEW = 0.2  # share of the targets: of more a shape misses not only what is in a dead zone
_ANY_TURN = Interval(0.0, 2.0 * np.pi)
_MOST = 0.5  # share of what is missed
_PROVEN_BETWEEN = 3  # shapes that are told where surfaces and paths are to be looked at between samples
_COVERING = 3  # shapes that are looked at where a part of a surface may be left


@dataclass
class WholeTask:
    """Shapes for all targets of a task.

    Attributes:
        task: The task with all its targets; where there was no time to look at all of them, with those that
            the designs are verified with.
        designs: The shapes that the hardware can take, in order.
        blocked: Those that it cannot.
    """

    task: Task
    designs: tuple[Design, ...] = ()
    blocked: list[Design] = field(default_factory=list)

    @property
    def unseen(self) -> int:
        """How many targets there was no time to look at."""
        return self.designs[0].verification.unseen if self.designs else 0

    @property
    def note(self) -> str:
        """What is to be said of targets that were not looked at; nothing if there are none."""
        if not self.unseen:
            return ""
        count = len(self.task.targets)
        return (
            f"only {count} of {count + self.unseen} targets, chosen at random, were looked at in the time: "
            "what is said of the shape is said of these alone"
        )


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
    led = replace(led_to_missed(part, whole, seed, watch), blocked=whole.blocked)
    return proven_whole(part, led, seed, watch)


def _and_others(best: tuple[Design, ...], known: Sequence[Design]) -> tuple[Design, ...]:
    """Return designs, and behind them those that are like one of them for a part of the targets.

    For all targets they may not be: one has its dead zone where no target is, or nearly so.
    """
    taken = {id(design.arm) for design in best}
    return (*best, *(design for design in known if id(design.arm) not in taken))


def for_all_targets(task: Task, designs: Sequence[Design], seed: int, watch: Watch) -> WholeTask:
    """Return designs improved for all targets, and verified with them or with as many as there is time for.

    Args:
        task: The task with all its targets.
        designs: Shapes that were found for a part of them, the best first.
        seed: As for `ranked`.
        watch: When it is up one shape is still verified, if only with some of the targets.
    """
    if task.is_partial:  # each is verified several times: what is in the way is left rather than outliers
        designs = designs[:_COVERING]
    with watch.on("solving"):
        arms = ranked(task, [design.arm for design in designs], seed, watch)
    whole = WholeTask(task)
    verified: list[Design] = []
    for found in arms[: max(1, _VERIFIED_AT_MOST // len(task.targets))]:
        if verified and watch.is_up():
            break
        with watch.on("solving"):
            if task.is_partial:
                arm = best_covering(task, found, watch)
            else:
                arm = refined_for_all(task, found, watch)
                if task.objective is Objective.MINIMAX:
                    arm = least_worst(task, arm, watch)
                else:
                    arm = within_tolerances(task, arm, found, watch)
        watch.tell(phase="verifying with all targets")
        with watch.on("verifying"):
            seen, design = verified_in_time(task, arm, watch)
            # The steps know neither floor nor obstacles.
            if not design.verification.possible and arm is not found:
                seen, design = verified_in_time(task, found, watch)
        unseen = design.verification.unseen
        if not design.verification.possible:
            whole.blocked.append(design)
        elif not unseen:
            verified.append(design)
        elif not verified:
            return replace(whole, task=seen, designs=best_of(seen, [design], watch.is_up))
    return replace(whole, designs=best_of(task, verified, watch.is_up))


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
    for number in range(_LED_BETWEEN):
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
    for number in range(_LED_BETWEEN):
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


def verified_in_time(task: Task, arm: Arm, watch: Watch) -> tuple[Task, Design]:
    """Verify a shape with all targets, or at random with as many as there is time for, some 2000 at least.

    Returns:
        The task with the targets that were looked at, and the design; it counts as found only if these are
        all.
    """
    first = random_part(task, _FIRST, 0)
    if first is task or watch.remaining == np.inf:
        return task, Design(arm, verify_targets(task, arm))
    began = watch.elapsed
    check = verify_targets(first, arm)
    spent = watch.elapsed - began
    count = len(task.targets)
    if _OF_TIME_LEFT * watch.remaining * _FIRST >= spent * count:
        return task, Design(arm, verify_targets(task, arm))
    affordable = int(_OF_TIME_LEFT * watch.remaining * _FIRST / spent)
    if affordable > _FIRST:
        first = random_part(task, affordable, 0)
        check = verify_targets(first, arm)
    return first, Design(arm, replace(check, unseen=count - len(first.targets)))
