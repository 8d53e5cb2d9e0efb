"""The figures of a shape by which a person would choose: ways, margins, forgiveness, travel, bend."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from synth.synthesis.check import verify
from synth.synthesis.wanted.forgiveness import Forgiveness, hand_forgiveness
from synth.synthesis.wanted.margins import Margins
from synth.synthesis.wanted.ways import MOST_MOTIONS, routed
from synth.watch import never

if TYPE_CHECKING:
    from collections.abc import Callable

    from synth.robot import LinkShape
    from synth.synthesis.wanted.design import Design
    from synth.synthesis.wanted.ways import Motion
    from synth.task import Task


@dataclass(frozen=True)
class Figures:
    """What a shape is like to work with.

    Attributes:
        ways_missing: From how many targets no way was found to the next one; 0 where nobody asks, because
            there are too many targets.
        margins: Distances from the limits, with the joint angles that the ways take.
        shortfall: What is missing of the margins that a shape should have, each as a share of it, summed.
        forgiveness: What the targets miss by after a hand placed the link.
        largest_swing: The most that a joint turns on the way from a target to the next, rad.
        travel: Of the joint that turns more, over all ways, rad.
        bend: Integral of curvature squared along the link, 1/m.
        change: Root mean square distance of the link from its present shape, m; None if the task names none.
    """

    ways_missing: int
    margins: Margins
    shortfall: float
    forgiveness: Forgiveness
    largest_swing: float
    travel: float
    bend: float
    change: float | None


def judged(task: Task, design: Design, is_up: Callable[[], bool] = never) -> Design:
    """Return a design with its ways and its figures, at the joint angles that suit these best.

    Args:
        task: The task.
        design: The design, verified for the task.
        is_up: Asked whether to leave out the ways of one that misses a target: nobody is told of them.
    """
    if design.figures is not None:
        return design
    ways: tuple[Motion, ...] = ()
    if len(task.targets) <= MOST_MOTIONS and (design.verification.found or not is_up()):
        ways, joints = routed(task, design)
        if not np.array_equal(joints, design.verification.joints):
            design = replace(design, verification=verify(task, design.arm, joints, keep=True))
    arm, check = design.arm, design.verification
    margins = Margins.of(arm, check.joints, check.clearances)
    swings = [float(np.ptp(way.joints, axis=0).max()) for way in ways if way.found]
    figures = Figures(
        ways_missing=sum(not way.found for way in ways),
        margins=margins,
        shortfall=margins.shortfall(Margins.wanted(task.robot)),
        forgiveness=hand_forgiveness(task, arm, check.joints),
        largest_swing=max(swings, default=0.0),
        travel=sum(way.travel for way in ways),
        bend=arm.shape.bending_energy,
        change=None if task.current is None else _change(arm.shape, task.current),
    )
    return replace(design, ways=ways, figures=figures)


def _change(shape: LinkShape, present: LinkShape) -> float:
    """Return the root mean square distance of a link from another one, m."""
    share = np.linspace(0.0, 1.0, 50)
    moved = shape.point_at(share * shape.length) - present.point_at(share * present.length)
    return math.sqrt(float(np.mean(np.sum(moved**2, axis=1))))
