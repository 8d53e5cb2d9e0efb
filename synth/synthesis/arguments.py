"""What the verbs of the synthesis are given, checked before anything is computed."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from synth.checks import described, wrong_number, wrong_type
from synth.errors import InputError, Mistake
from synth.synthesis.solution import Solution
from synth.task import as_task

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Mapping

    from synth.task import Task


def checked_task(
    source: Task | str | os.PathLike[str] | Mapping[str, object],
    *,
    seed: int,
    warm_start: Solution | None,
    alternatives: int,
    time_limit: float,
    is_up: Callable[[], bool],
) -> Task:
    """Return the task to solve, with all else that `solve` is given found right; `is_up` as for `as_task`.

    Raises:
        InputError: With every mistake, those of the task first.
    """
    mistakes: list[Mistake] = []
    try:
        task = as_task(source, is_up=is_up)
    except InputError as error:
        mistakes.extend(error.mistakes)
    wrong = {
        "seed": _wrong_count(seed),
        "warm_start": "" if warm_start is None else wrong_type(warm_start, Solution),
        "alternatives": _wrong_count(alternatives),
        "time_limit": wrong_number(time_limit, least=0.0, most=math.inf),
    }
    mistakes.extend(Mistake(sentence, key=key) for key, sentence in wrong.items() if sentence)
    if mistakes:
        raise InputError(mistakes)
    return task


def _wrong_count(value: object) -> str:
    """Return what is wrong with a whole number from 0, or nothing."""
    if isinstance(value, bool) or not hasattr(value, "__index__"):
        return f"must be a whole number, but is {described(value)}"
    return "" if value.__index__() >= 0 else f"must be at least 0, but is {described(value)}"
