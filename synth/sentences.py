"""What the user reads: enumerations whose members carry their sentence, and a headline over a few bullets.

✓ and ✗ stand where the terminal may colour a line or put other signs.
"""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING, Self

if TYPE_CHECKING:
    from collections.abc import Iterable

FOUND = "✓"
MISSED = "✗"
BULLET = "•"
_WIDTH = 79  # characters of a terminal that is not set wider


class SentenceEnum(Enum):
    """Base of enumerations written as `MEMBER = "value", "sentence"`.

    Attributes:
        value: The word of the file format.
        sentence: The same for the user.
    """

    sentence: str

    def __new__(cls, value: str, sentence: str) -> Self:
        """Take the sentence off the value."""
        member = object.__new__(cls)
        member._value_ = value
        member.sentence = sentence
        return member


def headed(headline: str, lines: Iterable[str]) -> str:
    """Return lines below a headline and a rule, without a line break at the end."""
    return "\n".join([headline, "=" * min(len(headline), _WIDTH), *lines])


def bulleted(line: str) -> str:
    """Return a line with a bullet before it."""
    return f"{BULLET} {line}"
