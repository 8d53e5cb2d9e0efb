"""How much a shape forgives the hand that bends it: what the targets miss by once the link is placed.

A hand places the link's end 9.64 +- 2.06 mm off (Ranne, Clark and Rojas, 2022), in any direction, and turns
it by 4 +- 1.2 deg about any axis. The joints then take up what they can, within their limits. What is left
depends on the shape: a rigid link that points along the normal of the workspace at a target loses nothing
to a small turn of the link's end, one that lies across it half a metre times the turn.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from statistics import NormalDist
from typing import TYPE_CHECKING

import numpy as np

from synth.robot import Kinematics
from synth.rounding import Unit, rounded_down, rounded_up
from synth.synthesis.shapes import Postures, TargetsSeen
from synth.synthesis.wanted.displaced import Displacements, rotations

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.robot import Arm
    from synth.task import Task

# The error of a hand as published, m, and the turn that goes with it, rad: means and deviations.
_OFF = NormalDist(9.64e-3, 2.06e-3)
_TURNED = NormalDist(math.radians(4.0), math.radians(1.2))
_ERRORS = 128
# Of more targets so many are asked, evenly along the list: the rest hardly changes the worst.
_MOST_TARGETS = 200
_NO_HAND = 0.02  # a chance below is none to count on, and too small to be told from so many tries
_TOGETHER = 20_000  # postures, so that the arrays stay in the cache


@dataclass(frozen=True)
class Forgiveness:
    """What becomes of a task after a hand placed the link, over the errors of a hand.

    Attributes:
        expected_worst_miss: Mean of the largest miss of any target, m.
        chance: Share of the errors with which every target is within its tolerance, 0 to 1.
    """

    expected_worst_miss: float
    chance: float

    def describe(self) -> str:
        """Return what becomes of the task when a hand as published bends the link, and nobody corrects it."""
        hand = (
            f"a hand as published ({1e3 * _OFF.mean:.1f} ± {1e3 * _OFF.stdev:.1f} mm, "
            f"{math.degrees(_TURNED.mean):.0f} ± {math.degrees(_TURNED.stdev):.1f} deg)"
        )
        miss = f"expect a worst miss of {rounded_up(self.expected_worst_miss)} mm"
        rest = f"joints recomputed from the measured arm; {miss}. So measure, and correct until it is right."
        begin = "No hand holds this at the first try:" if self.chance < _NO_HAND else "At the first try"
        return f"{begin} {hand} meets every target in {self.chance_told} of tries, {rest}"

    @property
    def chance_told(self) -> str:
        """The chance in percent, rounded down; of so many tries neither 0 nor 100 is proven."""
        if self.chance < _NO_HAND:
            return "less than 2 %"
        return f"about {min(int(rounded_down(self.chance, Unit.PERCENT, 0)), 99)} %"


@cache
def _hand(errors: int) -> Displacements:
    """Return so many errors, by which every shape is judged: a fixed sample that fills its space evenly."""
    # The additive recurrence of the root of g^7 = g + 1 (Roberts, 2018), in six dimensions.
    root = 1.0
    for _ in range(60):
        root = (1.0 + root) ** (1.0 / 7.0)
    steps = root ** -np.arange(1.0, 7.0)
    uniform = (0.5 + np.arange(1.0, errors + 1.0)[:, None] * steps) % 1.0
    off, turned = (
        np.maximum([of.inv_cdf(float(u)) for u in column], 0.0)
        for of, column in ((_OFF, uniform[:, 0]), (_TURNED, uniform[:, 3]))
    )
    axes = _directions(uniform[:, 4:6])
    return Displacements(off[:, None] * _directions(uniform[:, 1:3]), rotations(turned[:, None] * axes))


def hand_forgiveness(task: Task, arm: Arm, joints: FloatArray | None = None) -> Forgiveness:
    """Return what becomes of a task after a hand placed the link.

    Args:
        task: The task.
        arm: The robot in the shape that the hand aims at.
        joints: Its joint angles at the targets, shape (n, 2), rad; by default the closest ones.
    """
    frame, end = arm.end_frame
    circle = arm.circle
    kinematics = Kinematics(frame[None], circle.centre[None], np.array([circle.radius]))
    some = _some(len(task.targets))
    there = arm.closest_joints(task.table.positions[some])[0] if joints is None else joints[some]
    aims = TargetsSeen.from_base(task, arm.base, some)
    worst, within = misses_after_a_hand(aims, task.tolerances[some], kinematics, end[None], there[None, :, 1])
    return Forgiveness(float(worst[0]), float(within[0]))


def misses_after_a_hand(
    aims: TargetsSeen,
    tolerances: FloatArray,
    kinematics: Kinematics,
    ends: FloatArray,
    theta2: FloatArray,
    errors: int = _ERRORS,
) -> tuple[FloatArray, FloatArray]:
    """Return the expected worst misses of many shapes, m, and their chances, both of shape (N,).

    Args:
        aims: The targets.
        tolerances: Their tolerances, shape (n,), m.
        kinematics: The joints of the shapes, of shape (N,).
        ends: Where their links end, shape (N, 3), m.
        theta2: Angles of joint 2 at which they meet the targets, shape (N, n), rad.
        errors: Over how many errors of a hand: fewer are less exact and sooner done.
    """
    hand, count = _hand(errors), errors
    together = max(1, _TOGETHER // (count * len(tolerances)))
    worst, within = np.empty(len(ends)), np.empty(len(ends))
    for first in range(0, len(ends), together):
        some = slice(first, first + together)
        aimed = Kinematics(kinematics.frame[some], kinematics.centre[some], kinematics.radius[some])
        from_here = np.repeat(theta2[some], count, axis=0)
        left = Postures.led_from(aims, hand.on(aimed, ends[some]), from_here, never_away=True)
        misses = left.misses.reshape(-1, count, len(tolerances))
        met = (misses <= tolerances) & (left.astray == 0.0).reshape(misses.shape)
        worst[some] = misses.max(axis=2).mean(axis=1)
        within[some] = met.all(axis=2).mean(axis=1)
    return worst, within


def _some(count: int) -> NDArray[np.intp] | slice:
    """Return which of so many targets are asked."""
    if count <= _MOST_TARGETS:
        return slice(None)
    return np.linspace(0, count - 1, _MOST_TARGETS).astype(np.intp)


def _directions(uniform: FloatArray) -> FloatArray:
    """Return unit vectors, uniform on the sphere, for points of the unit square, shape (E, 2)."""
    height, angle = 2.0 * uniform[:, 0] - 1.0, 2.0 * np.pi * uniform[:, 1]
    across = np.sqrt(1.0 - height**2)
    return np.column_stack([across * np.cos(angle), across * np.sin(angle), height])
