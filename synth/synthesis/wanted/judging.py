"""Shapes judged: their ways and their figures, at the joint angles that suit these best."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from synth.synthesis.check import verify_targets, what_counts
from synth.synthesis.wanted.figures import Figures
from synth.synthesis.wanted.forgiveness import hand_forgiveness
from synth.synthesis.wanted.margins import Margins
from synth.synthesis.wanted.ways import MOST_MOTIONS, motions, routed
from synth.watch import never

if TYPE_CHECKING:
    from collections.abc import Callable

    from synth.robot import LinkShape
    from synth.synthesis.wanted.design import Design
    from synth.synthesis.wanted.forgiveness import Forgiveness
    from synth.synthesis.wanted.motion import Motion
    from synth.task import Task


def judged(task: Task, design: Design, is_up: Callable[[], bool] = never) -> Design:
    """Return a design with its ways and its figures, at the joint angles that suit these best.

    Args:
        task: The task.
        design: The design, verified for the task.
        is_up: Asked whether to leave out the ways of one that misses a target, of which nobody is told, and
            to look for no more ways around obstacles.
    """
    if design.figures is not None:
        return design
    ways: tuple[Motion, ...] = ()
    if (
        len(task.targets) <= MOST_MOTIONS
        and not task.is_partial
        and (design.verification.found or not is_up())
    ):
        ways, joints = routed(task, design, is_up)
        if not np.array_equal(joints, design.verification.joints):
            design = replace(design, verification=verify_targets(task, design.arm, joints, keep=True))
    arm = design.arm
    counting, check = what_counts(task, arm, design.verification)
    margins = Margins.of(arm, check.joints, check.clearances)
    swings = [float(np.ptp(way.joints, axis=0).max()) for way in ways if way.found]
    figures = Figures(
        ways_missing=sum(not way.found for way in ways),
        margins=margins,
        shortfall=margins.shortfall(Margins.wanted(task.robot)),
        forgiveness=hand_forgiveness(counting, arm, check.joints),
        largest_swing=max(swings, default=0.0),
        travel=sum((way.travel for way in ways), 0.0),
        bend=arm.shape.bending_energy,
        change=None if task.current is None else _change(arm.shape, task.current),
    )
    return replace(design, ways=ways, figures=figures)


@lru_cache(maxsize=8)
def ways_and_forgiveness(task: Task, design: Design) -> tuple[tuple[Motion, ...], Forgiveness | None]:
    """Return what a person is told of a shape beside its misses, looked for if it was not judged: but once.

    Args:
        task: The task.
        design: The shape, verified for it.

    Returns:
        How the arm gets from each target to the next, nothing of many; and what becomes of the task after a
        hand placed the link. For a shape that misses a target neither.
    """
    check, figures = design.verification, design.figures
    if not check.found:
        return (), None
    ways = motions(task, design) if len(task.targets) <= MOST_MOTIONS and not task.is_partial else ()
    if figures:
        return ways, figures.forgiveness
    counting, check = what_counts(task, design.arm, check)
    return ways, hand_forgiveness(counting, design.arm, check.joints)


def _change(shape: LinkShape, present: LinkShape) -> float:
    """Return the root mean square distance of a link from another one, m."""
    share = np.linspace(0.0, 1.0, 50)
    moved = shape.point_at(share * shape.length) - present.point_at(share * present.length)
    return math.sqrt(float(np.mean(np.sum(moved**2, axis=1))))
