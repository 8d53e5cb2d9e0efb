"""What the terminal shows of a result: what was found or missed, why, and what a person then does.

Millimetres and degrees. ✓ and ✗ stand where the terminal may colour a line or put other signs.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from synth.guide.instructions import base_sentence, hand_sentence, instructions, link_sentence
from synth.guide.markers import SPACING, make_guide
from synth.robot import MOST_CLEARANCE
from synth.rounding import Unit, rounded_down, rounded_up
from synth.synthesis import Status, ending, target_results, worst_targets
from synth.task import DEFAULT_TOLERANCE

if TYPE_CHECKING:
    from synth.guide.markers import Guide
    from synth.synthesis import Design, Solution, TargetResult
    from synth.task import Task

FOUND, MISSED, BULLET = "✓", "✗", "•"
_MOST_TARGETS = 10
_MOST_REASONS = 5
_MOST_WAYS = 10


def summary_text(solution: Solution, guide: Guide | None = None) -> str:
    """Return a result as a headline, what is known of it, and a few bullets, for any status.

    Args:
        solution: What a synthesis found, if only the reasons why it found nothing.
        guide: The guide to its first shape, or None if there is no shape.

    Returns:
        Lines without a line break at the end.
    """
    headline = f"{FOUND if solution.found else MISSED} {headline_of(solution)}"
    lines = [headline, "=" * min(len(headline), 79), *map(_bullet, knowledge(solution))]
    if solution.designs:
        lines += _target_lines(solution.task, solution.best)
    else:
        asked = _counted(len(solution.task.targets), "target")
        lines.append(_bullet(f"{asked} asked for, none reached: there is no shape"))
    bullets = [] if guide is None or not guide.met else _shape_bullets(guide)
    if len(solution.designs) > 1:
        best = (", the best" if solution.found else ", the nearest") if solution.shape == 1 else ""
        bullets.append(
            f"{len(solution.designs)} distinct shapes; this is shape {solution.shape}{best} "
            "(--all lists them, --shape K shows another)"
        )
    starts = _counted(solution.starts, "start")
    bullets.append(f"seed {solution.seed}, {starts}, {solution.time.total:.2f} s")
    return "\n".join([*lines, *map(_bullet, bullets)])


def headline_of(solution: Solution) -> str:
    """Return the task's name and how it ended."""
    return f"{solution.task.name}: {ending(solution.status, solution.designs)}"


def knowledge(solution: Solution, most: int = _MOST_REASONS) -> list[str]:
    """Return why no more was found, what is proven, and what would help: of many reasons the first.

    Args:
        solution: The result.
        most: How many reasons are told.
    """
    proof = proof_sentence(solution)
    told = [*reasons_told(solution, most), *([proof] if proof else [])]
    return [*told, *help_told(solution)]


def help_told(solution: Solution) -> list[str]:
    """Return what would let a task be met that is not, how more is found out, and what else is to be said."""
    if solution.found or solution.status is Status.FAILED:
        return list(solution.notes)
    told = [f"{release.sentence} would do" for release in solution.releases]
    open_yet = solution.status is not Status.PROVEN_IMPOSSIBLE
    if open_yet and solution.designs and not solution.best.verification.violations:
        worst = rounded_up(float(solution.best.verification.misses.max()), digits=2)
        told.append(f"tolerances of {worst} mm would be met by the nearest shape found")
    told += solution.notes
    if solution.status is Status.LIMIT:
        told.append("more time may find a shape")
    if not (solution.explained or solution.releases):
        told.append("solving with --why looks for one limit that, if it gave way, would let the task be met")
    if open_yet and solution.bound is None and solution.task.robot.rigid_link.is_fixed:
        told.append("solving with --prove tells how near any shape can come, or that the task is impossible")
    return told


def reasons_told(solution: Solution, most: int) -> list[str]:
    """Return why no more was found, but for what `proof_sentence` says: of many the first, counted."""
    bound = solution.bound
    reasons = [reason for reason in solution.reasons if bound is None or reason != bound.sentence]
    if len(reasons) <= most:
        return reasons
    return [*reasons[:most], f"and {len(reasons) - most} more of this kind"]


def proof_sentence(solution: Solution) -> str:
    """Return what `--prove` proved, of the shape that is shown; empty if it was not asked."""
    bound = solution.bound
    if bound is None:
        return ""
    if not solution.designs:
        return bound.sentence
    weights = bound.tightest_tolerance / solution.task.tolerances
    worst = float(np.max(solution.best.verification.misses * weights))
    return bound.sentence_of_shape(worst)


