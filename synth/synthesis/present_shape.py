"""Shapes that change the present one little."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from synth.robot import ANYWHERE, Interval, links_to_poses
from synth.synthesis.check import verify_targets
from synth.synthesis.wanted import Design, best_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from synth.task import Task
    from synth.watch import Watch


def changing_little(task: Task, designs: Sequence[Design], seed: int, watch: Watch) -> list[Design]:
    """Return the shapes found, bent again: to the same workspace, as near to the present one as possible.

    Joint 1 takes up the angle by which the link is turned about axis 1, if its limits allow.

    Args:
        task: The task; there are none if it names no present shape.
        designs: The shapes, those among them that reach every target.
        seed: Seed of the links looked for.
        watch: Counts the time.
    """
    current = task.current
    found = [design for design in designs if design.verification.found]
    if current is None or not found:
        return []
    best = [design.arm for design in best_of(task, found)]
    ends = [arm.shape.end_frame() for arm in best]
    positions, axes = np.array([end for _, end in ends]), np.array([frame[:, 0] for frame, _ in ends])
    bent_again = []
    for where in (ANYWHERE, Interval.fixed(0.0)):
        with watch.on("solving"):
            shapes = links_to_poses(
                task.robot.link, positions, axes, current=current, theta1=where, seed=seed
            )
        with watch.on("verifying"):
            for arm, shape in zip(best, shapes, strict=True):
                if shape is not None:
                    nearer = replace(arm, shape=shape)
                    bent_again.append(Design(nearer, verify_targets(task, nearer)))
    return [design for design in bent_again if design.verification.found]
