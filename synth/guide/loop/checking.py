"""The check of a link as it stands: lock it, correct it, or leave it at that.

Readings -> ArmFit -> Outlook -> Verdict, and the one correction that is worth most
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen, frozen_value
from synth.guide.loop.aim import best_aims, size, towards
from synth.guide.loop.outlook import Outlook, after_stiffening, outlook
from synth.guide.loop.trying_on import value_of_trying
from synth.measurement import Hand, joints_closest_to, joints_following, onto_vertical
from synth.robot import link_to_pose
from synth.sentences import SentenceEnum
from synth.synthesis import verify

if TYPE_CHECKING:
    from collections.abc import Sequence

    from synth.measurement import ArmFit, StandingArm
    from synth.robot import Arm, LinkShape, Robot
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


@frozen_value
class Correction:
    """A displacement of the link's end, as a person carries it out.

    Attributes:
        move: Shift, shape (3,), m, and
        rotate: rotation vector about the link's end, shape (3,), rad; in the base frame, joint 1 as measured.
        aim: The arm that should stand there then.
        shape: A shape of the link that has its end there; None where the aim is a design itself.
        joints: Joint angles for the targets there, shape (n, 2), rad.
        outlook: What to expect once an average hand did it, and the link was stiffened and measured again.
        value: Expected largest miss, over tolerance times the least one, of whoever tries on as long as it is
            worth it, m.
    """

    move: FloatArray
    rotate: FloatArray
    aim: StandingArm
    shape: LinkShape | None
    joints: FloatArray
    outlook: Outlook
    value: float

    def __post_init__(self) -> None:
        for name in ("move", "rotate", "joints"):
            object.__setattr__(self, name, frozen(getattr(self, name)))


@frozen_value
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
        planned: The joint angles of the design, shape (n, 2), rad. Only they are known to be clear of
            obstacles and of the arm itself; so another branch is taken only where it is much better.
    """
    near = joints_following(arm, planned, task.positions_in_base)
    closest = joints_closest_to(arm, task.positions_in_base)
    misses = [
        np.linalg.norm(arm.forward(joints) - task.positions_in_base, axis=-1) for joints in (near, closest)
    ]
    other = misses[1] < misses[0] - (np.inf if task.solids else _MUCH_BETTER)
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
    targets, tolerances = task.positions_in_base, task.tolerances
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
    targets, arms = task.positions_in_base, [design.arm for design in designs]
    # What a correction leaves is corrected by the next one. Where the link cannot take what is best, or
    # something is in its way, a nearer aim.
    for share in (hand.share**corrections, hand.share, 1.0):
        _, move, there = best_aims(fit.arm, arms, joints, targets, weights, hand, share)[0]
        aim = fit.arm.moved(move)
        shape = link_at(task.robot, aim, arms[0].shape)
        if shape is not None and is_clear(task, replace(arms[0], shape=shape)):
            break
    else:
        move = min((towards(fit.arm, arm) for arm in arms), key=size)
        aim = fit.arm.moved(move)
        there, shape = joints_closest_to(aim, targets), None
    value, first = value_of_trying(fit, move, there, targets, task.tolerances, hand, corrections)
    return Correction(move[:3], move[3:], aim, shape, there, first, value)


def is_clear(task: Task, arm: Arm) -> bool:
    """Whether an arm can stand at the targets clear of obstacles, floor and itself.

    Args:
        task: The task.
        arm: The robot in a shape.
    """
    return not (task.solids or task.floor_in_base is not None) or verify(task, arm).possible


def link_at(robot: Robot, arm: StandingArm, current: LinkShape) -> LinkShape | None:
    """Return a shape of the link whose end is where an arm's end is, turned about both axes at will, or None.

    Args:
        robot: The hardware.
        arm: The arm; from its base the shape starts, along its axis 1.
        current: A shape nearby.
    """
    onto_z = onto_vertical(arm.direction)
    from_p2 = onto_z @ (arm.end - arm.point) - np.array([0.0, 0.0, robot.d12])
    return link_to_pose(robot.link, from_p2, onto_z @ arm.axis, current=current)
