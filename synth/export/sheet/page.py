"""A page of paper: where text and drawings go, in millimetres from its upper left corner."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from synth.export.sheet.labels import FONT_SIZE
from synth.export.sheet.typesetting import families, wrapped

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from synth.arrays import FloatArray

WIDTH = 210.0  # mm, of A4
HEIGHT = 297.0
MARGIN = 13.0  # on all sides
_LINE = 3.9  # from one line of a paragraph to the next
_APART = (13.0, 10.0)  # at least, of the numbers along an axis: across, up
_STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)


@dataclass(frozen=True)
class Page:
    """The page being filled: `figure` has its size."""

    figure: Figure

    def text(self, x: float, y: float, text: str, size: float = 8.0, **style: Any) -> None:
        """Write a line with its left end (or what `ha` says) on the baseline at (x, y)."""
        style = {"ha": "left", "va": "baseline", "family": families(text), **style}
        self.figure.text(x / WIDTH, 1.0 - y / HEIGHT, text, fontsize=size, **style)

    def paragraph(
        self,
        x: float,
        y: float,
        text: str,
        width: float,
        *,
        size: float,
        most: int | None = None,
        pitch: float = _LINE,
        **style: Any,
    ) -> float:
        """Write lines no wider than `width`, mm, no more than `most`; return where the next line goes."""
        for line in wrapped(text, width, size, most=most, bold=style.get("weight") == "bold"):
            self.text(x, y, line, size, **style)
            y += pitch
        return y

    def band(self, x: float, y: float, width: float, height: float, colour: str) -> None:
        """Fill a rectangle with its upper left corner at (x, y)."""
        from matplotlib.patches import Rectangle  # noqa: PLC0415 - as heavy as the page that is drawn anyway

        corner = (x / WIDTH, 1.0 - (y + height) / HEIGHT)
        size = (width / WIDTH, height / HEIGHT)
        self.figure.add_artist(Rectangle(corner, *size, facecolor=colour, transform=self.figure.transFigure))

    def frame(self, x: float, y: float, width: float, height: float) -> Axes:
        """Return bare axes with their upper left corner at (x, y), mm."""
        axes = self.figure.add_axes((x / WIDTH, 1.0 - (y + height) / HEIGHT, width / WIDTH, height / HEIGHT))
        axes.set_axis_off()
        return axes

    def axes(self, x: float, y: float, width: float, height: float, limits: FloatArray) -> Axes:
        """Return axes with their upper left corner at (x, y), with a frame, a grid and numbers.

        The library's own ticks are objects by the hundred, and take as long as all that is drawn.

        Args:
            x: Millimetres from the left edge of the page.
            y: Millimetres from its upper edge.
            width: Width, mm.
            height: Height, mm.
            limits: Lowest and highest coordinates shown, shape (2, 2): a row for each end.
        """
        from matplotlib.collections import LineCollection  # noqa: PLC0415 - the page is drawn anyway

        axes = self.frame(x, y, width, height)
        (left, bottom), (right, top) = limits.tolist()
        axes.set(xlim=(left, right), ylim=(bottom, top))
        across, up = _numbers(left, right, width / _APART[0]), _numbers(bottom, top, height / _APART[1])
        grid = [[(at, bottom), (at, top)] for at in across] + [[(left, at), (right, at)] for at in up]
        axes.add_collection(LineCollection(grid, colors="#E8E8E8", linewidths=0.4, zorder=-2), autolim=False)
        frame = [(left, bottom), (right, bottom), (right, top), (left, top), (left, bottom)]
        axes.add_collection(
            LineCollection([frame], colors="black", linewidths=0.6, zorder=10, clip_on=False), autolim=False
        )
        for at in across:
            where = x + width * (at - left) / (right - left)
            self.text(where, y + height + 3.4, f"{at:g}", FONT_SIZE, ha="center")
        for at in up:
            where = y + height * (top - at) / (top - bottom)
            self.text(x - 1.2, where + 0.8, f"{at:g}", FONT_SIZE, ha="right")
        return axes


def _numbers(lowest: float, highest: float, most: float) -> FloatArray:
    """Return round numbers from lowest to highest, evenly apart, about `most` of them and no more."""
    least = (highest - lowest) / max(most, 1.0)
    power = 10.0 ** math.floor(math.log10(least))
    step = next(power * factor for factor in _STEPS if power * factor >= least)
    return np.asarray(step * np.arange(math.ceil(lowest / step), math.floor(highest / step) + 1))
