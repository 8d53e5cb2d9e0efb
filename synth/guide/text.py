"""What the terminal shows: the summary of a result, and the guide as a table. Millimetres and degrees."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from synth.guide.guide import SPACING, make_guide
from synth.robot import MOST_CLEARANCE
from synth.synthesis import motions

if TYPE_CHECKING:
    from collections.abc import Sequence

    from synth.guide.guide import Guide
    from synth.robot import LinkShape
    from synth.synthesis.solution import Design, Solution, TargetResult

_MOST_TARGETS = 10
_STRAIGHT = 100.0  # m, a bend radius that no eye and no hand can tell from none


def summary_text(solution: Solution) -> str:
    """Return a result as a headline and a few bullets, for any status.

    Args:
        solution: What a synthesis found, if only the reasons why it found nothing.

    Returns:
        Lines without a line break at the end.
    """
    headline = f"{solution.task.name}: {solution.status.sentence}"
    bullets = list(solution.reasons)
    if solution.designs:
        arm = solution.robot
        bullets += [
            *_target_lines(solution.targets),
            *_motion_lines(solution),
            arm.category_distances.describe(),
            link_sentence(arm.shape),
        ]
        if len(solution.designs) > 1:
            bullets.append(f"{len(solution.designs)} distinct shapes, the best one shown")
    else:
        bullets.append(f"{len(solution.task.targets)} targets asked for, none reached: there is no shape")
    if solution.bound is not None and solution.bound.sentence not in solution.reasons:
        bullets.append(solution.bound.sentence)
    bullets += [f"{release.sentence} would do" for release in solution.releases]
    bullets += solution.notes
    starts = "1 start" if solution.starts == 1 else f"{solution.starts} starts"
    bullets.append(f"seed {solution.seed}, {starts}, {solution.time.total:.2f} s")
    return "\n".join([headline, "=" * min(len(headline), 79), *(f"• {bullet}" for bullet in bullets)])


def guide_text(guide: Guide | None, solution: Solution) -> str:
    """Return the summary of a result and below it the table that a person bends the link by.

    Args:
        guide: The guide to the solution's best shape, or None if there is no shape.
        solution: The result.

    Returns:
        Lines without a line break at the end; the table has the points at `guide.hold`.
    """
    summary = summary_text(solution)
    if guide is None:
        return summary
    rows = [f"{'':4}{'x':>10}{'y':>10}{'z':>10}"]
    rows += [
        f"{name:<5}" + "".join(f"{1e3 * value:z10.1f}" for value in point)[1:]
        for name, point in guide.points(guide.hold).items()
    ]
    lines = [hold_sentence(guide), points_sentence(guide), "", *rows, "", axis_sentence(guide)]
    return "\n".join([summary, "", *lines, *tolerance_sentences(guide)])


def solution_text(solution: Solution, *, alternatives: bool = False) -> str:
    """Return all that the terminal shows of a result: the summary, and the guide if there is a shape.

    Args:
        solution: The result.
        alternatives: Whether the other shapes get a line each, too.

    Returns:
        Lines without a line break at the end.
    """
    guide = make_guide(solution.task, solution.designs[0]) if solution.designs else None
    lines = [guide_text(guide, solution)]
    if alternatives and solution.designs[1:]:
        lines += ["", "Other shapes, the next best first:"]
        lines += [
            f"{number:>3}  {_shape_line(design)}" for number, design in enumerate(solution.designs[1:], 2)
        ]
    return "\n".join(lines)


def hold_sentence(guide: Guide) -> str:
    """Return what to do with joint 1 while the link is bent."""
    return f"Set joint 1 to {math.degrees(guide.hold.joint1):z.1f} deg and hold it there."


def points_sentence(guide: Guide) -> str:
    """Return what the table of points holds; of a very long link not every 50 mm."""
    spacing = float(guide.stations[0])
    if len(guide.stations) < 2 or spacing < 1.5 * SPACING:
        return "Points in the task frame, mm:"
    return f"Points in the task frame, mm, on the link every {1e3 * spacing:.0f} mm:"


def axis_sentence(guide: Guide) -> str:
    """Return where axis 2 is at the hold angle."""
    x, y, z = guide.hold.axis_direction
    return f"Axis 2 runs through END, P3 and P4 in the direction ({x:z.4f}, {y:z.4f}, {z:z.4f})."


def link_sentence(shape: LinkShape) -> str:
    """Return the numbers of a link's shape, without a full stop."""
    radius = "straight"
    if shape.min_bend_radius < _STRAIGHT:
        radius = f"smallest bend radius {1e3 * shape.min_bend_radius:.1f} mm"
    bend = math.degrees(shape.total_bend)
    return f"link {1e3 * shape.length:.1f} mm long, {radius}, {bend:.1f} deg of bend in all"


def tolerance_sentences(guide: Guide) -> tuple[str, ...]:
    """Return how precisely the shape must be held, as sentences for the operator."""
    tolerance = guide.tolerance
    if math.isnan(tolerance.position):
        return ("No target is within its tolerance, so there is none to keep: come as close as you can.",)
    tilt = math.degrees(tolerance.direction)
    p3, p4 = guide.hold.markers[2:]
    marker = 1e3 * float(np.linalg.norm(p4 - p3)) * tolerance.direction
    shift = f"{1e3 * tolerance.position:.2f} mm ({tolerance.position_target})"
    both = f"{shift} and {tilt:.2f} deg ({tolerance.direction_target})"
    return (
        f"Hold axis 2 within {both}; within half of each if both are off.",
        f"P3 or P4 off by {marker:.2f} mm across the axis is a tilt of {tilt:.2f} deg.",
    )


def _shape_line(design: Design) -> str:
    """Return one of several shapes in a line."""
    worst = 1e3 * float(design.verification.misses.max())
    return f"worst miss {worst:8.3f} mm  {link_sentence(design.arm.shape)}, {design.arm.category.value}"


def _motion_lines(solution: Solution) -> list[str]:
    """Return a line for each way from a target to the next, where they are few enough to be read."""
    if not solution.found or len(solution.task.targets) > _MOST_TARGETS:
        return []
    return [motion.describe() for motion in motions(solution.task, solution.best)]


def _target_lines(targets: Sequence[TargetResult]) -> list[str]:
    """Return a line for each target, names and numbers in columns; of many targets the worst only."""
    lines = []
    if len(targets) > _MOST_TARGETS:
        reached = sum(target.within_tolerance for target in targets)
        lines = [f"{reached} of {len(targets)} targets are within tolerance; the {_MOST_TARGETS} worst:"]
        targets = sorted(targets, key=lambda target: -target.miss / target.tolerance)[:_MOST_TARGETS]
    width = max(len(target.name) for target in targets)
    for target in targets:
        theta1, theta2 = (math.degrees(angle) for angle in target.joints)
        clear = "" if math.isinf(target.clearance) else f"  clear by {_clearance(target.clearance)}"
        lines.append(
            f"{target.name:<{width}}  {'reached' if target.within_tolerance else 'MISSED':7}  "
            f"miss {1e3 * target.miss:8.3f} of {1e3 * target.tolerance:.3f} mm  "
            f"joints {theta1:z7.2f}, {theta2:z7.2f} deg{clear}"
        )
    return lines


def _clearance(clearance: float) -> str:
    """Return a clearance, which is told no farther than it was looked for."""
    least = clearance >= MOST_CLEARANCE - 1e-9
    return f"{1e3 * clearance:.1f} mm" + (" at least" if least else "")
