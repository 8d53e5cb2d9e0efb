"""The solution: an outcome, and what a user does with it."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from importlib import import_module
from typing import TYPE_CHECKING

from synth.arrays import frozen_value
from synth.errors import SynthError
from synth.robot import keeps_clear
from synth.rounding import counted
from synth.synthesis.check import TargetResult, target_results
from synth.synthesis.solution.message import message
from synth.synthesis.solution.outcome import Outcome
from synth.synthesis.solution.summary import summary

if TYPE_CHECKING:
    import os
    from collections.abc import Mapping
    from pathlib import Path
    from types import ModuleType

    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from synth.robot import Arm
    from synth.synthesis.wanted import Design


def _package() -> ModuleType:
    """Return the package, whose public names a solution may use as a user does: files lie above it."""
    return import_module("synth")


class NotFoundError(SynthError):
    """Use of a shape that was not found.

    Attributes:
        solution: The whole result, with the reason.
    """

    def __init__(self, solution: Solution) -> None:
        super().__init__(solution.message)
        self.solution = solution


@frozen_value
class Solution(Outcome):
    """The result of a synthesis: always returned, whatever was found; see `Outcome` for what it holds."""

    @property
    def best(self) -> Design:
        """The best shape.

        Raises:
            NotFoundError: There is none.
        """
        if not self.designs:
            raise NotFoundError(self)
        return self.designs[0]

    @property
    def robot(self) -> Arm:
        """The robot in the best shape, with its forward and inverse kinematics.

        Raises:
            NotFoundError: There is none.
        """
        return self.best.arm

    @cached_property
    def targets(self) -> tuple[TargetResult, ...]:
        """What becomes of each target in the best shape.

        Raises:
            NotFoundError: There is none.
        """
        return target_results(self.task, self.best.arm, self.best.verification)

    @classmethod
    def from_json(cls, source: str | Mapping[str, object]) -> Solution:
        """Return a solution from a JSON text, or from the mapping that `solution_to_json` returned.

        It is verified again; `synth.load_solution` does the same with a file.

        Args:
            source: The text or the mapping.

        Raises:
            InputError: It is no solution, or what it says of a shape is not true; with every mistake.
        """
        read: Solution = _package().solution_from_json(source)
        return read

    def clear(self, joints: ArrayLike) -> NDArray[np.bool_]:
        """Return whether the best shape is within its joint limits, and clear of everything.

        Args:
            joints: Angles (theta1, theta2), shape (..., 2), rad.

        Returns:
            Whether obstacles, floor and the arm itself leave each posture free, shape (...): for the validity
            function of a sampling planner.

        Raises:
            NotFoundError: There is no shape.
        """
        task, arm = self.task, self.robot
        solids = [obstacle.solid for obstacle in task.obstacles_from(arm.base)]
        return keeps_clear(arm, joints, solids, floor=task.floor_in_base)

    def export(self, directory: str | os.PathLike[str], *kinds: str) -> list[Path]:
        """Write files of the best shape for planners and simulators, all of them or none.

        Args:
            directory: Where to; it is made if it is not there. Files of these names are replaced.
            kinds: Which: "urdf", "srdf", "mjcf", "xrdf", "mesh", "dh", "c", "trajectory". All of them if none
                is named; of a shape that lacks ways no trajectory then.

        Returns:
            The paths of the files.

        Raises:
            InputError: There is no such kind.
            NotFoundError: There is no shape.
            SynthError: A way is missing for a trajectory, or they cannot be written. Files of an earlier run
                are then as they were.
        """
        paths: list[Path] = _package().write_planner_files(self, directory, kinds)
        return paths

    def __str__(self) -> str:
        """Return a headline, what is known, and a few bullets: what the terminal shows of it."""
        return summary(self)

    def __repr__(self) -> str:
        shapes = counted(len(self.designs), "shape")
        return f"<{type(self).__name__} {self.task.name!r}: {self.status.value}, {shapes}>"

    def or_raise(self) -> Solution:
        """Return this solution if it was found.

        Raises:
            NotFoundError: It was not.
        """
        if not self.found:
            raise NotFoundError(self)
        return self


def showing(solution: Solution, number: int) -> Solution:
    """Return a solution that begins with another of its shapes: all that is told is then of that one.

    Args:
        solution: What a synthesis found, its best shape first.
        number: Which shape, counted from 1, the best.

    Raises:
        SynthError: There are not so many.
    """
    designs, count = solution.designs, len(solution.designs)
    if not 1 <= number <= count:
        are = (
            "is no shape"
            if not count
            else f"{'is 1 shape' if count == 1 else f'are {count} distinct shapes'}"
        )
        raise SynthError(f"there is no shape {number} to show: there {are} of this task")
    ordered = (designs[number - 1], *designs[: number - 1], *designs[number:])
    told = message(solution.task, solution.status, ordered, solution.reasons)
    return replace(solution, designs=ordered, shape=number, message=told)
