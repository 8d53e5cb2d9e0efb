"""What the terminal shows of a result: what was found or missed, why, and what a person then does.

Millimetres and degrees.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from synth.guide.instructions import base_sentence, instructions
from synth.guide.markers import SPACING, make_guide
from synth.synthesis import shape_line

if TYPE_CHECKING:
    from synth.guide.markers import Guide
    from synth.synthesis import Solution


def guide_text(guide: Guide | None, solution: Solution) -> str:
    """Return the summary of a result and, if the task is met, what a person does to bend the link.

    Args:
        guide: The guide to the solution's first shape, or None if there is no shape.
        solution: The result.

    Returns:
        Lines without a line break at the end; the table has the points at `guide.hold`.
    """
    if guide is None or not guide.met:
        return str(solution)
    rows = [f"{'':4}{'x':>10}{'y':>10}{'z':>10}"]
    rows += [
        f"{name:<5}" + "".join(f"{1e3 * value:z10.1f}" for value in point)[1:]
        for name, point in guide.points(guide.hold).items()
    ]
    steps = [f"{number}. {step}" for number, step in enumerate(_steps(guide), start=1)]
    return "\n".join([str(solution), "", *steps, "", points_sentence(guide), "", *rows])


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
            f"{number:>3}  {shape_line(design)}"
            for number, design in zip(solution.shape_numbers[1:], solution.designs[1:], strict=True)
        ]
    return "\n".join(lines)


def points_sentence(guide: Guide) -> str:
    """Return what the table of points holds; of a very long link not every 50 mm."""
    spacing = float(guide.stations[0])
    if len(guide.stations) < 2 or spacing < 1.5 * SPACING:
        return "Points in the task frame, mm:"
    return f"Points in the task frame, mm, on the link every {1e3 * spacing:.0f} mm:"


def _steps(guide: Guide) -> list[str]:
    """Return the steps without what stands in the summary already."""
    told = [] if guide.forgiveness is None else [guide.forgiveness.describe()]
    return [base_sentence(guide), *(step for step in instructions(guide) if step not in told)]
