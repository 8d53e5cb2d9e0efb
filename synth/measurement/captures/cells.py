"""What a cell of a table holds: a number, or nothing."""

from __future__ import annotations

import math


def is_gap(cell: object) -> bool:
    """Whether a cell holds nothing: a frame in which the marker was not seen."""
    return (
        cell is None
        or (isinstance(cell, str) and cell.strip().lower() in {"", "nan", "null"})
        or (isinstance(cell, float) and math.isnan(cell))
    )


def number_of(cell: object) -> float | None:
    """Return the number in a cell, or None if it holds none that is finite."""
    if isinstance(cell, bool) or not isinstance(cell, str | int | float):
        return None
    try:
        value = float(cell)
    except (ValueError, OverflowError):
        return None
    return value if math.isfinite(value) else None
