"""What files of surfaces have in common: how much they may hold, and which coordinates."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from synth.errors import InputError, Mistake

if TYPE_CHECKING:
    from pathlib import Path

    from synth.arrays import FloatArray

LARGEST = 1e6  # of a coordinate in a file, either way
MAX_BYTES = 200_000_000  # of a file, and of what it holds packed
MOVED = "a survey must be moved to where the robot is"


def content_of(path: Path) -> bytes:
    """Return what a file holds.

    Raises:
        InputError: It cannot be read, or is too large.
    """
    try:
        with path.open("rb") as stream:
            content = stream.read(MAX_BYTES + 1)
    except FileNotFoundError:
        raise InputError([Mistake("there is no such file", str(path))]) from None
    except (OSError, ValueError) as error:  # ValueError: a name that no file can have
        reason = getattr(error, "strerror", None) or error
        raise InputError([Mistake(f"cannot be read: {reason}", str(path))]) from None
    if len(content) > MAX_BYTES:
        raise InputError([Mistake(f"is larger than {MAX_BYTES // 1_000_000} MB", str(path))])
    return content


def finite_points(points: FloatArray, path: Path) -> FloatArray:
    """Return the points of a file without those that have a coordinate that is not a number.

    Args:
        points: The points, shape (n, 3).
        path: The file.

    Raises:
        InputError: There are none, or one is too far away.
    """
    points = points[np.isfinite(points).all(axis=1)]
    if not len(points):
        raise InputError([Mistake("holds no points", str(path))])
    refuse_too_far(points, path)
    return points


def refuse_too_far(numbers: FloatArray, path: Path) -> None:
    """Refuse coordinates of a file, of any shape, that no robot can have before it."""
    largest = float(np.abs(numbers).max(initial=0.0))
    if largest > LARGEST:
        told = f"{largest:g}" if math.isfinite(largest) else "infinite"
        raise InputError(
            [Mistake(f"holds the coordinate {told}: {LARGEST:g} is the largest; {MOVED}", str(path))]
        )
