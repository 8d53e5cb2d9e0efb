"""Frozen values and arrays as plain data that JSON can hold, and such data as text."""

from __future__ import annotations

import json
import math
from dataclasses import asdict, is_dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping

_MOST_INDENTED = 1000  # targets in a file that is laid out for the eye


def plain(content: Mapping[str, object]) -> dict[str, Any]:
    """Return a mapping with arrays as lists, frozen values as dictionaries, and None for NaN and infinity."""
    return {str(key): _plain(item) for key, item in content.items()}


class Plain(list[object]):
    """A list that JSON can hold as it is: of a million targets nobody looks at each number again."""


def _plain(value: object) -> object:
    if isinstance(value, Plain):
        return value
    if is_dataclass(value) and not isinstance(value, type):
        value = asdict(value)
    if isinstance(value, dict):
        return plain(value)
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def json_bytes(content: Mapping[str, object]) -> bytes:
    """Return plain data as the bytes of a JSON file."""
    text = json_text(content, indent=1, ensure_ascii=False) + "\n"
    return text.encode("utf-8", "backslashreplace")  # half a character of a foreign name is no reason to fail


def json_text(content: Mapping[str, object], *, indent: int, ensure_ascii: bool = True) -> str:
    """Return plain data as JSON; very much of it on one line, which is written twenty times as fast.

    Args:
        content: The data.
        indent: By how much each level is indented.
        ensure_ascii: Whether other characters are escaped.
    """
    task = content.get("task")
    many = isinstance(task, dict) and len(task.get("targets", ())) > _MOST_INDENTED
    return json.dumps(content, indent=None if many else indent, allow_nan=False, ensure_ascii=ensure_ascii)
