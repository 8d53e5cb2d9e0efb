"""Enumerations whose members carry the sentence that the user reads."""

from __future__ import annotations

from enum import Enum
from typing import Self


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
