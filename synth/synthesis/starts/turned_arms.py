"""Arms for all of many targets: after steps that see every target, and turned about axis 1.

A part of many targets says nearly all of where to look, but nothing of where the dead zone of joint 1 should
be; and each step is a system of nine or eleven equations however many targets there are.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from synth.robot import Interval, link_to_pose
from synth.synthesis.shapes import Postures, Shapes, TargetsSeen, in_equal_arcs
from synth.synthesis.starts.refinement import refine
from synth.task import Objective

if TYPE_CHECKING:
    from collections.abc import Iterator

    from synth.arrays import FloatArray
    from synth.robot import Arm
    from synth.task import Task
    from synth.watch import Watch


SAMPLE = 2000  # targets that are a part of many
_STEPS = 8  # with a part
_STEPS_WITH_ALL = 2  # and then with all


def refined_for_all(task: Task, arm: Arm, watch: Watch) -> Arm:
    """Return an arm after Gauss-Newton steps on all targets, for the sum of their squared misses.

    The steps know the limits of the link and of the joints, but neither floor nor obstacles.

    Args:
        task: The task with all its targets.
        arm: The robot in a shape of equal arcs, near the best for a part of the targets.
        watch: When it is up, no more steps are taken.
    """
    squares = replace(task, objective=Objective.LEAST_SQUARES)
    step = 0.0  # s, for each target
    for count, steps in ((SAMPLE, _STEPS), (len(task.targets), _STEPS_WITH_ALL)):
        # Looking at all targets afterwards takes about as long as a step.
        if watch.is_up() or watch.remaining < (steps + 2) * step * count:
            break
        watch.tell(phase="improving for all targets")
        some, began = random_part(squares, count, 0), watch.elapsed
        refined = refine(some, Shapes.of(arm), iterations=steps, is_up=watch.is_up)
        arm = refined.shapes.arm(0, task.base)
        step = (watch.elapsed - began) / (steps * count)
    return arm


def as_it_is_and_turned(task: Task, arm: Arm, watch: Watch) -> Iterator[Arm]:
    """Yield an arm and, if it misses a target, another that is turned about axis 1.

    Args:
        task: The task.
        arm: An arm that was found for a part of its targets.
        watch: Ends it before the other one.
    """
    yield arm
    if watch.is_up() or np.all(relative_misses(task, arm) <= np.sqrt(task.weights)):
        return
    turned = _with_joint_1_clear(task, arm, watch)
    if turned is not None:
        yield turned


def _with_joint_1_clear(task: Task, arm: Arm, watch: Watch) -> Arm | None:
    """Return an arm of about the same workspace that has the dead zone of joint 1 where no target is.

    Returns:
        The arm; None if the targets leave no gap, or no link was found.
    """
    limits = task.robot.joint_limits
    around = replace(limits, base=Interval(-math.pi, math.pi))
    free = refined_for_all(replace(task, robot=replace(task.robot, joint_limits=around)), arm, watch)
    nearest = Postures.nearest(TargetsSeen(task.positions_in_base, around), Shapes.of(free).kinematics)
    angles = np.sort(nearest.theta1[0])
    gaps = np.diff(angles, append=angles[0] + 2.0 * math.pi)
    widest = int(np.argmax(gaps))
    # Joint 1 is to stand at theta1 + turn: the gap then spans from its upper limit to the lower one.
    least = limits.base.lower + 2.0 * math.pi - angles[widest] - gaps[widest]
    most = limits.base.upper - angles[widest]
    if least > most:
        return None
    turn = Interval(float(least), float(most))
    rotation, end = free.shape.end_frame()
    shape = link_to_pose(task.robot.link, end, rotation[:, 0], theta1=turn)
    if shape is None:
        return None
    # The link's end has the same axis 2; what joint 2 needs, too, the steps see to.
    return refined_for_all(task, in_equal_arcs(replace(free, robot=task.robot, shape=shape)), watch)


def random_part(task: Task, count: int, seed: int) -> Task:
    """Return a task with so many of its targets, or the task itself if it has no more.

    Args:
        task: The task.
        count: How many targets to keep.
        seed: The same part for the same seed.
    """
    if count >= len(task.targets):
        return task
    chosen = np.random.default_rng([seed, count]).choice(len(task.targets), count, replace=False)
    return replace(task, targets=task.table.take(np.sort(chosen)))


def relative_misses(task: Task, arm: Arm) -> FloatArray:
    """Return what an arm misses targets by, in units of their tolerances, weighted, shape (n,)."""
    return np.asarray(np.sqrt(task.weights) * arm.closest_joints(task.table.positions)[1] / task.tolerances)
