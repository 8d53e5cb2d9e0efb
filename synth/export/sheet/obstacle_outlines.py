"""How an obstacle is drawn in a view: the outline of a convex solid, hatched, with its name."""

from __future__ import annotations

import itertools
import math
from typing import TYPE_CHECKING

import numpy as np

from synth.export.sheet.labels import FONT_SIZE
from synth.export.sheet.typesetting import shortened
from synth.geometry import Box

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from synth.arrays import FloatArray
    from synth.export.sheet.labels import Labels
    from synth.geometry import Solid

_LABEL = 33.0  # mm of paper, of an obstacle's name
_OUTLINE = 72  # directions in which the outline of an obstacle is looked for


def ends_of(solid: Solid) -> FloatArray:
    """Return the lowest and highest coordinates of a solid, shape (2, 3), mm."""
    return 1e3 * np.array([-solid.support(-np.eye(3)), solid.support(np.eye(3))])


def draw_obstacle(axes: Axes, name: str, solid: Solid, view: tuple[int, int], labels: Labels) -> None:
    """Draw the outline of a convex solid; if it has a name, hatched, and named in its middle."""
    frame = np.array([axes.get_xlim(), axes.get_ylim()])
    outline = clipped(1e3 * solid_outline(solid, view), frame)
    if not len(outline):
        return
    axes.fill(
        *outline.T,
        facecolor="#F4EFE0",
        edgecolor="#7A6A3A",
        hatch="xxx" if name else None,
        linewidth=0.7,
        alpha=0.75,
        zorder=0.5,
    )
    middle = 0.5 * (outline.min(axis=0) + outline.max(axis=0))
    if name:
        labels.add(shortened(name, _LABEL, FONT_SIZE), middle)


def clipped(corners: FloatArray, frame: FloatArray) -> FloatArray:
    """Return the corners of the part of a convex polygon, shape (k, 2), that is in a frame; none if none is.

    Cut by one side of the frame, shape (2, 2), a row for each coordinate, after the other.
    """
    for axis, sign in itertools.product((0, 1), (1.0, -1.0)):
        beyond = sign * corners[:, axis] - (frame[axis, 1] if sign > 0.0 else -frame[axis, 0])
        kept = []
        for index in range(len(corners)):
            start, end = beyond[index - 1], beyond[index]
            if start * end < 0.0:
                share = start / (start - end)
                kept.append(corners[index - 1] + share * (corners[index] - corners[index - 1]))
            if end <= 0.0:
                kept.append(corners[index])
        corners = np.array(kept).reshape(-1, 2)
    return corners


def solid_outline(solid: Solid, view: tuple[int, int]) -> FloatArray:
    """Return the corners of what a view shows of a convex solid, shape (k, 2), m, around it.

    A box has the corner that is farthest in each of many directions; a capsule its ends, and the
    radius about them.
    """
    angles = np.linspace(0.0, 2.0 * math.pi, _OUTLINE, endpoint=False)
    around = np.column_stack([np.cos(angles), np.sin(angles)])
    if isinstance(solid, Box):
        half = np.array(list(itertools.product((-0.5, 0.5), repeat=3))) * solid.size
        points = (half @ solid.axes.T + solid.centre)[:, list(view)]
        radius = 0.0
    else:
        points, radius = solid.ends[:, list(view)], solid.radius
    return np.asarray(points[np.argmax(around @ points.T, axis=1)] + radius * around)
