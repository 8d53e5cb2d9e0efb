"""What is told of an outcome: headline, reasons, proof, help, the shape; on the terminal and by `print`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from synth.rounding import counted
from synth.sentences import FOUND, MISSED, bulleted, headed
from synth.synthesis.solution.message import Status, ending
from synth.synthesis.solution.shape_text import shape_lines, target_lines
from synth.synthesis.solution.surface_text import met_tolerances

if TYPE_CHECKING:
    from synth.synthesis.solution.outcome import Outcome

_MOST_REASONS = 5


def summary(outcome: Outcome) -> str:
    """Return a result as a headline, what is known of it, and a few bullets, for any status."""
    task, bullets = outcome.task, []
    sign = FOUND if outcome.found else MISSED
    lines = [*map(bulleted, knowledge(outcome))]
    if outcome.designs:
        lines += target_lines(task, outcome.designs[0])
        bullets = shape_lines(task, outcome.designs[0])
    else:
        asked = counted(len(task.targets), "target")
        lines.append(bulleted(f"{asked} asked for, none reached: there is no shape"))
    if len(outcome.designs) > 1:
        best = (", the best" if outcome.found else ", the nearest") if outcome.shape == 1 else ""
        bullets.append(
            f"{len(outcome.designs)} distinct shapes; this is shape {outcome.shape}{best} "
            "(--all lists them, --shape K shows another)"
        )
    starts = counted(outcome.starts, "start")
    bullets.append(f"seed {outcome.seed}, {starts}, {outcome.time.total:.2f} s")
    headline = f"{sign} {task.name}: {ending(outcome.status, outcome.designs)}"
    return headed(headline, [*lines, *map(bulleted, bullets)])


def knowledge(outcome: Outcome, most: int = _MOST_REASONS) -> list[str]:
    """Return why no more was found, what is proven, and what would help: of many reasons the first.

    Args:
        outcome: The result.
        most: How many reasons are told.
    """
    proof = proof_sentence(outcome)
    told = [*reasons_told(outcome, most), *([proof] if proof else [])]
    return [*told, *help_told(outcome)]


def help_told(outcome: Outcome) -> list[str]:
    """Return what would let a task be met that is not, how more is found out, and what else is to be said."""
    if outcome.found or outcome.status is Status.FAILED:
        return list(outcome.notes)
    told = [f"{release.sentence} would do" for release in outcome.releases]
    open_yet = outcome.status is not Status.PROVEN_IMPOSSIBLE
    if open_yet and outcome.designs and not outcome.designs[0].verification.violations:
        told += met_tolerances(outcome.task, outcome.designs[0])
    told += outcome.notes
    if outcome.status is Status.LIMIT:
        told.append("more time may find a shape")
    if not (outcome.explained or outcome.releases):
        told.append("solving with --why looks for one limit that, if it gave way, would let the task be met")
    if open_yet and outcome.bound is None and outcome.task.robot.rigid_link.is_fixed:
        told.append("solving with --prove tells how near any shape can come, or that the task is impossible")
    return told


def reasons_told(outcome: Outcome, most: int) -> list[str]:
    """Return why no more was found, but for what `proof_sentence` says: of many the first, counted."""
    bound = outcome.bound
    reasons = [reason for reason in outcome.reasons if bound is None or reason != bound.sentence]
    if len(reasons) <= most:
        return reasons
    return [*reasons[:most], f"and {len(reasons) - most} more of this kind"]


def proof_sentence(outcome: Outcome) -> str:
    """Return what `--prove` proved, of the shape that is shown; empty if it was not asked."""
    bound = outcome.bound
    if bound is None:
        return ""
    if not outcome.designs:
        return bound.sentence
    weights = bound.tightest_tolerance / outcome.task.tolerances
    worst = float(np.max(outcome.designs[0].verification.misses * weights))
    return bound.sentence_of_shape(worst)
