"""From what a solution file holds of a shape to a design, verified again.

What the file says of the shape is not believed: the misses are computed again, and compared.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from synth.robot import Arm
from synth.rounding import told_apart
from synth.solution_file.task_reading import made, to_base, to_shape
from synth.synthesis import (
    Design,
    Figures,
    Forgiveness,
    Margins,
    Motion,
    verify,
    way_is_clear,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from synth.arrays import FloatArray
    from synth.files import Document, KeyPath
    from synth.solution_file.schema import ShapePart, TargetResultPart
    from synth.solution_file.told_schema import FiguresPart, WayPart
    from synth.synthesis import Verification
    from synth.task import Task

# What another processor's rounding may do to a miss, m, and to an angle, rad.
_ROUNDING = 1e-7
_MISTAKES_AT_MOST = 10


def to_design(
    document: Document,
    path: KeyPath,
    task: Task,
    read: ShapePart,
    told: Sequence[TargetResultPart],
    unseen: int = 0,
) -> Design | None:
    """Return a shape with what the independent check says of it, or None with the mistakes reported.

    Args:
        document: The document.
        path: Where in it the shape stands.
        task: The task that it is for.
        read: What stands there.
        told: What is told of the targets.
        unseen: How many targets more there were that nobody had looked at.
    """
    arm = made(document, path, lambda: _arm(task, read))
    if arm is None:
        return None
    check = replace(verify(task, arm, _joints(task, arm, told), keep=True), unseen=unseen)
    for violation in check.violations[:_MISTAKES_AT_MOST]:
        document.report((*path, "link"), f"is no shape that the hardware can take: {violation.sentence}")
    _compare(document, (*path, "targets"), task, check, told)
    ways = tuple(_ways(document, (*path, "ways"), task, arm, read.ways or ()))
    return Design(arm, check, ways, None if read.figures is None else _figures(read.figures))


def _arm(task: Task, read: ShapePart) -> Arm:
    arcs = read.link.arcs if read.link is not None else []
    base = task.base if read.base is None else to_base(read.base)
    return Arm(task.robot, to_shape(arcs), *read.d35_d45, base)


def _joints(task: Task, arm: Arm, told: Sequence[TargetResultPart]) -> FloatArray:
    """Return the joint angles told for each target; for a target of which none are told the closest ones."""
    index = {name: index for index, name in enumerate(task.table.names)}
    joints = np.full((len(index), 2), np.nan)
    for target in told:
        if target.joints is not None and target.name in index:
            joints[index[target.name]] = target.joints
    untold = np.isnan(joints[:, 0])
    if untold.any():
        joints[untold] = arm.closest_joints(task.table.positions[untold])[0]
    return joints


def _compare(
    document: Document, path: KeyPath, task: Task, check: Verification, told: Sequence[TargetResultPart]
) -> None:
    """Report targets of which the file does not tell what the check finds."""
    index = {name: index for index, name in enumerate(task.table.names)}
    for place, target in enumerate(told):
        if target.name not in index:
            document.report((*path, place, "name"), "is no target of the task")
        elif target.miss is not None:
            miss = float(check.misses[index[target.name]])
            if not abs(target.miss - miss) <= _ROUNDING:
                said, found = told_apart(target.miss, miss, digits=3)
                document.report((*path, place, "miss"), f"says {said} mm, but the shape misses by {found} mm")


def _ways(document: Document, path: KeyPath, task: Task, arm: Arm, ways: Sequence[WayPart]) -> list[Motion]:
    motions = []
    for place, way in enumerate(ways):
        motion = Motion(way.start, way.end, np.array(way.joints).reshape(-1, 2))
        if motion.found and not way_is_clear(task, arm, motion.joints):
            document.report((*path, place), "is not clear of everything within the limits of the joints")
        motions.append(motion)
    return motions


def _figures(read: FiguresPart) -> Figures:
    margins = {name: _or_infinite(value) for name, value in read.margins.model_dump().items()}
    hand = read.forgiveness
    return Figures(
        ways_missing=read.ways_missing,
        margins=Margins(**margins),
        shortfall=read.shortfall,
        forgiveness=Forgiveness(_or_infinite(hand.expected_worst_miss), hand.chance),
        largest_swing=read.largest_swing,
        travel=read.travel,
        bend=read.bend,
        change=read.change,
    )


def _or_infinite(value: float | None) -> float:
    return math.inf if value is None else value
