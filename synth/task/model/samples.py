"""Samples of surfaces and paths as the targets of a task."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from synth.task.model.targets import PointTarget, TargetTable

if TYPE_CHECKING:
    from collections.abc import Sequence

    from synth.paths import Path
    from synth.surfaces import Cells, Surface


def sampled(
    surfaces: Sequence[Surface] = (), targets: Sequence[PointTarget] = (), paths: Sequence[Path] = ()
) -> TargetTable:
    """Return targets, and behind them the samples of surfaces, then of paths, as targets.

    Args:
        surfaces: The surfaces, as they stand in the task.
        targets: Targets beside them.
        paths: The paths, as they stand in the task.
    """
    table, first = TargetTable.of(targets), 0
    for samples in [*(points_of(each, each.samples) for each in surfaces), *map(_points_along, paths)]:
        table = table.followed_by(replace(samples, samples=first + np.arange(len(samples))))
        first += len(samples)
    return table


def _points_along(path: Path) -> TargetTable:
    """Return the samples of a path as targets, whose weights are in proportion to what they stand for."""
    points = path.samples
    count = len(points)
    return TargetTable(_numbered(path.name, count), points, np.full(count, path.tolerance), path.shares)


def points_of(surface: Surface, cells: Cells) -> TargetTable:
    """Return cells of a surface as targets, whose weights are in proportion to their areas."""
    count = len(cells)
    return TargetTable(
        _numbered(surface.name, count),
        cells.points,
        np.full(count, surface.tolerance),
        cells.areas / cells.areas.mean(),
    )


def _numbered(name: str, count: int) -> tuple[str, ...]:
    return tuple(f"{name} point {number}" for number in range(1, count + 1))
