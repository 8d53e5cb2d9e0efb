"""What becomes of a shape when a hand bends it: the expected worst miss, and the chance to meet the task.

The hand is that of the published study (Ranne, Clark and Rojas, 2022): with holographic guidance it places
the link's end to 9.64 +- 2.06 mm; that it turns it by 4 +- 1.2 deg is taken to go with it. The joint angles
are computed anew for the arm that then stands there, as after measuring it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen
from synth.synthesis.displaced import misses_displaced, rotations

if TYPE_CHECKING:
    from synth.robot import Arm
    from synth.task import Task

HAND_PLACES, HAND_TURNS = (9.64e-3, 2.06e-3), (math.radians(4.0), math.radians(1.2))  # mean and deviation
_TRIES = 256
_TARGETS = 500  # as many are looked at, evenly drawn from more


@dataclass(frozen=True)
class Forgiveness:
    """What a shape forgives the hand that bends it.

    Attributes:
        expected_worst_miss: The largest miss of the targets, in the mean over many tries, m.
        chance: Share of the tries, in [0, 1], in which all targets are within their tolerances.
    """

    expected_worst_miss: float
    chance: float


def hand_forgiveness(task: Task, arm: Arm) -> Forgiveness:
    """Return what a shape forgives a hand, by a fixed set of errors: the same each time.

    Args:
        task: The task.
        arm: The robot in the shape that the hand aims at.
    """
    shifts, turns = _errors()
    some = slice(None, None, -(-len(task.targets) // _TARGETS))
    misses = misses_displaced(arm, task.positions[some], shifts, turns)
    tolerances = task.tolerances[some]
    return Forgiveness(
        float(misses.max(axis=1).mean()),
        float((misses <= tolerances).all(axis=1).mean()),
    )


@cache
def _errors() -> tuple[FloatArray, FloatArray]:
    """Return the errors of the hand: shifts, shape (k, 3), m, and rotations, shape (k, 3, 3)."""
    rng = np.random.default_rng(0)
    vectors = []
    for mean, deviation in (HAND_PLACES, HAND_TURNS):
        directions = rng.normal(size=(_TRIES, 3))
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
        vectors.append(np.abs(rng.normal(mean, deviation, _TRIES))[:, None] * directions)
    return frozen(vectors[0]), frozen(rotations(vectors[1]))
