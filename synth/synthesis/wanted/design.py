"""A shape of the robot with all that is known of it for a task."""

from __future__ import annotations

from typing import TYPE_CHECKING

from synth.arrays import frozen_value

if TYPE_CHECKING:
    from synth.robot import Arm
    from synth.synthesis.check import Verification
    from synth.synthesis.wanted.figures import Figures
    from synth.synthesis.wanted.motion import Motion


@frozen_value
class Design:
    """A shape of the robot and what the independent check says of it.

    Attributes:
        arm: The robot in the shape.
        verification: What it does for the task.
        ways: From each target to the next, once `judged` looked for them; empty for very many targets.
        figures: By which shapes that reach every target are compared, likewise.
    """

    arm: Arm
    verification: Verification
    ways: tuple[Motion, ...] = ()
    figures: Figures | None = None
