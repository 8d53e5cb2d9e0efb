"""From shapes found for a part of very many targets to shapes that are verified with all of them."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from synth.synthesis.check import verify_targets
from synth.synthesis.starts import (
    SAMPLE,
    as_it_is_and_turned,
    best_covering,
    most_covered,
    random_part,
    refined_for_all,
    relative_misses,
)
from synth.synthesis.wanted import Design, best_of, may_be_met
from synth.synthesis.whole.levelling import least_worst, within_tolerances
from synth.task import Objective

if TYPE_CHECKING:
    from collections.abc import Sequence

    from synth.robot import Arm
    from synth.task import Task
    from synth.watch import Watch

# Targets of all shapes together that are looked at where the search knew only a part of them.
_VERIFIED_AT_MOST = 20_000
_FIRST = 2_000  # of them are verified first, to see how long one takes
_OF_TIME_LEFT = 0.8  # in which others are
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
            arm = _improved(task, found, watch)
        watch.tell(phase="verifying with all targets")
        with watch.on("verifying"):
            seen, design = verified_in_time(task, arm, watch)
            # The steps know neither floor nor obstacles.
            if not design.verification.possible and arm is not found:
                seen, design = verified_in_time(task, found, watch)
        if not any(each.verification.found for each in verified):
            design = _met(task, design, found, watch)
        unseen = design.verification.unseen
        if not design.verification.possible:
            whole.blocked.append(design)
        elif not unseen:
            verified.append(design)
        elif not verified:
            return replace(whole, task=seen, designs=best_of(seen, [design], watch.is_up))
    return replace(whole, designs=best_of(task, verified, watch.is_up))


def _improved(task: Task, found: Arm, watch: Watch) -> Arm:
    """Return an arm that was found for a part of the targets, improved for all by the task's objective."""
    if task.is_partial:
        return best_covering(task, found, watch)
    squares = refined_for_all(task, found, watch)
    if task.objective is Objective.LEAST_SQUARES:
        return squares
    # They may be in different valleys of the worst miss.
    levelled = [least_worst(task, each, watch) for each in (found, squares)]
    return min(levelled, key=lambda each: float(relative_misses(task, each).max()))


def _met(task: Task, design: Design, found: Arm, watch: Watch) -> Design:
    """Return a design that meets all targets, if it does not and one like it may; else the design itself."""
    check = design.verification
    if task.is_partial or check.unseen or check.found or watch.is_up() or not may_be_met(task, [design]):
        return design
    with watch.on("solving"):
        arm = within_tolerances(task, design.arm, found, watch)
    if arm is design.arm:
        return design
    with watch.on("verifying"):
        met = Design(arm, verify_targets(task, arm))
    return met if met.verification.found else design


def ranked(task: Task, arms: Sequence[Arm], seed: int, watch: Watch) -> list[Arm]:
    """Return arms that were found for a part of the targets, best for a larger part first.

    A part may say nothing of where the dead zone of joint 1 should be. So where an arm misses targets, one
    that is turned about axis 1 stands beside it.

    Args:
        task: The task with all its targets.
        arms: The arms in shapes of equal arcs, the best for the part first.
        seed: The same larger part for the same seed.
        watch: When it is up, the other arms are left out.
    """
    some = random_part(task, SAMPLE, seed)
    missing: list[tuple[float, Arm]] = []
    reaching: list[Arm] = []
    for arm in arms:
        if (reaching or missing) and watch.is_up():
            break
        watch.tell(phase="looking at more targets")
        seen = most_covered(some, arm) if some.is_partial else some
        for candidate in as_it_is_and_turned(seen, arm, watch):
            relative = relative_misses(seen, candidate)
            if np.all(relative <= np.sqrt(seen.weights)):
                reaching.append(candidate)
            else:
                missing.append((float(np.mean(relative**2)), candidate))
    return [*reaching, *(arm for _, arm in sorted(missing, key=lambda pair: pair[0]))]


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
