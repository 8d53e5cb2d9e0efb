"""The sheet of a task that is not met, above its drawings: what is missed, why, and what would help."""

from __future__ import annotations

from typing import TYPE_CHECKING

from synth.export.sheet.page import MARGIN, WIDTH
from synth.export.sheet.target_table import target_table
from synth.export.sheet.told import headline_told, help_in_few, why_told
from synth.export.sheet.typesetting import width
from synth.sentences import BULLET

if TYPE_CHECKING:
    from collections.abc import Sequence

    from synth.export.sheet.page import Page
    from synth.synthesis import Solution

# Millimetres on the page.
_BANNER = 21.0  # where the word begins that nobody may miss
_BODY = 37.0  # where the reasons begin
_BANNER_SIZE = 12.0  # pt, at most
_PITCH = 3.6
_MOST_LINES = 3  # of one reason


def fill_missed(page: Page, solution: Solution) -> float:
    """Write all but the drawings; return how far down it goes, mm."""
    _banner(page, solution)
    y = _list(page, _BODY, "Why", why_told(solution))
    y = _list(page, y, "What would help", help_in_few(solution))
    y = target_table(page, MARGIN, y + 1.0, solution)
    if not solution.designs:
        page.text(MARGIN, y + 1.0, "There is no shape to bend the link to.", 9.5, weight="bold")
        y += 4.0
    return y + 6.0


def _banner(page: Page, solution: Solution) -> None:
    told = headline_told(solution)
    page.band(MARGIN, _BANNER, WIDTH - 2 * MARGIN, 9.0, "black")
    size = _BANNER_SIZE * min(1.0, (WIDTH - 2 * MARGIN - 6.0) / width(told, _BANNER_SIZE, bold=True))
    page.text(MARGIN + 3.0, _BANNER + 6.2, told, size, color="white", weight="bold")


def _list(page: Page, y: float, heading: str, lines: Sequence[str]) -> float:
    """Write a heading and a list; return where the next line goes. Of a long entry the first lines."""
    if not lines:
        return y
    page.text(MARGIN, y, heading, 9.5, weight="bold")
    y += 4.6
    for line in lines:
        page.text(MARGIN, y, BULLET, 7.0)
        y = (
            page.paragraph(
                MARGIN + 3.0, y, line, WIDTH - 2 * MARGIN - 3.0, most=_MOST_LINES, pitch=_PITCH, size=7.0
            )
            + 0.3
        )
    return y + 2.6
