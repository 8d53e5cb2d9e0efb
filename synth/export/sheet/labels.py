"""Labels in a drawing that cover neither each other nor what is drawn."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from synth.export.sheet.typesetting import families, width

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from synth.arrays import FloatArray

FONT_SIZE = 6.5  # pt
_MM_PER_POINT = 25.4 / 72.0
_HEIGHT = 1.15 * FONT_SIZE * _MM_PER_POINT  # mm
# Where a label is tried: this far from its point on paper, mm, in this many directions.
_DISTANCES = (2.6, 4.2, 6.5, 9.5)
_DIRECTIONS = 24
_PADDING = 0.6  # mm, about a label
_CORNERS = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
_LEADER_FROM = 3.0  # mm; a label farther from its point is joined to it by a line


@dataclass
class Labels:
    """The labels of one drawing, placed all at once when everything else is drawn.

    Attributes:
        axes: Where to write; its limits and its place on the page must be final.
        scale: How many units of the axes are one millimetre of paper.
    """

    axes: Axes
    scale: float
    _wanted: list[tuple[str, FloatArray]] = field(default_factory=list)
    _lines: list[FloatArray] = field(default_factory=list)
    _marks: list[FloatArray] = field(default_factory=list)

    def avoid_mark(self, point: FloatArray) -> None:
        """Keep labels off the mark that is drawn at a point, shape (2,)."""
        self._marks.append(np.asarray(point) / self.scale)

    def avoid_line(self, points: FloatArray) -> None:
        """Keep labels off the line through points, shape (k, 2)."""
        for start, end in pairwise(points):
            count = int(np.linalg.norm(end - start) / self.scale) + 2
            line = start + np.linspace(0.0, 1.0, count)[:, None] * (end - start)
            self._lines.append(line / self.scale)

    def add(self, text: str, point: FloatArray) -> None:
        """Name a point, shape (2,), of the drawing."""
        self._wanted.append((text, np.asarray(point) / self.scale))
        self.avoid_mark(point)

    def place(self) -> None:
        """Write the labels, each where it covers least: a greedy choice, in the order they came.

        Their boxes and lines are drawn together: an annotation of its own for each takes most of the time.
        """
        from matplotlib.collections import LineCollection, PolyCollection  # noqa: PLC0415 - drawn anyway

        frame = np.array([self.axes.get_xlim(), self.axes.get_ylim()]) / self.scale
        drawn = _Drawn(np.vstack([np.zeros((0, 2)), *self._lines]), np.array(self._marks), frame)
        leaders = []
        for text, point in self._wanted:
            half = 0.5 * np.array([width(text, FONT_SIZE) + _PADDING, _HEIGHT])
            places = _candidates(point, half)
            costs = drawn.costs(places, half) + 0.2 * np.linalg.norm(places - point, axis=1)
            centre = places[int(np.argmin(costs))]
            drawn.boxes.append((centre, half))
            if np.linalg.norm((centre - point) / (half + _LEADER_FROM), ord=np.inf) > 1.0:
                leaders.append(np.array([point, point + _outside(centre - point, half)]) * self.scale)
            self.axes.text(
                float(self.scale * centre[0]),
                float(self.scale * centre[1]),
                text,
                fontsize=FONT_SIZE,
                family=families(text),
                ha="center",
                va="center_baseline",
                zorder=9,
            )
        boxes = [self.scale * (centre + half * _CORNERS) for centre, half in drawn.boxes]
        self.axes.add_collection(
            PolyCollection(boxes, facecolor="white", edgecolor="none", alpha=0.8, zorder=8.8), autolim=False
        )
        self.axes.add_collection(
            LineCollection(leaders, colors="black", linewidths=0.4, zorder=8.9), autolim=False
        )


def _outside(way: FloatArray, half: FloatArray) -> FloatArray:
    """Return the part of the way to the middle of a box that is outside of it, shape (2,)."""
    shares = half / np.maximum(np.abs(way), 1e-9)
    return np.asarray(way * (1.0 - min(1.0, float(shares.min()))))


@dataclass
class _Drawn:
    """What is on the paper: points along lines, marks, the frame, and the labels so far; in mm."""

    lines: FloatArray
    marks: FloatArray
    frame: FloatArray
    boxes: list[tuple[FloatArray, FloatArray]] = field(default_factory=list)

    def costs(self, centres: FloatArray, half: FloatArray) -> FloatArray:
        """Return how bad places are for a label: first what it hides, then where it leaves the frame.

        Args:
            centres: Places for the middle of the label, shape (k, 2).
            half: Half the label's size, shape (2,).

        Returns:
            Costs, shape (k,).
        """
        hidden = np.zeros(len(centres))
        for other, size in self.boxes:
            hidden += np.all(np.abs(centres - other) < half + size + 0.2, axis=1)
        inside = (centres - half >= self.frame[:, 0] + 0.5) & (centres + half <= self.frame[:, 1] - 0.5)
        marks = _within(self.marks, centres, half + 0.9)
        lines = _within(self.lines, centres, half + 0.4)
        return np.asarray(100.0 * (hidden + ~inside.all(axis=1)) + 10.0 * marks + lines)


def _within(points: FloatArray, centres: FloatArray, half: FloatArray) -> FloatArray:
    """Return how many points, shape (n, 2), are in boxes about centres, shape (k, 2); shape (k,)."""
    lowest, highest = centres.min(axis=0) - half, centres.max(axis=0) + half
    points = points[np.all((points > lowest) & (points < highest), axis=1)]  # few of many are near
    return np.asarray(np.all(np.abs(points - centres[:, None]) < half, axis=-1).sum(axis=1))


def _candidates(point: FloatArray, half: FloatArray) -> FloatArray:
    """Return centres of a label's box, half its size away from `point` and a little more; shape (k, 2)."""
    angles = 2.0 * np.pi * np.arange(_DIRECTIONS) / _DIRECTIONS + 0.25 * np.pi
    around = np.column_stack([np.cos(angles), np.sin(angles)])
    reaches = half + np.array(_DISTANCES)[:, None, None] - _HEIGHT / 2
    return np.asarray(point + (around * reaches).reshape(-1, 2))
