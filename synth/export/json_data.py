"""Frozen values and arrays as plain data that JSON can hold."""

from __future__ import annotations

import math
from dataclasses import asdict, is_dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping


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
