"""`guide.pdf`: one A4 page to be printed and held while the link is bent."""

from __future__ import annotations

import io
import math
import textwrap
import warnings
from typing import TYPE_CHECKING

import numpy as np

from synth.export.drawings import draw
from synth.export.page import HEIGHT, MARGIN, WIDTH, Page
from synth.export.scene import MOST_DRAWN, Scene
from synth.guide.text import axis_sentence, hold_sentence, link_sentence, tolerance_sentences
from synth.version import __version__

if TYPE_CHECKING:
    from collections.abc import Sequence

    from synth.guide import Guide
    from synth.synthesis import Solution

# Millimetres on the page.
_BODY = 42.0  # where the tables begin
_COLUMN = 96.0  # where the right column begins
_POINTS_HEIGHT, _POINT_PITCH = 78.0, 4.2
_TARGETS_BOTTOM, _TARGET_PITCH = 124.5, 3.6
_MOST_POINTS, _MOST_TARGETS = 20, 7


def draw_sheet(solution: Solution, guide: Guide | None, file_format: str = "pdf") -> bytes:
    """Return the page: status, what to do, the points to be met, tolerances, and the drawings.

    The points and the blue link are those at `guide.hold`; lengths are in mm, in the task frame.

    Args:
        solution: What a synthesis found, whatever its status.
        guide: The guide to its best shape, or None if there is no shape.
        file_format: "pdf", or another one that matplotlib writes, such as "png" or "svg".

    Returns:
        The file's content, the same for the same solution: it bears no date.
    """
    # Half a second to import, which only who prints a sheet shall pay; no pyplot, so no global state.
    import matplotlib as mpl  # noqa: PLC0415
    from matplotlib.figure import Figure  # noqa: PLC0415

    content = io.BytesIO()
    with mpl.rc_context(), warnings.catch_warnings():
        mpl.rcdefaults()  # the user's own style is for the user's own plots
        mpl.rc("font", family="DejaVu Sans")
        mpl.rc("text", usetex=False, parse_math=False)  # a $ in a name is a dollar
        mpl.rc("pdf", fonttype=42)  # text that can be searched and copied
        mpl.rc("hatch", linewidth=0.4)
        # A name in a script that the font lacks prints as boxes; that is no reason to talk of fonts.
        warnings.filterwarnings("ignore", message="Glyph .* missing from font")
        figure = Figure(figsize=(WIDTH / 25.4, HEIGHT / 25.4))
        _fill(Page(figure), solution, guide)
        metadata = {"CreationDate": None} if file_format == "pdf" else None
        figure.savefig(content, format=file_format, metadata=metadata, dpi=150)
    return content.getvalue()


def _fill(page: Page, solution: Solution, guide: Guide | None) -> None:
    """Put everything on the page."""
    listed = _listed(solution)
    _header(page, solution)
    if guide is None:
        _nothing_to_do(page)
    else:
        _points(page, guide)
        _instructions(page, solution, guide)
    _targets(page, solution, listed)
    labels = [str(index + 1) if index in listed else "" for index in range(len(solution.task.targets))]
    draw(page, solution, Scene.of(solution, guide, labels))


def _header(page: Page, solution: Solution) -> None:
    name = textwrap.shorten(solution.task.name, 52, placeholder=" …") or "task"
    page.text(MARGIN, 18.0, name, 17.0, weight="bold")
    right = f"{solution.task.robot.name}, seed {solution.seed}, synth {__version__}"
    page.text(WIDTH - MARGIN, 11.0, textwrap.shorten(right, 70), 6.5, ha="right", color="#555555")
    if solution.found:
        page.text(MARGIN, 25.5, f"Found: {solution.status.sentence}.", 10.0)
        page.text(MARGIN, 31.0, f"Kind of shape: {solution.robot.category_distances.describe()}.")
    else:
        band = page.axes(MARGIN, 20.5, WIDTH - 2 * MARGIN, 9.0)
        band.set(xticks=[], yticks=[], facecolor="black")
        sentence = textwrap.shorten(f"NOT FOUND: {solution.status.sentence}", 84)
        page.text(MARGIN + 3.0, 26.5, sentence, 11.5, color="white", weight="bold")
        reasons = textwrap.shorten("; ".join(solution.reasons), 260, placeholder=" …")
        page.paragraph(MARGIN, 33.5, reasons, 130, size=7.0)


