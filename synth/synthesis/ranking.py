"""Which of the shapes found is the best, and which others are worth telling."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from synth.task import Objective

if TYPE_CHECKING:
    from collections.abc import Sequence

    from synth.robot import LinkShape
    from synth.synthesis.solution import Design
    from synth.task import Task

_ALTERNATIVES = 8
# Shapes whose objective is above this multiple of the best one's are no alternatives to it.
_COMPARABLE = 1.5
# A shape that uses less than this part of every tolerance meets the targets exactly: what it misses is
# the price of the gentlest bend.
_EXACTLY = 2e-3
# Two shapes nearer than this all along, m, are one: a hand places the link to 9.6 +- 2.1 mm (Ranne,
# Clark and Rojas, 2022).
_SAME_SHAPE = 0.010
_MISSING = 2  # the kind of those that miss a target


def rank(task: Task, design: Design) -> tuple[int, float]:
    """Return what is smaller for a better design.

    First those that meet every target exactly, then those that do within its tolerance, both by their
    gentleness or, if the task names the present shape, by how little they change it; then the others by
    the task's objective.
    """
    check = design.verification
    relative = check.misses / task.tolerances
    if check.found:
        return int(relative.max() > _EXACTLY), _effort(task, design.arm.shape)
    weighted = task.weights * relative**2
    return _MISSING, float(weighted.max() if task.objective is Objective.MINIMAX else weighted.sum())


def _effort(task: Task, shape: LinkShape) -> float:
    """Return how far the link moves from its present shape, m^2 in the mean, or else its bending energy."""
    if task.current is None:
        return shape.bending_energy
    share = np.linspace(0.0, 1.0, 50)
    moved = shape.point_at(share * shape.length) - task.current.point_at(share * task.current.length)
    return float(np.mean(np.sum(moved**2, axis=1)))


def best_of(task: Task, designs: Sequence[Design]) -> tuple[Design, ...]:
    """Return the best designs in order, each different from those before by more than a hand can tell.

    Beside a found design only found ones count, beside a best effort those that miss nearly as little.
    """
    kept: list[Design] = []
    for design in sorted(designs, key=lambda design: rank(task, design)):
        if kept and not _comparable(rank(task, design), rank(task, kept[0])):
            break
        if all(_difference(design, other) > _SAME_SHAPE for other in kept):
            kept.append(design)
    return tuple(kept[:_ALTERNATIVES])


def _comparable(one: tuple[int, float], best: tuple[int, float]) -> bool:
    if best[0] < _MISSING:
        return one[0] < _MISSING
    return one[1] <= _COMPARABLE * best[1]


def _difference(one: Design, other: Design) -> float:
    """Return the largest distance between two robots: along their links, on axis 2, at P5, m."""
    points = []
    for arm in (one.arm, other.arm):
        link = arm.shape.point_at(np.linspace(0.0, arm.shape.length, 20))
        points.append(
            np.vstack([link, arm.axis_points, arm.base.to_base(arm.forward_kinematics(0.0, np.pi))])
        )
    return float(np.linalg.norm(points[0] - points[1], axis=1).max())
