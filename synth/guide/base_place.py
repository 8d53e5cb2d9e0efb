"""Where the base was chosen to stand, and how precisely: what an error of it does to the targets."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from synth.robot import BaseChoices, BasePose

if TYPE_CHECKING:
    from collections.abc import Callable

    from synth.arrays import FloatArray
    from synth.robot import Arm
    from synth.synthesis import Design
    from synth.task import Task

_FARTHEST, _MOST_TURN = 0.1, math.radians(10.0)  # m, rad: farther off nobody is
_HALVINGS = 12
_MOST_TARGETS = 200  # those with the least to spare; the others are lost later
# Along the axes, the edges and the corners of a cube.
_DIRECTIONS = np.array([way for way in itertools.product((-1.0, 0.0, 1.0), repeat=3) if any(way)])
_AXES = np.concatenate([np.eye(3), -np.eye(3)])


@dataclass(frozen=True)
class BasePlace:
    """The place of a base that the synthesis chose, and how far it may be off.

    Attributes:
        name: What the place is called, where one of several was chosen; else empty.
        position: The base may be shifted by so much in any direction, if nothing else is off, m.
        turn: It may be turned by so much about any axis of its frame, if nothing else is off, rad.
    """

    name: str
    position: float
    turn: float


def base_place(task: Task, design: Design) -> BasePlace | None:
    """Return where the base was chosen to stand and how precisely; None where the task says it.

    With the base off, the joints make the best of it. Errors are tried in 26 directions and about three axes.

    Args:
        task: The task, with its base where it was chosen.
        design: A shape that meets it there.
    """
    if task.places is None or not design.verification.found:
        return None
    name = task.places.name_of(task.base) if isinstance(task.places, BaseChoices) else None
    arm, check = design.arm, design.verification
    tight = np.argsort(task.tolerances - check.misses, kind="stable")[:_MOST_TARGETS]
    targets, tolerances = task.table.positions[tight], task.tolerances[tight]

    def keeps(seen: FloatArray) -> bool:
        """Whether all targets stay within their tolerance where the base sees them, shape (k, n, 3)."""
        _, misses = arm.closest_joints(seen.reshape(-1, 3))
        return bool((misses.reshape(len(seen), -1) <= tolerances).all())

    ways = _DIRECTIONS / np.linalg.norm(_DIRECTIONS, axis=1, keepdims=True)
    position = _largest(lambda off: keeps(targets - off * ways[:, None]), _FARTHEST)
    turn = _largest(lambda off: keeps(_turned(arm, targets, off)), _MOST_TURN)
    return BasePlace(name or "", position, turn)


def _turned(arm: Arm, targets: FloatArray, angle: float) -> FloatArray:
    """Return where targets are as seen by a base that is turned about each of its axes, both ways."""
    turns = np.stack([BasePose(np.zeros(3), *(angle * axis)).rotation for axis in _AXES])
    return arm.base.to_task(arm.base.to_base(targets) @ turns)


def _largest(is_kept: Callable[[float], bool], most: float) -> float:
    """Return the largest error that is kept, by bisection."""
    if is_kept(most):
        return most
    kept, lost = 0.0, most
    for _ in range(_HALVINGS):
        middle = 0.5 * (kept + lost)
        if is_kept(middle):
            kept = middle
        else:
            lost = middle
    return kept
