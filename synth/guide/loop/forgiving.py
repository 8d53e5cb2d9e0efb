"""The shape to begin with: of those that meet a task, the one that forgives the hand most."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from synth.guide.loop.aim import aimed
from synth.guide.loop.hand import Hand, errors
from synth.measurement import StandingArm, joints_following
from synth.robot import Interval, link_to_pose
from synth.synthesis import Design, verify

if TYPE_CHECKING:
    from collections.abc import Sequence

    from synth.arrays import FloatArray
    from synth.task import Task

_SAMPLES = 400


def loss_at_floor(task: Task, arm: StandingArm, joints: FloatArray, hand: Hand) -> float:
    """Return the expected largest miss, over tolerance times the least one, m, after a hand's best try.

    Args:
        task: The task.
        arm: The arm in the base frame.
        joints: Joint angles at the targets to begin with, shape (n, 2), rad.
        hand: The hand: at its floor, joints at their best afterwards.
    """
    arms = arm.moved(errors(hand.floor, _SAMPLES, np.random.default_rng(0)))
    reached = arms.forward(joints_following(arms, joints, task.positions_in_base))
    misses = np.linalg.norm(reached - task.positions_in_base, axis=-1)
    return float((misses / task.tolerances).max(axis=1).mean() * task.tolerances.min())


@dataclass(frozen=True)
class Forgiving:
    """A shape, and the expected largest miss if a hand comes to it at its best, m."""

    design: Design
    loss: float


def most_forgiving(task: Task, designs: Sequence[Design], hand: Hand | None = None) -> Forgiving:
    """Return the shape that a hand should begin with.

    Each design is moved along the directions in which the task leaves it free to where an error of the hand
    does least. Designs and what came of them are compared by what a hand makes of them; a shape moved counts
    only if the link can take it and the independent check finds the task met by it.

    Args:
        task: The task.
        designs: Shapes that meet it, at least one.
        hand: The hand; the published one unless told.
    """
    hand = hand or Hand()
    weights = task.tolerances.min() / task.tolerances
    joint1 = task.robot.joint_limits.base.middle
    candidates: list[tuple[float, Design | None, StandingArm, Design]] = []
    for design in designs:
        arm = StandingArm.of(design.arm, joint1)
        joints = design.verification.joints
        candidates.append((loss_at_floor(task, arm, joints, hand), design, arm, design))
        move, there, _ = aimed(arm, np.zeros(6), joints, task.positions_in_base, weights, hand, 0.0)
        moved = arm.moved(move)
        candidates.append((loss_at_floor(task, moved, there, hand), None, moved, design))
    for loss, planned, arm, origin in sorted(candidates, key=lambda each: each[0]):
        checked = planned or design_at(task, arm, origin)
        if checked is not None and checked.verification.found:
            return Forgiving(checked, loss)
    best = min((each for each in candidates if each[1] is not None), key=lambda each: each[0])
    return Forgiving(best[3], best[0])


def design_at(task: Task, arm: StandingArm, origin: Design) -> Design | None:
    """Return a shape of the link with its end where an arm's end is, turned about both axes at will, or None.

    Args:
        task: The task.
        arm: The arm; its axis 1 is taken as the z axis of the base.
        origin: The design whose rigid link it has.
    """
    robot = task.robot
    from_p2 = arm.end - arm.point - robot.d12 * arm.direction
    shape = link_to_pose(robot.link, from_p2, arm.axis, theta1=Interval.fixed(arm.joint1))
    if shape is None:
        return None
    made = replace(origin.arm, shape=shape)
    return Design(made, verify(task, made))
