"""The check of a link as it stands: lock it, correct it, or leave it at that.

    Readings -> ArmFit -> Outlook -> Verdict, and the one correction that is worth most
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen
from synth.guide.aim import best_aims
from synth.guide.hand import Hand
from synth.guide.outlook import Outlook, after_stiffening, outlook
from synth.guide.trying_on import value_of_trying
from synth.sentences import SentenceEnum

if TYPE_CHECKING:
    from collections.abc import Sequence

    from synth.measurement import ArmFit, StandingArm
    from synth.synthesis import Design
    from synth.task import Task

CONFIDENCE = 0.95
CORRECTIONS = 3  # that are left, unless told
_MUCH_BETTER = 0.5e-3  # m; other joint angles than the planned branch must be so much better to be taken


class Verdict(SentenceEnum):
    """What to do with the link as it stands."""

    LOCK = "lock", "stiffen the link as it is"
    CORRECT = "correct", "move the link's end as told, then measure again"
    BEST_POSSIBLE = "best_possible", "leave it: trying on would make it worse rather than better"
    UNUSABLE = "unusable", "the measurement does not show where the arm stands"


@dataclass(frozen=True, eq=False)
class Correction:
    """A displacement of the link's end, as a person carries it out.

    Attributes:
        move: Shift, shape (3,), m, and
        rotate: rotation vector about the link's end, shape (3,), rad; in the base frame, joint 1 as measured.
        aim: The arm that should stand there then.
        joints: Joint angles for the targets there, shape (n, 2), rad.
        outlook: What to expect once an average hand did it, and the link was stiffened and measured again.
        value: Expected largest miss, over tolerance times the least one, of whoever tries on as long as it is
            worth it, m.
    """

    move: FloatArray
    rotate: FloatArray
    aim: StandingArm
    joints: FloatArray
    outlook: Outlook
    value: float

    def __post_init__(self) -> None:
        for name in ("move", "rotate", "joints"):
            object.__setattr__(self, name, frozen(getattr(self, name)))


@dataclass(frozen=True, eq=False)
class Check:
    """What is to be said of a link as it stands.

    Attributes:
        task: What is asked.
        fit: The arm that stands there.
        now: What to expect with the joint angles `now.joints`, if nothing moves any more.
        stiffened: The same once the link was stiffened and measured again, with joint angles for what was
            measured then; the same as `now` if it is stiff already.
        verdict: What to do.
        correction: The one that is worth most; None where the verdict is not to correct.
        confidence: Chance that all targets are within tolerance from which on a link is locked.
    """

    task: Task
    fit: ArmFit
    now: Outlook
    stiffened: Outlook
    verdict: Verdict
    correction: Correction | None
    confidence: float

    @property
    def probability(self) -> float:
        """Chance that every target is within its tolerance: now, and after stiffening, whichever is less."""
        return min(self.now.probability_all_within, self.stiffened.probability_all_within)


def best_joints(arm: StandingArm, task: Task, planned: FloatArray) -> FloatArray:
    """Return the joint angles that come closest to the targets on an arm as it stands.

    Args:
        arm: The arm.
        task: The task.
        planned: The joint angles of the design, shape (n, 2), rad. Only they are known to be clear of obstacles
            and of the arm itself; so another branch is taken only where it is much better.
    """
    near = arm.following(planned, task.positions)
    closest = arm.closest(task.positions)
    misses = [
        np.linalg.norm(arm.forward(joints) - task.positions, axis=-1) for joints in (near, closest)
    ]
    other = misses[1] < misses[0] - (np.inf if task.obstacles else _MUCH_BETTER)
    return np.where(other[:, None], closest, near)


def check_arm(
    task: Task,
    designs: Sequence[Design],
    fit: ArmFit,
    *,
    corrections: int = CORRECTIONS,
    confidence: float = CONFIDENCE,
    stiff: bool = False,
    hand: Hand | None = None,
) -> Check:
    """Say what to do with a link as it stands.

    Args:
        task: What is asked.
        designs: Shapes that meet it, the one that was wanted first.
        fit: The arm that stands there.
        corrections: How many more the operator is willing to make.
        confidence: Chance that all targets are within tolerance from which on the link is locked.
        stiff: Whether the link was stiff already when it was measured.
        hand: The hand; the published one unless told.
    """
    hand = hand or Hand()
    targets, tolerances = task.positions, task.tolerances
    joints = best_joints(fit.arm, task, designs[0].verification.joints)
    now = outlook(fit, joints, targets, tolerances)
    stiffened = now if stiff else after_stiffening(fit, joints, targets, tolerances, hand)
    sure = fit.shows_axes and fit.shows_roll
    likely = min(now.probability_all_within, stiffened.probability_all_within)
    correction = None
    if not fit.shows_axes:
        verdict = Verdict.UNUSABLE
    elif sure and likely >= confidence:
        verdict = Verdict.LOCK
    else:
        verdict = Verdict.BEST_POSSIBLE
        if corrections > 0:
            correction = _correction(task, designs, fit, joints, hand, corrections)
            if correction.value < float(stiffened.losses.mean()):
                verdict = Verdict.CORRECT
    if verdict is not Verdict.CORRECT:
        correction = None
    return Check(task, fit, now, stiffened, verdict, correction, confidence)


def _correction(
    task: Task,
    designs: Sequence[Design],
    fit: ArmFit,
    joints: FloatArray,
    hand: Hand,
    corrections: int,
) -> Correction:
    """Return the correction that is worth most."""
    weights = task.tolerances.min() / task.tolerances
    # What a correction leaves is corrected by the next one.
    share = hand.share**corrections
    aims = best_aims(fit.arm, [design.arm for design in designs], joints, task.positions, weights, hand, share)
    best: Correction | None = None
    for _, move, there in aims[:1]:
        value, first = value_of_trying(
            fit, move, there, task.positions, task.tolerances, hand, corrections
        )
        if best is None or value < best.value:
            best = Correction(move[:3], move[3:], fit.arm.moved(move), there, first, value)
    assert best is not None
    return best
