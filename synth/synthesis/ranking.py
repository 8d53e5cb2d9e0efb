"""Which of the shapes found is the best, and which others are worth telling.

Among shapes that reach every target the order is that of `preference`, and it stands nowhere else.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from synth.synthesis.figures import judged
from synth.task import Objective

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike

    from synth.synthesis.figures import Figures
    from synth.synthesis.solution import Design
    from synth.task import Task

_ALTERNATIVES = 8
# Shapes whose objective is above this multiple of the best one's are no alternatives to it.
_COMPARABLE = 1.5
# Two shapes nearer than this all along, m, are one: a hand places the link to 9.6 +- 2.1 mm (Ranne,
# Clark and Rojas, 2022).
_SAME_SHAPE = 0.010
# Figures are compared in steps, so that neither noise nor a trifle of one decides over the next: of a margin;
# of a swing, rad, above what is calm; of the expected worst miss, m; of travel, rad.
_MARGIN_STEP, _SWING_STEP, _MISS_STEP, _TRAVEL_STEP = 0.1, math.radians(15.0), 0.5e-3, math.radians(10.0)
_LESS_MARGIN = 5  # steps of margin that an alternative may have less
_CALM = math.radians(120.0)


def preference(
    ways_missing: ArrayLike,
    shortfall: ArrayLike,
    largest_swing: ArrayLike,
    expected_worst_miss: ArrayLike,
    travel: ArrayLike,
    bend: ArrayLike,
) -> tuple[ArrayLike, ...]:
    """Return what is smaller for a shape that a person would rather have, the first that differs decides.

    1. Ways lead from every target to the next.
    2. It keeps off the limits: of joints, length, bend, and of obstacles.
    3. No joint swings by much more than 120 deg between two targets.
    4. It forgives the hand that bends it.
    5. The joints travel little.
    6. The link is bent gently.

    Args: as the fields of `Figures`; numbers, or arrays of many shapes.
    """
    return (
        ways_missing,
        np.round(np.divide(shortfall, _MARGIN_STEP)),
        np.ceil(np.maximum(np.subtract(largest_swing, _CALM), 0.0) / _SWING_STEP),
        np.round(np.divide(expected_worst_miss, _MISS_STEP)),
        np.round(np.divide(travel, _TRAVEL_STEP)),
        bend,
    )


def rank(figures: Figures) -> tuple[float, ...]:
    """Return what is smaller for a better one of the shapes that reach every target.

    If the task names the present shape, that is the one which changes it least, once it has all ways.
    """
    ways_missing, *others = preference(
        figures.ways_missing,
        figures.shortfall,
        figures.largest_swing,
        figures.forgiveness.expected_worst_miss,
        figures.travel,
        figures.bend,
    )
    return tuple(float(x) for x in (ways_missing, figures.change or 0.0, *others))


def objective(task: Task, design: Design) -> float:
    """Return the task's objective: the weighted (miss / tolerance)^2, summed or worst."""
    weighted = task.weights * (design.verification.misses / task.tolerances) ** 2
    return float(weighted.max() if task.objective is Objective.MINIMAX else weighted.sum())


def best_of(task: Task, designs: Sequence[Design]) -> tuple[Design, ...]:
    """Return the best designs in order, judged, each different from those before by more than a hand can tell.

    Those that reach every target are in the order of `rank`, and no others stand beside them; best efforts
    in the order of the task's objective, with those that miss nearly as little.
    """
    found = [judged(task, design) for design in designs if design.verification.found]
    if found:
        ranks = sorted((rank(design.figures), index) for index, design in enumerate(found))
        return _distinct([found[index] for each, index in ranks if _stands_beside(each, ranks[0][0])])
    misses = sorted((objective(task, design), index) for index, design in enumerate(designs))
    near = [designs[index] for value, index in misses if value <= _COMPARABLE * misses[0][0]]
    return tuple(judged(task, design) for design in _distinct(near))


def _stands_beside(other: tuple[float, ...], best: tuple[float, ...]) -> bool:
    """Return whether a shape is an alternative to the best one: with all its ways, and nearly its margins."""
    return other[0] <= best[0] and other[2] <= best[2] + _LESS_MARGIN


def _distinct(designs: Sequence[Design]) -> tuple[Design, ...]:
    """Return designs of which each differs from those before."""
    kept: list[Design] = []
    for design in designs:
        if all(_difference(design, other) > _SAME_SHAPE for other in kept):
            kept.append(design)
    return tuple(kept[:_ALTERNATIVES])


def _difference(one: Design, other: Design) -> float:
    """Return the largest distance between two robots: along their links, on axis 2, at P5, m."""
    points = []
    for arm in (one.arm, other.arm):
        link = arm.shape.point_at(np.linspace(0.0, arm.shape.length, 20))
        points.append(
            np.vstack([link, arm.axis_points, arm.base.to_base(arm.forward_kinematics(0.0, np.pi))])
        )
    return float(np.linalg.norm(points[0] - points[1], axis=1).max())
