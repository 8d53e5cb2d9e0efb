"""A page of paper: where text and drawings go, in millimetres from its upper left corner."""

from __future__ import annotations

import textwrap
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from synth.export.labels import FONT_SIZE

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDTH, HEIGHT, MARGIN = 210.0, 297.0, 13.0  # A4
_LINE = 3.9  # from one line of a paragraph to the next


@dataclass(frozen=True)
class Page:
    """The page being filled: `figure` has its size."""

    figure: Figure

    def text(self, x: float, y: float, text: str, size: float = 8.0, **style: Any) -> None:
        """Write a line with its left end (or what `ha` says) on the baseline at (x, y)."""
        style = {"ha": "left", "va": "baseline", **style}
        self.figure.text(x / WIDTH, 1.0 - y / HEIGHT, text, fontsize=size, **style)

    def paragraph(
        self, x: float, y: float, text: str, width: int, *, most: int | None = None, pitch: float = _LINE, **style: Any
    ) -> float:
        """Write lines of at most `width` characters, no more than `most`; return where the next line goes."""
        lines = textwrap.wrap(text, width, break_on_hyphens=False, max_lines=most, placeholder=" …")
        for line in lines:
            self.text(x, y, line, **style)
            y += pitch
        return y

    def band(self, x: float, y: float, width: float, height: float, colour: str) -> None:
        """Fill a rectangle with its upper left corner at (x, y)."""
        from matplotlib.patches import Rectangle  # noqa: PLC0415 - as heavy as the page that is drawn anyway

        corner = (x / WIDTH, 1.0 - (y + height) / HEIGHT)
        size = (width / WIDTH, height / HEIGHT)
        self.figure.add_artist(Rectangle(corner, *size, facecolor=colour, transform=self.figure.transFigure))

    def axes(self, x: float, y: float, width: float, height: float) -> Axes:
        """Return axes with their upper left corner at (x, y)."""
        axes = self.figure.add_axes((x / WIDTH, 1.0 - (y + height) / HEIGHT, width / WIDTH, height / HEIGHT))
        axes.tick_params(labelsize=FONT_SIZE, length=2.0, width=0.5)
        axes.grid(color="#E8E8E8", linewidth=0.4)
        axes.set_axisbelow(True)
        for spine in axes.spines.values():
            spine.set_linewidth(0.5)
        return axes
