"""What sheet and page say of an outcome, in the same words: that it is found, or what is missed and why."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from synth.synthesis import Status, ending, help_told, proof_sentence, reasons_told

if TYPE_CHECKING:
    from synth.synthesis import Solution

_MOST_REASONS = 5  # as on the terminal
_MOST_RELEASES = 5


def headline_told(solution: Solution) -> str:
    """Return how the search ended; of a task that is missed behind a word that nobody may overlook."""
    if solution.found:
        return f"Found: {ending(solution.status, solution.designs)}."
    word = "IMPOSSIBLE" if solution.status is Status.PROVEN_IMPOSSIBLE else "NOT FOUND"
    return f"{word}: {solution.status.sentence}"


def why_told(solution: Solution) -> list[str]:
    """Return why a task is missed, and what is proven of it."""
    told = reasons_told(solution, _MOST_REASONS)
    proof = proof_sentence(solution)
    return [*told, proof] if proof else told


def help_in_few(solution: Solution) -> list[str]:
    """Return what would help a task that is missed, of many releases the first; and the notes."""
    return help_told(replace(solution, releases=solution.releases[:_MOST_RELEASES]))
