"""The independent check: plain numpy and forward kinematics, through no expression of the solver.

Only this module may say that a target is reached or that a shape respects the limits.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from synth.arrays import FloatArray, frozen, frozen_value
from synth.checks import refuse_unless
from synth.robot import Arm
from synth.synthesis.check.approaches import pointing_astray, points_elsewhere
from synth.synthesis.check.clearances import Clearances, chosen_joints
from synth.synthesis.check.covering import Between, Covering, counted, coverings
from synth.synthesis.check.followed import Followed  # noqa: TC001 - a field
from synth.synthesis.check.violations import Violation, violations
from synth.task import Task

_ALIKE = 0.1  # of the tolerance: misses that differ by less are alike


@frozen_value
class Verification:
    """What a shape really does for a task.

    Attributes:
        joints: Best joint angles (theta1, theta2) for each target, shape (n, 2), rad.
        reached: P5 at these angles in the task frame, shape (n, 3), m.
        misses: Distance of P5 from each target, shape (n,), m.
        within_tolerance: Whether each target is reached, shape (n,).
        gamma_residuals: |Gamma(P5)| over the sum of its terms' magnitudes, shape (n,): that P5 lies
            on the published surface, too; about 1e-12.
        astray: By how much the rigid link points elsewhere than asked at each target, shape (n,), rad; NaN
            where no direction is asked for.
        clearances: How far the arm at least keeps from the obstacles at each target, shape (n,), m;
            no more than 0.1 m is looked for, and without obstacles it is infinite.
        violations: Limits that the shape breaks; empty for a shape that the hardware can take.
        unseen: How many more targets are asked for that were not looked at, for lack of time: with any, no
            shape counts as found.
        coverings: What is covered of each surface.
        reaches_all: Whether every target is reached, samples of paths with them, and as much of each surface
            as was asked for.
        between: What is proven of the surfaces that are known between their samples, see `between_samples`;
            empty before that was looked at.
        followed: How each path is followed, see `followed`; empty before that was looked at.
    """

    joints: FloatArray
    reached: FloatArray
    misses: FloatArray
    within_tolerance: tuple[bool, ...]
    gamma_residuals: FloatArray
    astray: FloatArray
    clearances: FloatArray
    violations: tuple[Violation, ...]
    unseen: int = 0
    coverings: tuple[Covering, ...] = ()
    reaches_all: bool = False
    between: tuple[Between, ...] = ()
    followed: tuple[Followed, ...] = ()

    @property
    def possible(self) -> bool:
        """Whether the hardware can take the shape."""
        return not self.violations

    @property
    def found(self) -> bool:
        """Whether the shape is possible and reaches every target within its tolerance, of surfaces enough."""
        return self.possible and self.reaches_all and not self.unseen


def verify_targets(
    task: Task, arm: Arm, joints: FloatArray | None = None, *, keep: bool = False
) -> Verification:
    """Check a shape at the targets of a task, samples of surfaces and of paths with them.

    What is between samples is not looked at: that `verify` does, which takes the same arguments.
    """
    refuse_unless("task", task, Task)
    refuse_unless("arm", arm, Arm)
    chosen, sunk, room = chosen_joints(task, arm, joints, keep=keep)
    reached = arm.forward_kinematics(chosen[:, 0], chosen[:, 1])
    blocked = sunk | ~room.clear
    misses = np.linalg.norm(reached - task.table.positions, axis=-1)
    within = (misses <= task.tolerances) & ~blocked & ~points_elsewhere(task, arm, chosen)
    if task.is_partial:  # what stands at targets that may be left breaks no limit
        counts = counted(task, np.where(within, misses, misses + task.tolerances))
        broken = violations(
            task, arm, chosen[counts], reached[counts], Clearances.of(task, arm, chosen[counts])
        )
    else:
        broken = violations(task, arm, chosen, reached, room)
    covered = coverings(task, misses, within)
    of_no_surface = task.surface_of_targets < 0
    return Verification(
        joints=frozen(chosen),
        reached=frozen(reached),
        misses=frozen(misses),
        within_tolerance=tuple(bool(value) for value in within),
        gamma_residuals=frozen(arm.surface.residual(arm.base.to_base(reached))),
        astray=frozen(pointing_astray(task, arm, chosen)),
        clearances=frozen(room.from_obstacles.min(axis=(-2, -1), initial=math.inf)),
        violations=broken,
        coverings=covered,
        reaches_all=bool(within[of_no_surface].all()) and all(each.met for each in covered),
    )


def what_counts(task: Task, arm: Arm, check: Verification) -> tuple[Task, Verification]:
    """Return a task of what counts where a part of a surface may be left, and what a shape does there.

    Of samples that are missed alike those count whose joint angles are farthest from their limits.

    Args:
        task: The task.
        arm: The robot in the shape.
        check: What it does for the task.
    """
    if not task.is_partial:
        return task, check
    limits = arm.robot.joint_limits
    spare = [
        np.minimum(angle - limit.lower, limit.upper - angle)
        for angle, limit in zip(check.joints.T, (limits.base, limits.second), strict=True)
    ]
    missed = np.where(check.within_tolerance, check.misses, check.misses + task.tolerances)
    steps = np.floor(missed / (_ALIKE * task.tolerances))
    chosen = np.flatnonzero(counted(task, steps + 1.0 / (1.0 + np.maximum(np.min(spare, axis=0), 0.0))))
    part = replace(
        check,
        joints=frozen(check.joints[chosen]),
        reached=frozen(check.reached[chosen]),
        misses=frozen(check.misses[chosen]),
        within_tolerance=tuple(check.within_tolerance[index] for index in chosen.tolist()),
        gamma_residuals=frozen(check.gamma_residuals[chosen]),
        astray=frozen(check.astray[chosen]),
        clearances=frozen(check.clearances[chosen]),
    )
    return task.asking_for(task.table.take(chosen)), part
