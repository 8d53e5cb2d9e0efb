"""The sheet of a task that is met, above its drawings: what to do, the points to be met, targets and ways."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

from synth.export.sheet.page import MARGIN, WIDTH
from synth.export.sheet.robot_drawing import draw_robot
from synth.export.sheet.target_table import target_table
from synth.export.sheet.told import headline_told
from synth.export.sheet.typesetting import shortened
from synth.guide import base_sentence, instructions

if TYPE_CHECKING:
    from synth.export.sheet.page import Page
    from synth.guide import Guide
    from synth.synthesis import Motion, Solution

# Millimetres on the page.
_BODY = 44.0  # where the tables begin
_COLUMN = 90.0  # where the right column begins
_POINTS_HEIGHT = 62.0  # of the table of points, at most
_POINT_PITCH = 4.2  # from one of its lines to the next, at most
_MOST_POINTS = 19
_WAYS = 128.0  # where the ways begin, right of the targets
_WAYS_SIZE = 6.5  # pt
_MOST_WAYS = 6
_NAME = 25.0  # of a target
_ROBOT = 30.0  # side of the drawing that says what the names mean


def fill_met(page: Page, solution: Solution, guide: Guide) -> float:
    """Write all but the drawings; return how far down it goes, mm."""
    missing = any(not way.found for way in guide.ways)
    told, weight = headline_told(solution), "bold" if missing else "normal"
    room = WIDTH - 2 * MARGIN - _ROBOT - 3.0
    page.paragraph(MARGIN, 25.5, told, room, size=10.0, most=1, weight=weight)
    kind = f"Kind of shape: {guide.arm.category_distances.describe()}."
    page.paragraph(MARGIN, 31.0, kind, room, size=7.5, most=1)
    page.paragraph(MARGIN, 35.5, base_sentence(guide), room, size=7.5, most=2)
    draw_robot(page.frame(WIDTH - MARGIN - _ROBOT, 11.0, _ROBOT, _ROBOT), 5.0, whole=False)
    bottom = max(_points(page, guide), _steps(page, guide)) + 5.5
    return max(target_table(page, MARGIN, bottom, solution), _ways(page, bottom, guide)) + 5.5


def _points(page: Page, guide: Guide) -> float:
    angle = math.degrees(guide.hold.joint1)
    x, y = MARGIN, _BODY
    page.text(x, y, f"Points with joint 1 at {angle:z.1f}°, mm", 9.5, weight="bold")
    rows = list(guide.points(guide.hold).items())
    # A long link has more points than the page: every second or third of them, and the end.
    centreline = rows[4:-1]
    step = math.ceil(len(centreline) / (_MOST_POINTS - 5))
    if step > 1:
        rows = rows[:4] + centreline[step - 1 :: step] + rows[-1:]
    pitch = min(_POINT_PITCH, _POINTS_HEIGHT / len(rows))
    columns = (24.0, 42.0, 60.0)
    for column, head in zip(columns, ("x", "y", "z"), strict=True):
        page.text(x + column + 3.0, y + 4.5, head, ha="right", color="#555555")
    for row, (name, point) in enumerate(rows, start=1):
        line = y + 4.5 + pitch * row
        page.text(x, line, name, weight="bold" if row <= 4 or row == len(rows) else "normal")
        for column, value in zip(columns, point, strict=True):
            page.text(x + column + 3.0, line, f"{1e3 * value:z.1f}", ha="right")
    return y + 4.5 + pitch * len(rows)


def _steps(page: Page, guide: Guide) -> float:
    page.text(_COLUMN, _BODY, "What to do", 9.5, weight="bold")
    y = _BODY + 5.0
    for number, step in enumerate(instructions(guide), start=1):
        page.text(_COLUMN, y, str(number), 7.0, weight="bold")
        y = page.paragraph(_COLUMN + 4.0, y, step, WIDTH - MARGIN - _COLUMN - 4.0, pitch=3.35, size=7.0) + 0.7
    return y


def _short(way: Motion) -> Motion:
    """Return a way between targets of shorter names."""
    start, end = (shortened(name, _NAME, _WAYS_SIZE) for name in (way.start, way.end))
    return replace(way, start=start, end=end)


def _ways(page: Page, y: float, guide: Guide) -> float:
    """Write how the arm gets from target to target, those first where no way was found."""
    if not guide.ways:
        return y
    page.text(_WAYS, y, "Ways", 9.5, weight="bold")
    y += 4.2
    room = WIDTH - MARGIN - _WAYS
    ways = sorted(guide.ways, key=lambda way: way.found)
    for way in ways[:_MOST_WAYS]:
        weight, told = "normal" if way.found else "bold", _short(way).describe().replace(" deg", "°")
        y = page.paragraph(_WAYS, y, told, room, most=4, pitch=3.1, size=_WAYS_SIZE, weight=weight) + 0.4
    if len(ways) > _MOST_WAYS:
        told = f"and {len(ways) - _MOST_WAYS} more: see solution.json"
        y = page.paragraph(_WAYS, y, told, room, size=_WAYS_SIZE)
    return y
