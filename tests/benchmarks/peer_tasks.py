"""The tasks of `peers.py`: planted ones with exact targets, and noisy ones without an exact answer."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from planted import planted_task

if TYPE_CHECKING:
    from synth.task import Task

NOISE = 0.03  # standard deviation of each coordinate of a noisy target, m
FEWEST, MOST = 6, 40


def noisy_task(seed: int, count: int | None = None) -> Task:
    """Return a planted task, without a floor, whose targets are off by a normal error of 30 mm."""
    rng = np.random.default_rng([seed, 2])
    count = count or int(np.random.default_rng([seed, 3]).integers(FEWEST, MOST + 1))
    task, _ = planted_task(seed, count)
    shifts = rng.normal(scale=NOISE, size=(count, 3))
    targets = tuple(
        replace(target, position=target.position + shift)
        for target, shift in zip(task.targets, shifts, strict=True)
    )
    return replace(task, name=f"noisy {seed}", targets=targets, floor=None)
