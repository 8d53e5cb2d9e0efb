"""Every error that `synth` raises on purpose: one base exception and its few leaves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence


class SynthError(Exception):
    """Base of all errors raised by `synth`: catch this one to catch them all."""


class GeometryError(SynthError):
    """Distances or invariants that no points in space can have."""


@dataclass(frozen=True)
class Mistake:
    """One thing wrong in an input, and where it stands.

    Attributes:
        message: What is wrong and what would be right, as a sentence for the user.
        file: Name of the file, or None for an input that never was a file.
        line: Line in the file, from 1, or None where a line means nothing.
        key: Path of the key, such as `targets[2].tolerance`; empty for the file as a whole.
    """

    message: str
    file: str | None = None
    line: int | None = None
    key: str = ""

    def __str__(self) -> str:
        place = ":".join(str(part) for part in (self.file, self.line) if part is not None)
        return ": ".join(part for part in (place, self.key, self.message) if part)


class InputError(SynthError):
    """Wrong input, with every mistake found and not only the first.

    Attributes:
        mistakes: All mistakes, in the order of the file.
    """

    def __init__(self, mistakes: Sequence[Mistake]) -> None:
        self.mistakes = tuple(mistakes)
        super().__init__("\n".join(str(mistake) for mistake in self.mistakes))


class TimeLimitError(SynthError):
    """The time was up before there was anything to return."""


class SolverError(SynthError):
    """The solver broke down in a way that says nothing about the task."""


def in_a_line(error: BaseException) -> str:
    """Return what an error of any kind says, on one line, with its kind where nobody foresaw it."""
    words = " ".join(str(error).split())
    if words and isinstance(error, SynthError):
        return words
    return f"{words} ({type(error).__name__})" if words else type(error).__name__
