"""Names and words: those given twice, and those that are nearly a known one."""

from __future__ import annotations

import difflib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence


def given_twice(names: Sequence[str]) -> list[tuple[int, int]]:
    """Return where names stand that stood before, each with the place where it stood first."""
    if len(set(names)) == len(names):
        return []
    first: dict[str, int] = {}
    places = ((index, first.setdefault(name, index)) for index, name in enumerate(names))
    return [(index, before) for index, before in places if before != index]


def did_you_mean(word: object, known: Iterable[str]) -> str:
    """Return `; did you mean 'this'?` for a word close to a known one, and nothing otherwise."""
    return "".join(f"; did you mean {close!r}?" for close in guesses(word, known))


def guesses(word: object, known: Iterable[str]) -> list[str]:
    """Return the known word closest to one that is not known, in a list of one or none."""
    return difflib.get_close_matches(word.lower(), list(known), n=1) if isinstance(word, str) else []
