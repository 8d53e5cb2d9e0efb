"""What to expect of an arm that was measured: each miss, and the chance that all are within tolerance.

Everything is by samples of the arms that the measurement leaves open; nothing is linearised.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen, frozen_value
from synth.measurement import joints_following, random_errors

if TYPE_CHECKING:
    from synth.measurement import ArmFit, Hand, StandingArm

SAMPLES = 2000
_SAMPLES_AFTER = 1000  # joints are sought anew for each of these
_STEPS = 4  # from joint angles a few degrees off


@frozen_value
class Outlook:
    """Misses of the targets over N arms as they may be.

    Attributes:
        joints: The joint angles, shape (n, 2), rad.
        misses: Shape (N, n), m.
        tolerances: Shape (n,), m.
    """

    joints: FloatArray
    misses: FloatArray
    tolerances: FloatArray

    def __post_init__(self) -> None:
        for name in ("joints", "misses", "tolerances"):
            object.__setattr__(self, name, frozen(getattr(self, name)))

    @property
    def expected(self) -> FloatArray:
        """Expected miss of each target, shape (n,), m."""
        return np.asarray(self.misses.mean(axis=0))

    @property
    def miss_95(self) -> FloatArray:
        """Miss of each target that is exceeded once in twenty, shape (n,), m."""
        return np.asarray(np.quantile(self.misses, 0.95, axis=0))

    @property
    def probability_within(self) -> FloatArray:
        """Chance that each target is within its tolerance, shape (n,)."""
        return np.asarray((self.misses <= self.tolerances).mean(axis=0))

    @property
    def probability_all_within(self) -> float:
        """Chance that all are."""
        return float((self.misses <= self.tolerances).all(axis=1).mean())

    @property
    def expected_worst(self) -> float:
        """Expected largest miss, m."""
        return float(self.misses.max(axis=1).mean())

    @property
    def losses(self) -> FloatArray:
        """Largest miss over tolerance, times the least tolerance, shape (N,), m: what decisions go by."""
        return np.asarray((self.misses / self.tolerances).max(axis=1) * self.tolerances.min())


def outlook(fit: ArmFit, joints: FloatArray, targets: FloatArray, tolerances: FloatArray) -> Outlook:
    """Return what joint angles will bring, on the arm that was measured.

    Args:
        fit: The arm and what the measurement leaves open.
        joints: Angles for the targets, shape (n, 2), rad.
        targets: In the frame of the measurement, shape (n, 3), m.
        tolerances: Shape (n,), m.
    """
    arms = fit.samples(SAMPLES)
    reached = arms.forward(np.broadcast_to(joints, (SAMPLES, *joints.shape)))
    return Outlook(joints, np.linalg.norm(reached - targets, axis=-1), tolerances)


def after(
    fit: ArmFit,
    arms: StandingArm,
    joints: FloatArray,
    targets: FloatArray,
    tolerances: FloatArray,
    seed: int = 1,
) -> Outlook:
    """Return what arms will bring once they are measured again, as well as now, with joint angles for each.

    Args:
        fit: The measurement of now, whose errors the next one will have again.
        arms: Arms as they may stand then, one leading axis.
        joints: Angles to begin with, shape (n, 2), rad.
        targets: Shape (n, 3), m.
        tolerances: Shape (n,), m.
        seed: Of the errors.
    """
    measured = arms.displaced(fit.errors(len(arms.end), seed))
    best = joints_following(measured, joints, targets, _STEPS)
    return Outlook(joints, np.linalg.norm(arms.forward(best) - targets, axis=-1), tolerances)


def after_stiffening(
    fit: ArmFit,
    joints: FloatArray,
    targets: FloatArray,
    tolerances: FloatArray,
    hand: Hand,
    count: int = _SAMPLES_AFTER,
) -> Outlook:
    """Return what the arm as it stands will bring once the link is stiff and measured again."""
    drift = random_errors(hand.drift, count, np.random.default_rng(2))
    arms = fit.samples(count, seed=3).moved(drift)
    return after(fit, arms, joints, targets, tolerances)