def _nothing_to_do(page: Page) -> None:
    page.text(MARGIN, _BODY, "There is no shape to bend the link to.", 9.5, weight="bold")


def _points(page: Page, guide: Guide) -> None:
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
        page.text(x + column + 3.0, y + 5.0, head, ha="right", color="#555555")
    for row, (name, point) in enumerate(rows):
        line = y + 5.0 + pitch * (row + 1)
        page.text(x, line, name, weight="bold" if row < 4 or row == len(rows) - 1 else "normal")
        for column, value in zip(columns, point, strict=True):
            page.text(x + column + 3.0, line, f"{1e3 * value:z.1f}", ha="right")


def _instructions(page: Page, solution: Solution, guide: Guide) -> None:
    limit = solution.task.robot.link.min_bend_radius
    link = f"{link_sentence(guide.link)}, never below {1e3 * limit:.0f} mm"
    where = "L100 is the middle of the tube, 100 mm along it from P2, END its end"
    steps = (
        hold_sentence(guide),
        f"Soften the link and shape it: {link}. P3 and P4 come to their places; {where}.",
        axis_sentence(guide),
        " ".join(tolerance_sentences(guide)),
        "A hand places the link to about 10 mm: stiffen it, measure, and correct until it is right.",
    )
    page.text(_COLUMN, _BODY, "What to do", 9.5, weight="bold")
    y = _BODY + 5.5
    for number, step in enumerate(steps, start=1):
        page.text(_COLUMN, y, str(number), weight="bold")
        y = page.paragraph(_COLUMN + 4.5, y, step, 64) + 0.8


def _targets(page: Page, solution: Solution, listed: Sequence[int]) -> None:
    task = solution.task
    results = solution.targets if solution.designs else None
    x, y = _COLUMN, _TARGETS_BOTTOM - _TARGET_PITCH * len(listed)
    heading = "Targets"
    if len(listed) < len(task.targets):
        heading = f"{len(listed)} of {len(task.targets)} targets" + (", the worst" if results else "")
        if len(task.targets) > MOST_DRAWN:
            heading += "; not all are drawn"
    page.text(x, y, heading, 9.5, weight="bold")
    columns = (("miss", 62.0), ("of, mm", 74.0), ("joints 1, 2, °", 101.0))
    for head, column in columns:
        page.text(x + column, y, head, 7.0, ha="right", color="#555555")
    for row, index in enumerate(listed, start=1):
        target, line = task.targets[index], y + _TARGET_PITCH * row
        name = textwrap.shorten(target.name, 24, placeholder=" …")
        page.text(x, line, f"{index + 1}", 7.5, weight="bold")
        page.text(x + 6.0, line, name, 7.5)
        page.text(x + 74.0, line, f"{1e3 * target.tolerance:.2f}", 7.5, ha="right")
        if results is None:
            page.text(x + 62.0, line, "no shape", 7.5, ha="right", weight="bold")
            continue
        result = results[index]
        no, weight = ("", "normal") if result.within_tolerance else ("NO  ", "bold")
        page.text(x + 62.0, line, f"{no}{1e3 * result.miss:.2f}", 7.5, ha="right", weight=weight)
        theta1, theta2 = np.degrees(result.joints)
        page.text(x + 101.0, line, f"{theta1:z.1f}, {theta2:z.1f}", 7.5, ha="right")


def _listed(solution: Solution) -> Sequence[int]:
    """Return the targets that have a line on the sheet, in their order: the worst ones if many."""
    count = len(solution.task.targets)
    if count <= _MOST_TARGETS or not solution.designs:
        return range(min(count, _MOST_TARGETS))
    worst = np.argsort(-solution.best.verification.misses / solution.task.tolerances, kind="stable")
    return sorted(int(index) for index in worst[:_MOST_TARGETS])
