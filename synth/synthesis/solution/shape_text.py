"""A shape in lines: what becomes of each target, the ways, the link, the hand. Millimetres and degrees."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from synth.robot import MOST_CLEARANCE
from synth.rounding import Unit, counted, rounded_down, rounded_up
from synth.sentences import FOUND, MISSED, bulleted
from synth.synthesis.check import target_results, worst_targets
from synth.synthesis.solution.surface_text import sampled_lines
from synth.synthesis.wanted import ways_and_forgiveness
from synth.task import DEFAULT_TOLERANCE

if TYPE_CHECKING:
    from synth.synthesis.check import TargetResult
    from synth.synthesis.wanted import Design
    from synth.task import Task

_MOST_TARGETS = 10
_MOST_WAYS = 10


def _direction_told(target: TargetResult) -> str:
    """Return by how much the rigid link points beside the direction asked for, if one is."""
    if target.approach is None:
        return ""
    off, allowed = (rounded_up(angle, Unit.DEG, 2) for angle in (target.astray, target.approach.tolerance))
    return f"  direction {off} of {allowed} deg off"


def target_lines(task: Task, design: Design) -> list[str]:
    """Return a line for each target, names and numbers in columns; of many targets the worst only."""
    lines, count, shown = sampled_lines(design), len(task.targets), None
    check = design.verification
    if task.is_partial or check.followed or any(each.is_joined for each in check.coverings):
        own = np.flatnonzero(task.is_of_its_own if check.followed else task.surface_of_targets < 0)
        if not len(own):
            return lines
        worst = worst_targets(task, design.verification, count)
        shown = worst[np.isin(worst, own)][:_MOST_TARGETS]
    elif count > _MOST_TARGETS:
        reached = sum(design.verification.within_tolerance)
        are = "is" if reached == 1 else "are"
        told = f"{reached} of {count} targets {are} within tolerance; the {_MOST_TARGETS} worst:"
        lines.append(bulleted(told))
        shown = worst_targets(task, design.verification, _MOST_TARGETS)
    targets = target_results(task, design.arm, design.verification, shown)
    width = max(len(target.name) for target in targets)
    for target in targets:
        theta1, theta2 = (math.degrees(angle) for angle in target.joints)
        clear = "" if math.isinf(target.clearance) else f"  clear by {clearance_told(target.clearance)}"
        sign, word = (FOUND, "reached") if target.within_tolerance else (MISSED, "MISSED")
        lines.append(
            f"{sign} {target.name:<{width}}  {word:7}  "
            f"miss {rounded_up(target.miss, digits=3):>8} of {tolerance_told(target.tolerance)}  "
            f"joints {theta1:z7.2f}, {theta2:z7.2f} deg{_direction_told(target)}{clear}"
        )
    return lines


def shape_lines(task: Task, design: Design) -> list[str]:
    """Return the ways, the kind and the numbers of a shape, and what a hand makes of it; none if it misses.

    Args:
        task: What is asked.
        design: The shape, verified for it.
    """
    if not design.verification.found:
        return []
    ways, forgiveness = ways_and_forgiveness(task, design)
    lines = [motion.describe() for motion in ways[:_MOST_WAYS]]
    if len(ways) > _MOST_WAYS:
        lines.append(f"{len(ways)} ways from target to target in all: see solution.json")
    lines += [f"kind of shape: {design.arm.category_distances.describe()}", design.arm.shape.describe()]
    return lines if forgiveness is None else [*lines, forgiveness.describe()]


def shape_line(design: Design) -> str:
    """Return one of several shapes in a line, with the figures by which a person chooses."""
    worst = rounded_up(float(design.verification.misses.max()), digits=3)
    told, figures = f"worst miss {worst:>8} mm", design.figures
    if figures is not None and design.verification.found:
        by_hand = rounded_up(figures.forgiveness.expected_worst_miss)
        swing = rounded_up(figures.largest_swing, Unit.DEG, 0)
        told += f"; by a hand expect {by_hand} mm; joints swing by up to {swing} deg"
        told += f"; {counted(figures.ways_missing, 'way')} not found" if figures.ways_missing else ""
    return f"{told}; {design.arm.shape.describe()}; {design.arm.category.value}"


def tolerance_told(tolerance: float, digits: int = 3) -> str:
    """Return a target's tolerance, marked if it is the one that a task gets which states none."""
    default = ", the default" if tolerance == DEFAULT_TOLERANCE else ""
    return f"{rounded_down(tolerance, digits=digits)} mm{default}"


def clearance_told(clearance: float) -> str:
    """Return a clearance, rounded down, which is told no farther than it was looked for."""
    if clearance >= MOST_CLEARANCE - 1e-9:  # or all but the last digit of it
        return f"{rounded_down(MOST_CLEARANCE)} mm at least"
    return f"{rounded_down(clearance)} mm"
