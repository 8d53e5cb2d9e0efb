"""What a program is built for: one of these describes all tasks that it can solve."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from synth.robot import Robot
    from synth.task import Objective, Task, Topology


@dataclass(frozen=True)
class Structure:
    """What tasks have in common that are solved by one program; all else it gets as parameters.

    Attributes:
        robot: The hardware.
        count: Number n of targets.
        has_floor: Whether there is a floor, at whatever height.
        has_approaches: Whether directions of arrival are asked for, at some target.
        topology: Kind of shape asked for.
        objective: Norm of the misses.
    """

    robot: Robot
    count: int
    has_floor: bool
    has_approaches: bool
    topology: Topology
    objective: Objective

    @classmethod
    def of(cls, task: Task) -> Structure:
        """Return the structure of a task."""
        return cls(
            task.robot,
            len(task.targets),
            task.floor_in_base is not None,
            task.approaches_in_base is not None,
            task.topology,
            task.objective,
        )
