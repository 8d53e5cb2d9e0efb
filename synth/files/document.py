"""An input as plain values, with the place of every key and the mistakes found in it."""

from __future__ import annotations

import json
import math
import os
import re
from collections.abc import Callable, Mapping
from enum import Enum
from typing import Any

import numpy as np

from synth.errors import InputError, Mistake, TimeLimitError
from synth.watch import never

KeyPath = tuple[str | int, ...]

MAX_DEPTH = 20  # the deepest key of the format stands at 5
_EXACT = 2**53  # integers up to here are floats too


class Refused:
    """Stands for a value whose mistake is already reported, so that nothing more is said of it."""


REFUSED = Refused()


def key_text(path: KeyPath) -> str:
    """Write the path of a key as a user reads it: `targets[2].tolerance`."""
    text = ""
    for part in path:
        if isinstance(part, int):
            text += f"[{part}]"
        else:
            word = part if re.fullmatch(r"[\w-]{1,40}", part) else repr(part[:40])
            text += f".{word}" if text else word
    return text


def key_path(text: str) -> KeyPath:
    """Return the path that `key_text` wrote, of keys that need no quotes."""
    return tuple(int(part) if part.isdigit() else part for part in re.findall(r"[^.\[\]]+", text))


class Document:
    """The content of an input as plain values, and the mistakes found in it so far.

    Attributes:
        value: Mappings, lists, texts, numbers, booleans and None; `REFUSED` where there was a mistake.
        file: Name of the file, or None.

    Args:
        file: Name of the file.
        is_up: Asked now and then whether the time for reading is up.
    """

    def __init__(self, file: str | None = None, is_up: Callable[[], bool] = never) -> None:
        self.value: Any = REFUSED
        self.file = file
        self._is_up = is_up
        self._places: dict[KeyPath, tuple[int, int]] = {}  # line (0: none) and rank in the input
        self._found: list[tuple[tuple[int, int], Mistake]] = []

    @classmethod
    def from_mapping(cls, mapping: Mapping[str, object]) -> Document:
        """Take a mapping in Python; tuples, arrays, enumerations and paths are read as in a file."""
        document = cls()
        document.value = document._plain(mapping, ())
        return document

    @classmethod
    def from_json(cls, text: str, file: str | None = None) -> Document:
        """Take a JSON text that a program wrote: its mistakes have keys and no lines.

        Args:
            text: The text.
            file: Name of the file that it stands in.

        Raises:
            InputError: It is no JSON.
        """
        document = cls(file)
        try:
            document.value = json.loads(text)
        except (ValueError, RecursionError):
            raise InputError([Mistake("is no JSON", file)]) from None
        return document

    def see_the_time(self, advice: str = "") -> None:
        """Go on if there is time.

        Args:
            advice: How it would take less.

        Raises:
            TimeLimitError: There is none.
        """
        if self._is_up():
            raise TimeLimitError(
                f"the time limit was over before the task was read: nothing was searched for{advice}"
            )

    def place(self, path: KeyPath, line: int = 0) -> None:
        """Note where a key stands; keys come in the order of the input."""
        self._places[path] = (line, len(self._places))

    def report(self, path: KeyPath, message: str, line: int = 0) -> None:
        """Note a mistake at a key or, if the key is not there, at what it belongs to."""
        place = self._nearest(path)
        line = line or place[0]
        self._found.append(((line, place[1]), Mistake(message, self.file, line or None, key_text(path))))

    def adopt(self, path: KeyPath, mistake: Mistake) -> None:
        """Note a mistake in another file, which a key refers to."""
        self._found.append((self._nearest(path), mistake))

    def refuse(self, error: InputError, path: KeyPath = ()) -> InputError:
        """Return all mistakes and, at their keys below a path, those that a value of this input has."""
        for mistake in error.mistakes:
            self.report((*path, *key_path(mistake.key)), mistake.message)
        return self.error()

    @property
    def is_wrong(self) -> bool:
        """Whether a mistake was found."""
        return bool(self._found)

    def error(self) -> InputError:
        """Return all mistakes as one error, in the order of the input."""
        return InputError([mistake for _, mistake in sorted(self._found, key=lambda found: found[0])])

    def _nearest(self, path: KeyPath) -> tuple[int, int]:
        while path and path not in self._places:
            path = path[:-1]
        return self._places.get(path, (0, 0))

    def _plain(self, value: Any, path: KeyPath) -> object:
        self.place(path)
        if len(path) > MAX_DEPTH:
            self.report(path[:1], f"is nested more than {MAX_DEPTH} levels deep")
            return REFUSED
        if isinstance(value, np.ndarray | np.generic):
            value = value.tolist()
        elif isinstance(value, Enum):
            value = value.value
        elif isinstance(value, os.PathLike):
            value = os.fspath(value)
        if isinstance(value, Mapping):
            if not all(isinstance(key, str) for key in value):
                self.report(path, "keys must be texts")
            return {
                key: self._plain(item, (*path, key)) for key, item in value.items() if isinstance(key, str)
            }
        if isinstance(value, list | tuple):
            return [self._plain(item, (*path, index)) for index, item in enumerate(value)]
        if isinstance(value, int) and abs(value) > _EXACT:
            return math.inf if value > 0 else -math.inf  # beyond all that is allowed, and safe to handle
        return value
