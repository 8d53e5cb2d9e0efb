"""Which of the shapes found is the best, and which others are worth telling.

Among shapes that reach every target the order is that of `preferences`, and it stands nowhere else.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from synth.synthesis.check import counted
from synth.synthesis.wanted.judging import judged
from synth.task import Objective
from synth.watch import never

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import ArrayLike, NDArray

    from synth.arrays import FloatArray
    from synth.synthesis.wanted.design import Design
    from synth.synthesis.wanted.figures import Figures
    from synth.task import Task

_ALTERNATIVES = 8
# Shapes whose objective is above this multiple of the best one's are no alternatives to it.
_COMPARABLE = 1.5
# Two shapes nearer than this all along, m, are one: a hand places the link to 9.6 +- 2.1 mm (Ranne,
# Clark and Rojas, 2022).
_SAME_SHAPE = 0.010
# A joint that swings by no more than this between two targets is calm, rad.
CALM = math.radians(120.0)
# What less than so much apart, of `preferences`, is as good: neither noise nor a trifle of one decides over
# the next. Ways; margins; m, as much as a hand is off; swings, rad; m; rad; 1/m.
STEPS = np.array([1.0, 0.1, 10e-3, math.radians(15.0), 0.5e-3, math.radians(10.0), 1e-9])
_WITH_END = [0, 1, 3]  # columns of `preferences` that have an end: all ways, all margins, calm
_LESS_MARGIN = 0.5  # that an alternative may have, as a share of all of one kind
_ROUNDING = 1e-9


def preferences(
    ways_missing: ArrayLike,
    shortfall: ArrayLike,
    largest_swing: ArrayLike,
    expected_worst_miss: ArrayLike,
    travel: ArrayLike,
    bend: ArrayLike,
) -> FloatArray:
    """Return what should be small in a shape, what matters most first, shape (..., 7).

    1. Ways lead from every target to the next.
    2. It keeps off the limits: of joints, length, bend, and of obstacles.
    3. It forgives the hand that bends it about as much as another does, to 10 mm.
    4. No joint swings by more than 120 deg between two targets.
    5. It forgives the hand more.
    6. The joints travel little.
    7. The link is bent gently.

    Args: as the fields of `Figures`; numbers, or arrays of many shapes.
    """
    excess = np.subtract(largest_swing, CALM)
    restless = np.where(excess > 0.0, excess + STEPS[3], 0.0)  # never as good as calm
    miss = expected_worst_miss
    columns = (ways_missing, shortfall, miss, restless, miss, travel, bend)
    return np.stack([np.asarray(column, dtype=np.float64) for column in columns], axis=-1)


def preferred(table: FloatArray, steps: FloatArray = STEPS) -> NDArray[np.intp]:
    """Return the order of shapes, the most wanted first, for rows of `preferences`, shape (N, 7).

    Column by column: of shapes that are alike so far, those within a step of the least are alike again, those
    within two come next.

    Args:
        table: The rows.
        steps: What less than so much apart is alike, one for each column.
    """
    alike = np.zeros(len(table), dtype=np.intp)
    for column, step in zip(table.T, steps, strict=True):
        least = np.full(len(table), np.inf)
        np.minimum.at(least, alike, column)
        behind = np.floor((column - least[alike]) / step + _ROUNDING)
        _, alike = np.unique(np.column_stack([alike, behind]), axis=0, return_inverse=True)
        alike = alike.ravel()
    return np.argsort(alike, kind="stable")


def leaves_no_wish(figures: Figures | None) -> bool:
    """Whether a shape has all ways, all margins, and calm joints on the ways."""
    return figures is not None and is_content(_row(figures))


def has_all_ways(figures: Figures | None) -> bool:
    """Whether a shape has a way from each target to the next."""
    return figures is not None and not figures.ways_missing


def is_content(row: FloatArray) -> bool:
    """Whether a row of `preferences` leaves nothing to wish for in ways, margins and swings."""
    return bool((row[_WITH_END] < STEPS[_WITH_END]).all())


def _row(figures: Figures) -> FloatArray:
    return preferences(
        figures.ways_missing,
        figures.shortfall,
        figures.largest_swing,
        figures.forgiveness.expected_worst_miss,
        figures.travel,
        figures.bend,
    )


def _order_of(table: FloatArray, changes: Sequence[float | None]) -> NDArray[np.intp]:
    """Return the order of shapes that reach every target.

    If the task names the present shape, the one that changes it least comes first, once it has all ways.

    Args:
        table: Rows of `preferences`.
        changes: How much each shape changes the present one, m, if the task names it.
    """
    if None in changes:
        return preferred(table)
    return np.lexsort([np.array(changes), table[:, 0]])


def objective(task: Task, design: Design) -> float:
    """Return the task's objective: the weighted (miss / tolerance)^2 of all that counts, summed or worst.

    What points farther beside the direction asked for than it may counts like a miss, by its own tolerance.
    """
    relative = (design.verification.misses / task.tolerances) ** 2
    if task.table.approaches is not None:
        allowed = task.table.approaches[:, 3]
        relative = relative + np.nan_to_num(np.maximum(design.verification.astray / allowed - 1.0, 0.0)) ** 2
    weighted = task.weights * relative
    if task.is_partial:
        weighted = weighted[counted(task, design.verification.misses)]
    return float(weighted.max() if task.objective is Objective.MINIMAX else weighted.sum())


def may_be_met(task: Task, designs: Sequence[Design]) -> bool:
    """Whether some shape may reach every target, as far as the least of the objective says.

    A shape that does has an objective of no more than that of misses which are all as large as their
    tolerances: so the objective's least must be, too.

    Args:
        task: The task.
        designs: Shapes, one of which has about the least objective there is.
    """
    weights = task.weights
    allowed = float(weights.max() if task.objective is Objective.MINIMAX else weights.sum())
    return min((objective(task, design) for design in designs), default=math.inf) <= allowed


def best_of(task: Task, designs: Sequence[Design], is_up: Callable[[], bool] = never) -> tuple[Design, ...]:
    """Return the best designs in order, judged; each differs from those before by more than a hand can tell.

    Those that reach every target are in the order of `preferences`, and no others stand beside them; best
    efforts are in the order of the task's objective, with those that miss nearly as little.

    Args:
        task: The task.
        designs: The designs, verified for it.
        is_up: As for `judged`.
    """
    found = [judged(task, design, is_up) for design in designs if design.verification.found]
    if found:
        figures = [design.figures for design in found if design.figures is not None]
        table = np.array([_row(each) for each in figures])
        order = _order_of(table, [each.change for each in figures])
        less_margin = _LESS_MARGIN if task.current is None else np.inf
        beside = _stand_beside(table, table[order[0]], less_margin)
        return _distinct([found[index] for index in order if beside[index]])
    misses = sorted((objective(task, design), index) for index, design in enumerate(designs))
    near = [designs[index] for value, index in misses if value <= _COMPARABLE * misses[0][0]]
    return tuple(judged(task, design, is_up) for design in _distinct(near))


def preferred_designs(designs: Sequence[Design]) -> NDArray[np.intp]:
    """Return the order of designs that were judged and reach every target, maybe of different bases."""
    return preferred(np.array([_row(design.figures) for design in designs if design.figures is not None]))


def _stand_beside(table: FloatArray, best: FloatArray, less_margin: float) -> NDArray[np.bool_]:
    """Return which shapes are alternatives to the best one: with all its ways, and nearly its margins."""
    return np.asarray((table[:, 0] <= best[0]) & (table[:, 1] <= best[1] + less_margin))


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
