"""How much of each surface is covered, by what is missed at its samples."""

from __future__ import annotations

import math
from dataclasses import field
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen, frozen_value
from synth.rounding import rounded_up

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from synth.task import Task

_ROUNDING = 1e-9  # of a share: a sum of areas


@frozen_value
class Covering:
    """What a shape covers of one surface.

    Attributes:
        name: The surface's name.
        asked: Share of its area that shall be within tolerance.
        share: Share that is, at the samples.
        tolerance: Largest miss that counts as covered, m.
        largest: Largest miss of what is covered best, up to the share asked for, m.
        rms: Root mean square of the misses there, m.
        percentile_95: Miss that 95 % of the area there do not exceed, m.
        uncovered: Middles of the cells that are not covered, in the task frame, shape (k, 3), m.
        is_joined: Whether the surface is known between its samples; if not, all this holds for points.
    """

    name: str
    asked: float
    share: float
    tolerance: float
    largest: float
    rms: float
    percentile_95: float
    uncovered: FloatArray
    is_joined: bool

    @property
    def met(self) -> bool:
        """Whether as much is covered as was asked for."""
        return self.share >= self.asked - _ROUNDING

    @property
    def sentence(self) -> str:
        """What is covered, what is missed, and where it is that is not covered, for the user."""
        of, are = ("area", "is") if self.is_joined else ("points", "are")
        within = rounded_up(self.tolerance, digits=2)
        asked = f", {_percent(self.asked)} is asked" if self.asked < 1.0 else ""
        largest, rms, most = (
            rounded_up(miss, digits=2) for miss in (self.largest, self.rms, self.percentile_95)
        )
        best = f" of the {_percent(self.asked)} covered best" if self.asked < 1.0 else ""
        told = (
            f"{self.name}: {_percent(self.share)} of its {of} {are} within {within} mm{asked}; it is missed"
            f"{best} by {rms} mm RMS, {most} mm for 95 %, {largest} mm at most"
        )
        return f"{told}; {self.place}" if len(self.uncovered) else told

    @property
    def place(self) -> str:
        """Where that is which is not covered, for the user."""
        middle = np.median(self.uncovered, axis=0)
        away = float(np.linalg.norm(self.uncovered - middle, axis=1).max())
        where = ", ".join(f"{1e3 * x:z.0f}" for x in middle)
        return f"what is not covered is about ({where}) mm, within {rounded_up(away, digits=0)} mm of there"


@frozen_value
class Between:
    """What is proven of a surface, all of it and not its samples alone.

    Attributes:
        name: The surface's name.
        asked: Share of its area that shall be within tolerance.
        share: Share that is so for certain.
        largest: No point of what is covered best, up to the share asked for, is missed by more, m.
        cells: How many cells were looked at.
        width: How far at most a point of one is from its middle, m.
        unproven: Of the cells of which nothing good enough is proven the outer ends, shape (k, 3), m.
    """

    name: str
    asked: float
    share: float
    largest: float
    cells: int
    width: float
    unproven: FloatArray = field(compare=False)

    @property
    def met(self) -> bool:
        """Whether so much is covered for certain as was asked for."""
        return self.share >= self.asked - _ROUNDING

    @property
    def sentence(self) -> str:
        """What is certain of the surface between its samples, for the user."""
        if not np.isfinite(self.largest):
            return f"{self.name}: between its samples nothing is certain"
        most, share = rounded_up(self.largest, digits=2), math.floor(self.share * 1000.0) / 10.0
        if self.met:
            whole = "all of it" if self.asked >= 1.0 else f"{share:.10g} % of its area for certain"
            return f"{self.name}: {whole} is covered, between the samples, too: missed by {most} mm at most"
        return (
            f"{self.name}: its samples are covered, but between them only {share:.10g} % of its area for "
            f"certain: a miss of {most} mm is not excluded"
        )


def counted(task: Task, misses: FloatArray) -> NDArray[np.bool_]:
    """Return which targets count where a part of a surface may be left: the best covered share of each.

    Args:
        task: The task.
        misses: Of all its targets, shape (n,), m, or by what else they are ordered.
    """
    counts = np.ones(len(misses), dtype=bool)
    for number, surface in enumerate(task.surfaces):
        if surface.coverage < 1.0:
            of_it = np.flatnonzero(task.surface_of_targets == number)
            counts[of_it[~_best(misses[of_it], task.weights[of_it], surface.coverage)]] = False
    return counts


def coverings(task: Task, misses: FloatArray, within: ArrayLike) -> tuple[Covering, ...]:
    """Return what is covered of each surface of a task.

    Args:
        task: The task.
        misses: Of all its targets, shape (n,), m.
        within: Which of them are reached, shape (n,).
    """
    told = []
    for number, surface in enumerate(task.surfaces):
        of_it = np.flatnonzero(task.surface_of_targets == number)
        if not len(of_it):
            continue
        reached, areas, miss = np.asarray(within)[of_it], task.weights[of_it], misses[of_it]
        best = _best(np.where(reached, miss, miss + surface.tolerance), areas, surface.coverage)
        told.append(
            Covering(
                name=surface.name,
                asked=surface.coverage,
                share=float(areas[reached].sum() / areas.sum()),
                tolerance=surface.tolerance,
                largest=float(miss[best].max()),
                rms=math.sqrt(float(np.average(miss[best] ** 2, weights=areas[best]))),
                percentile_95=float(miss[best][_best(miss[best], areas[best], 0.95)].max()),
                uncovered=frozen(task.table.positions[of_it[~reached]]),
                is_joined=surface.samples.are_joined,
            )
        )
    return tuple(told)


def _percent(share: float) -> str:
    """Return a share in per cent, rounded down: 100 % is all of it."""
    return f"{math.floor(share * 1000.0 + 1e-6) / 10.0:.10g} %"


def _best(misses: FloatArray, areas: FloatArray, share: float) -> NDArray[np.bool_]:
    """Return the samples with the least misses that together have a share of the area, or just more."""
    order = np.argsort(misses, kind="stable")
    before = np.cumsum(areas[order]) - areas[order]
    best = np.zeros(len(misses), dtype=bool)
    best[order[before < (share - _ROUNDING) * areas.sum()]] = True
    return best
