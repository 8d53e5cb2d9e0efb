"""What a shape covers of a surface between its samples: a bound, not another sample."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import frozen
from synth.surfaces import SAMPLES, Cells
from synth.synthesis.check.cell_bounds import largest_misses
from synth.synthesis.check.covering import Between
from synth.synthesis.check.following import followed
from synth.synthesis.check.verification import verify_targets
from synth.task import points_of
from synth.watch import Watch

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.robot import Arm
    from synth.surfaces import Surface
    from synth.synthesis.check.verification import Verification
    from synth.task import Task

_FINER = (4, 16, 64)  # times the cells of the samples, where these do not prove that the surface is covered
_MOST_CELLS = 250_000  # that are looked at together
_TOLD_BY = 8  # times the cells of the samples the covered share is told


def verify(task: Task, arm: Arm, joints: FloatArray | None = None, *, keep: bool = False) -> Verification:
    """Check a shape against a task.

    Everything is seen from the base of the arm, and from nowhere else; an arm that stands elsewhere than
    the task says breaks a limit by that alone.

    Args:
        task: The task.
        arm: The robot in the shape.
        joints: Joint angles to consider beside the closest ones and the branches of the inverse
            kinematics, shape (n, 2), rad: at the closest point the arm may be in the way of something.
        keep: Whether the arm is to stand at these angles wherever they reach the target within its
            tolerance, and clear of everything, though others come nearer.

    Returns:
        The misses by forward kinematics, every limit that is broken, and what is proven of surfaces and
        paths between their samples.
    """
    return proven_between(task, arm, verify_targets(task, arm, joints, keep=keep), Watch())


def proven_between(task: Task, arm: Arm, check: Verification, watch: Watch) -> Verification:
    """Return what a shape does with what is proven of surfaces and paths; without a proof it reaches not all.

    Args:
        task: The task.
        arm: The robot in the shape.
        check: What it does at the targets.
        watch: When it is up, no finer cells are looked at.
    """
    check = _told_finely(task, arm, check, watch)
    if not check.found:
        return check
    between = tuple(
        between_samples(task, arm, surface, watch) for surface in task.surfaces if surface.samples.are_joined
    )
    paths = tuple(followed(task, arm, path, watch) for path in task.paths)
    met = [*(each.met for each in between), *(each.met for each in paths)]
    return replace(check, between=between, followed=paths, reaches_all=all(met))


def _told_finely(task: Task, arm: Arm, check: Verification, watch: Watch) -> Verification:
    """Return what a shape does, the covered share of a surface that may be left in part by more of its cells.

    A row of a few thousand samples is two per cent of a surface: all of it is within a limit, or is not.
    """
    told = list(check.coverings)
    for number, covering in enumerate(told):
        if covering.asked >= 1.0 or not covering.is_joined or not check.possible or watch.is_up():
            continue
        surface = next(each for each in task.surfaces if each.name == covering.name)
        cells = Cells.take(*_divided(surface, _TOLD_BY))
        if not len(cells):
            continue
        within = np.array(verify_targets(task.asking_for(points_of(surface, cells)), arm).within_tolerance)
        finely = replace(
            covering,
            share=float(cells.areas[within].sum() / cells.areas.sum()),
            uncovered=frozen(cells.points[~within]),
        )
        if finely.met is covering.met:
            told[number] = finely
    return replace(check, coverings=tuple(told))


def _divided(surface: Surface, finer: int) -> tuple[Cells, NDArray[np.bool_]]:
    """Return so many times the cells of the samples, and which count; maybe none of so small a part."""
    return surface.divided(finer * max(SAMPLES, len(surface.samples)))


def between_samples(task: Task, arm: Arm, surface: Surface, watch: Watch) -> Between:
    """Return what is proven to be covered of a surface that is known between its samples.

    Args:
        task: The task.
        arm: The robot in a shape.
        surface: One of the task's surfaces.
        watch: When it is up, no finer cells are looked at.
    """
    level = _Level(*surface.divided(SAMPLES))  # whose cells that count are the samples
    level.look(task, arm, surface)
    for finer in _FINER:
        told = level.told(surface)
        if told.met or watch.is_up():
            return told
        cells, counts = _divided(surface, finer)
        if not counts.any():  # of so small a part no finer cells are to be had
            return told
        level = level.finer(cells, counts, surface)
        if level.unknown > _MOST_CELLS:
            return told
        level.look(task, arm, surface)
    return level.told(surface)


class _Level:
    """A surface in cells, and what is proven of each.

    Args:
        cells: Cells of all of its shape.
        counts: Which of them count, shape (n,).
        most: By how much each is missed at most where that is known already, shape (n,), m; NaN elsewhere.
    """

    def __init__(self, cells: Cells, counts: NDArray[np.bool_], most: FloatArray | None = None) -> None:
        self._cells, self._counts = cells, counts
        self._most = np.full(len(cells), np.nan) if most is None else most

    @property
    def unknown(self) -> int:
        """Of how many cells nothing is known."""
        return int(np.count_nonzero(self._counts & np.isnan(self._most)))

    def look(self, task: Task, arm: Arm, surface: Surface) -> None:
        """Bound what is missed of the cells of which that is not known."""
        chosen = np.flatnonzero(self._counts & np.isnan(self._most))
        if not len(chosen):
            return
        cells = self._cells.take(chosen)
        check = verify_targets(task.asking_for(points_of(surface, cells)), arm)
        bounds = largest_misses(arm, check.joints, check.misses, cells)
        self._most[chosen] = np.where(check.within_tolerance, bounds, np.inf)

    def finer(self, cells: Cells, counts: NDArray[np.bool_], surface: Surface) -> _Level:
        """Return finer cells; of those that only cells can meet which are proven that is known already.

        A cell that meets another has its point no farther from the other's than both their radii.
        """
        from scipy.spatial import cKDTree  # type: ignore[import-untyped]  # noqa: PLC0415

        proven = self._counts & (self._most <= surface.tolerance)
        near = float(self._cells.radii.max()) + cells.radii
        open_cells = cKDTree(self._cells.points[~proven])
        # Beyond the upper bound it is said to be infinite.
        away = open_cells.query(cells.points, distance_upper_bound=float(near.max()) * (1.0 + 1e-9))[0]
        is_known = away > near
        worst = float(self._most[proven].max(initial=0.0))
        return _Level(cells, counts, np.where(is_known, worst, np.nan))

    def told(self, surface: Surface) -> Between:
        """Return what is proven of the surface."""
        most, cells = self._most[self._counts], self._cells.take(self._counts)
        order, whole = np.argsort(most, kind="stable"), cells.areas.sum()
        last = int(np.searchsorted(np.cumsum(cells.areas[order]), (surface.coverage - 1e-9) * whole))
        return Between(
            surface.name,
            surface.coverage,
            float(cells.areas[most <= surface.tolerance].sum() / whole),
            float(most[order[min(last, len(order) - 1)]]),
            len(cells),
            float(cells.radii.max()),
            _outmost(cells, ~(most <= surface.tolerance)),
        )


def _outmost(cells: Cells, chosen: NDArray[np.bool_]) -> FloatArray:
    """Return of some cells the ends that lie away from the middle of all, shape (k, 3), m."""
    some = cells.take(chosen)
    away = some.points - cells.points.mean(axis=0)
    away -= np.einsum("ni,ni->n", away, some.normals)[:, None] * some.normals
    away /= np.maximum(np.linalg.norm(away, axis=1, keepdims=True), 1e-12)
    return np.asarray(some.points + some.radii[:, None] * away)
