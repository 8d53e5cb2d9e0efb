"""The table of targets on the sheet: the misses, and the joint angles where that helps."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from synth.export.sheet.page import MARGIN, WIDTH
from synth.export.sheet.typesetting import shortened
from synth.rounding import rounded_down, rounded_up
from synth.synthesis import clearance_told, sampled_lines, target_results, worst_targets
from synth.task import DEFAULT_TOLERANCE

if TYPE_CHECKING:
    from collections.abc import Sequence

    from synth.export.sheet.page import Page
    from synth.synthesis import Solution

_PITCH = 3.6  # mm
_SIZE = 7.5  # pt
_MOST_TARGETS = 7
_NAME = 38.0  # mm, with the number before it


def listed_targets(solution: Solution) -> Sequence[int]:
    """Return the targets that have a line on the sheet, in their order: the worst ones if many.

    Of paths that are followed their ends have one, and no other sample.
    """
    count, followed = len(solution.task.targets), _own_and_path_ends(solution)
    if 0 < len(followed) <= _MOST_TARGETS:
        return followed
    if count <= _MOST_TARGETS or not solution.designs:
        return range(min(count, _MOST_TARGETS))
    return sorted(worst_targets(solution.task, solution.best.verification, _MOST_TARGETS).tolist())


def _own_and_path_ends(solution: Solution) -> list[int]:
    """Return the targets of their own, and the ends of the paths; none where no path is followed."""
    task = solution.task
    if not (solution.found and task.paths):
        return []
    ends = [np.flatnonzero(task.path_of_targets == number)[[0, -1]] for number in range(len(task.paths))]
    return sorted({*np.flatnonzero(task.is_of_its_own).tolist(), *np.concatenate(ends).tolist()})


def target_table(page: Page, x: float, y: float, solution: Solution) -> float:
    """Write the table with its upper left corner at (x, y), mm; return where the next line goes.

    Joint angles and clearances are those of a task that is met: nobody drives to a target that is missed.
    """
    task, listed = solution.task, listed_targets(solution)
    results = (
        target_results(task, solution.best.arm, solution.best.verification, np.array(listed))
        if solution.designs
        else None
    )
    heading = "Targets"
    if len(listed) < len(task.targets):
        count = f"{len(listed)} of {len(task.targets)}"
        heading = f"Targets, worst {count}" if results else f"{count} targets"
        heading = "Targets, path ends" if listed == _own_and_path_ends(solution) else heading
    page.text(x, y, heading, 9.5, weight="bold")
    heads = [("miss", 56.0), ("of, mm", 68.0)]
    if solution.found:
        heads.append(("joints 1, 2, °", 93.0))
        heads += [("clear, mm", 110.0)] if task.solids else []
    for head, column in heads:
        page.text(x + column, y, head, 7.0, ha="right", color="#555555")
    indent = 6.0 if max(listed) < 99 else 8.0
    for row, index in enumerate(listed, start=1):
        target, line = task.targets[index], y + _PITCH * row + 0.6
        page.text(x, line, f"{index + 1}", _SIZE, weight="bold")
        page.text(x + indent, line, shortened(target.name, _NAME - indent, _SIZE), _SIZE)
        default = "*" if target.tolerance == DEFAULT_TOLERANCE else ""
        page.text(x + 68.0, line, f"{rounded_down(target.tolerance, digits=2)}{default}", _SIZE, ha="right")
        if results is None:
            page.text(x + 56.0, line, "no shape", _SIZE, ha="right", weight="bold")
            continue
        result = results[row - 1]
        no, weight = ("", "normal") if result.within_tolerance else ("NO  ", "bold")
        page.text(
            x + 56.0, line, f"{no}{rounded_up(result.miss, digits=2)}", _SIZE, ha="right", weight=weight
        )
        if solution.found:
            theta1, theta2 = np.degrees(result.joints)
            page.text(x + 93.0, line, f"{theta1:z.2f}, {theta2:z.2f}", _SIZE, ha="right")
            if not math.isinf(result.clearance):
                told = clearance_told(result.clearance).replace(" mm", "").replace(" at least", "+")
                page.text(x + 110.0, line, told, _SIZE, ha="right")
    return _below(page, x, y + _PITCH * (len(listed) + 1) + 0.6, solution)


def _below(page: Page, x: float, bottom: float, solution: Solution) -> float:
    """Write what stands below the table: the surfaces, and what the signs mean."""
    task, listed = solution.task, listed_targets(solution)
    for told in sampled_lines(solution.best) if solution.designs else ():
        bottom = page.paragraph(x, bottom, told, WIDTH - 2 * MARGIN, most=3, pitch=3.1, size=6.5) + 0.4
    if len(listed) < len(task.targets):
        page.text(x + 6.0, bottom, "all of them: see solution.json", 6.5, color="#555555")
        bottom += _PITCH
    if any(task.targets[index].tolerance == DEFAULT_TOLERANCE for index in listed):
        page.text(
            x + 6.0,
            bottom,
            "* the default: the task states none of its own, or this one",
            6.5,
            color="#555555",
        )
        bottom += _PITCH
    return bottom
