"""What is said of surfaces and paths: how much of each is covered or followed, and what would be met."""

from __future__ import annotations

from typing import TYPE_CHECKING

from synth.rounding import rounded_up
from synth.sentences import FOUND, MISSED, bulleted

if TYPE_CHECKING:
    from synth.synthesis.wanted import Design
    from synth.task import Task


def sampled_lines(design: Design) -> list[str]:
    """Return a line for each surface, how much is covered and what is certain, and for each path."""
    proven = {each.name: each for each in design.verification.between}
    lines = []
    for covering in design.verification.coverings:
        between = proven.get(covering.name)
        is_met = covering.met and (between is None or between.met)
        lines.append(f"{FOUND if is_met else MISSED} {covering.sentence}")
        if between is not None:
            lines.append(bulleted(between.sentence))
        elif not covering.is_joined:
            lines.append(
                bulleted(f"{covering.name}: all this holds for its points; between them nothing is known")
            )
    followed = design.verification.followed
    return [*lines, *(f"{FOUND if each.met else MISSED} {each.sentence}" for each in followed)]


def met_tolerances(task: Task, design: Design) -> list[str]:
    """Return which tolerances the nearest shape found would meet, as far as that is known."""
    check = design.verification
    if check.between or task.paths:  # nothing is certain of what is between the samples
        return []
    misses = [*check.misses[task.surface_of_targets < 0], *(each.largest for each in check.coverings)]
    return [f"tolerances of {rounded_up(max(misses), digits=2)} mm would be met by the nearest shape found"]
