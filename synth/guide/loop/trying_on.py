"""Is another correction worth it? A softened link cannot go back to where it was."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from synth.guide.loop.outlook import after
from synth.measurement import random_errors

if TYPE_CHECKING:
    from synth.arrays import FloatArray
    from synth.guide.loop.outlook import Outlook
    from synth.measurement import ArmFit, Hand

_SAMPLES = 300


def after_correction(
    fit: ArmFit,
    move: FloatArray,
    rms: tuple[float, float],
    joints: FloatArray,
    targets: FloatArray,
    tolerances: FloatArray,
    hand: Hand,
) -> Outlook:
    """Return what the arm will bring after a correction with errors, stiffened and measured again.

    Args:
        fit: The arm as it stands.
        move: Displacement of its link's end asked for, shape (6,), m and rad.
        rms: Errors of carrying it out, m and rad.
        joints: Angles to begin with, shape (n, 2), rad.
        targets: Shape (n, 3), m.
        tolerances: Shape (n,), m.
        hand: The hand.
    """
    rng = np.random.default_rng(4)
    together = (math.hypot(rms[0], hand.drift[0]), math.hypot(rms[1], hand.drift[1]))
    arms = fit.arm.moved(move).displaced(
        np.hstack([np.zeros((_SAMPLES, 5)), random_errors(together, _SAMPLES, rng)])
    )
    return after(fit, arms, joints, targets, tolerances)


def value_of_trying(
    fit: ArmFit,
    move: FloatArray,
    joints: FloatArray,
    targets: FloatArray,
    tolerances: FloatArray,
    hand: Hand,
    corrections: int,
) -> tuple[float, Outlook]:
    """Return the expected loss of who tries on as long as that is worth it, and the outlook of the next try.

    Each further correction begins where the one before ended: it is as large as that one's error. Whoever has
    k corrections left stops where the loss is below the value of trying on: V_0 = infinity,
    V_k = E min(loss after a correction, V_(k-1)).

    Args:
        fit: The arm as it stands.
        move: The correction to come, shape (6,), m and rad.
        joints: Angles after it, shape (n, 2), rad.
        targets: Shape (n, 3), m.
        tolerances: Shape (n,), m.
        hand: The hand.
        corrections: How many are left, at least 1.
    """
    rms = hand.correction_rms(move)
    first = after_correction(fit, move, rms, joints, targets, tolerances, hand)
    tries = [first]
    for _ in range(corrections - 1):
        rms = (math.hypot(hand.share * rms[0], hand.floor[0]), math.hypot(hand.share * rms[1], hand.floor[1]))
        tries.append(after_correction(fit, move, rms, joints, targets, tolerances, hand))
    value = math.inf
    for each in reversed(tries):
        value = float(np.minimum(each.losses, value).mean())
    return value, first