def guide_text(guide: Guide | None, solution: Solution) -> str:
    """Return the summary of a result and, if the task is met, what a person does to bend the link.

    Args:
        guide: The guide to the solution's first shape, or None if there is no shape.
        solution: The result.

    Returns:
        Lines without a line break at the end; the table has the points at `guide.hold`.
    """
    summary = summary_text(solution, guide)
    if guide is None or not guide.met:
        return summary
    rows = [f"{'':4}{'x':>10}{'y':>10}{'z':>10}"]
    rows += [
        f"{name:<5}" + "".join(f"{1e3 * value:z10.1f}" for value in point)[1:]
        for name, point in guide.points(guide.hold).items()
    ]
    steps = [f"{number}. {step}" for number, step in enumerate(_steps(guide), start=1)]
    return "\n".join([summary, "", *steps, "", points_sentence(guide), "", *rows])


def solution_text(solution: Solution, *, alternatives: bool = False) -> str:
    """Return all that the terminal shows of a result: the summary, and the guide if the task is met.

    Args:
        solution: The result.
        alternatives: Whether the other shapes get a line each, too.

    Returns:
        Lines without a line break at the end.
    """
    guide = make_guide(solution.task, solution.designs[0]) if solution.designs else None
    lines = [guide_text(guide, solution)]
    if alternatives and solution.designs[1:]:
        lines += ["", f"Other shapes, the {'best' if solution.found else 'nearest'} first:"]
        lines += [
            f"{number:>3}  {_shape_line(design)}"
            for number, design in zip(solution.shape_numbers[1:], solution.designs[1:], strict=True)
        ]
    return "\n".join(lines)


def tolerance_told(tolerance: float, digits: int = 3) -> str:
    """Return a target's tolerance, marked if it is the one that a task gets which states none."""
    default = ", the default" if tolerance == DEFAULT_TOLERANCE else ""
    return f"{rounded_down(tolerance, digits=digits)} mm{default}"


def points_sentence(guide: Guide) -> str:
    """Return what the table of points holds; of a very long link not every 50 mm."""
    spacing = float(guide.stations[0])
    if len(guide.stations) < 2 or spacing < 1.5 * SPACING:
        return "Points in the task frame, mm:"
    return f"Points in the task frame, mm, on the link every {1e3 * spacing:.0f} mm:"


def clearance_told(clearance: float) -> str:
    """Return a clearance, rounded down, which is told no farther than it was looked for."""
    if clearance >= MOST_CLEARANCE - 1e-9:  # or all but the last digit of it
        return f"{rounded_down(MOST_CLEARANCE)} mm at least"
    return f"{rounded_down(clearance)} mm"


def _bullet(line: str) -> str:
    return f"{BULLET} {line}"


def _steps(guide: Guide) -> list[str]:
    """Return the steps without what stands in the summary already."""
    told = [] if guide.forgiveness is None else [hand_sentence(guide.forgiveness)]
    return [base_sentence(guide), *(step for step in instructions(guide) if step not in told)]


def _shape_bullets(guide: Guide) -> list[str]:
    bullets = [motion.describe() for motion in guide.ways[:_MOST_WAYS]]
    if len(guide.ways) > _MOST_WAYS:
        bullets.append(f"{len(guide.ways)} ways from target to target in all: see solution.json")
    bullets += [f"kind of shape: {guide.arm.category_distances.describe()}", link_sentence(guide.link)]
    return bullets if guide.forgiveness is None else [*bullets, hand_sentence(guide.forgiveness)]


def _shape_line(design: Design) -> str:
    """Return one of several shapes in a line, with the figures by which a person chooses."""
    worst = rounded_up(float(design.verification.misses.max()), digits=3)
    told, figures = f"worst miss {worst:>8} mm", design.figures
    if figures is not None and design.verification.found:
        by_hand = rounded_up(figures.forgiveness.expected_worst_miss)
        swing = rounded_up(figures.largest_swing, Unit.DEG, 0)
        told += f"; by a hand expect {by_hand} mm; joints swing by up to {swing} deg"
        told += f"; {_counted(figures.ways_missing, 'way')} not found" if figures.ways_missing else ""
    return f"{told}; {link_sentence(design.arm.shape)}; {design.arm.category.value}"


def _counted(count: int, what: str) -> str:
    return f"{count} {what}" if count == 1 else f"{count} {what}s"


def _direction_told(target: TargetResult) -> str:
    """Return by how much the rigid link points beside the direction asked for, if one is."""
    if target.approach is None:
        return ""
    off, allowed = (rounded_up(angle, Unit.DEG, 2) for angle in (target.astray, target.approach.tolerance))
    return f"  direction {off} of {allowed} deg off"


def _target_lines(task: Task, design: Design) -> list[str]:
    """Return a line for each target, names and numbers in columns; of many targets the worst only."""
    lines, count, shown = [], len(task.targets), None
    if count > _MOST_TARGETS:
        reached = sum(design.verification.within_tolerance)
        are = "is" if reached == 1 else "are"
        lines = [_bullet(f"{reached} of {count} targets {are} within tolerance; the {_MOST_TARGETS} worst:")]
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
