"""Links turned about axis 1, so that the dead zone of joint 1 lies where no path passes."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from synth.synthesis.check import verify_targets
from synth.synthesis.wanted import Design

if TYPE_CHECKING:
    from collections.abc import Iterator

    from synth.robot import Arm
    from synth.task import Task
    from synth.watch import Watch

_TURNS = 24


def turned_designs(task: Task, design: Design, watch: Watch) -> Iterator[Design]:
    """Yield designs whose link is turned about axis 1, of those that reach every sample of all paths.

    Where joint 1 turns back by as much the arm stands as before; what is another is where it may not stand.

    Args:
        task: The task.
        design: A shape that reaches every sample and does not follow the paths.
        watch: When it is up, no more turns are looked at.
    """
    for number in range(1, _TURNS):
        if watch.is_up():
            return
        arm = _turned(design.arm, 2.0 * math.pi * number / _TURNS)
        check = verify_targets(task, arm)
        if check.found:
            yield Design(arm, check)


def _turned(arm: Arm, angle: float) -> Arm:
    """Return an arm whose link is turned about axis 1 by an angle, rad."""
    cosine, sine = math.cos(angle), math.sin(angle)
    rotation = np.array([[cosine, sine], [-sine, cosine]])
    return replace(arm, shape=replace(arm.shape, curvatures=arm.shape.curvatures @ rotation))
