"""What a synthesis found: always returned, whatever it found."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, compared_by_value, frozen
from synth.errors import SynthError
from synth.sentences import SentenceEnum
from synth.synthesis.room import clear_of_everything

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.robot import Arm
    from synth.synthesis.bound import Bound
    from synth.synthesis.figures import Figures
    from synth.synthesis.motion import Motion
    from synth.synthesis.verification import Verification
    from synth.synthesis.watch import Timing
    from synth.task import Task


class Status(SentenceEnum):
    """How a synthesis ended."""

    FOUND = "found", "every target is within its tolerance"
    BEST_EFFORT = "best_effort", "no shape was found that reaches every target"
    PROVEN_IMPOSSIBLE = "proven_impossible", "no shape of this robot can do the task"
    LIMIT = "limit", "stopped before the search was complete"
    FAILED = "failed", "the solver broke down"

    def told(self, *, with_shape: bool) -> str:
        """Return the sentence, with what the shape shown is, if there is one."""
        if with_shape and self in (Status.BEST_EFFORT, Status.LIMIT, Status.PROVEN_IMPOSSIBLE):
            return f"{self.sentence}; what follows is of the nearest shape found"
        return self.sentence


class NotFoundError(SynthError):
    """Use of a shape that was not found.

    Attributes:
        solution: The whole result, with the reason.
    """

    def __init__(self, solution: Solution) -> None:
        super().__init__(solution.message)
        self.solution = solution


@compared_by_value
@dataclass(frozen=True, eq=False)
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


@compared_by_value
@dataclass(frozen=True, eq=False)
class TargetResult:
    """What becomes of one target. Positions in the task frame, m.

    Attributes:
        name: The target's name.
        position: Where it is, shape (3,).
        tolerance: Largest miss that counts as reached, m.
        reached: Where the end effector gets to, shape (3,).
        miss: Distance between the two, m; infinite where there is no shape.
        within_tolerance: Whether the target is reached.
        clearance: How far the arm at least keeps from the obstacles there, m; told up to 0.1 m, and
            infinite without obstacles.
        joints: Joint angles (theta1, theta2), rad.
        alternatives: Other joint angles that reach it within its tolerance, shape (k, 2), rad, as clear of
            everything.
    """

    name: str
    position: FloatArray
    tolerance: float
    reached: FloatArray
    miss: float
    within_tolerance: bool
    clearance: float
    joints: FloatArray
    alternatives: FloatArray


@dataclass(frozen=True)
class Release:
    """One limit that blocks a task, and how much less of it would do.

    Attributes:
        limit: Name of the limit.
        amount: By how much it has to give way, m or rad.
        share: The same as a share of what the limit is, by which limits are compared.
        sentence: What would do, for the user.
        design: A shape that meets the task released so far, with its verification.
        task: The task released so far.
    """

    limit: str
    amount: float
    share: float
    sentence: str
    design: Design
    task: Task


@compared_by_value
@dataclass(frozen=True, eq=False)
class Solution:
    """The result of a synthesis.

    Attributes:
        task: What was asked.
        status: How it ended.
        message: The same as a sentence, with the misses and the reasons.
        reasons: Why no more was found, as far as that is known: proofs, algebra, limits that block.
        seed: Seed of the search: the same task, seed and version give the same answer.
        designs: Distinct shapes, the best first; only shapes that the hardware can take.
        starts: How many start points were polished.
        time: Where the time went.
        bound: How much better than the best shape found any shape may be; None if that was not asked, or
            there is no proof for such a task.
        releases: What would release a task that was not met; empty before `explain` has looked.
        notes: What else is to be said: what was left undone for lack of time, what `explain` found.
        explained: Whether `explain` has looked for releases, be it in vain.
        breakdown: The traceback of what broke off the search and nobody foresaw; empty mostly.
        shape: Which of the shapes, counted from the best, `designs` begins with; see `showing`.
    """

    task: Task
    status: Status
    message: str
    reasons: tuple[str, ...]
    seed: int
    designs: tuple[Design, ...]
    starts: int
    time: Timing
    bound: Bound | None = None
    releases: tuple[Release, ...] = ()
    notes: tuple[str, ...] = ()
    breakdown: str = ""
    shape: int = 1
    explained: bool = False

    @property
    def shape_numbers(self) -> tuple[int, ...]:
        """The number of each of `designs`, counted from the best."""
        others = (number for number in range(1, len(self.designs) + 1) if number != self.shape)
        return (self.shape, *others)

    @property
    def found(self) -> bool:
        """Whether every target is within its tolerance, by the independent check."""
        return self.status is Status.FOUND

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
        return target_results(self.task, self.best)

    def or_raise(self) -> Solution:
        """Return this solution if it was found.

        Raises:
            NotFoundError: It was not.
        """
        if not self.found:
            raise NotFoundError(self)
        return self


def joints_reaching(task: Task, design: Design, chosen: NDArray[np.intp] | None = None) -> list[FloatArray]:
    """Return for each target all joint angles at which it is reached, clear of everything, the best first.

    Args:
        task: The task.
        design: The shape.
        chosen: Indices of the targets that are asked for; by default all of them.

    Returns:
        Pairs (theta1, theta2), shape (k, 2), rad; the closest alone where the target is missed.
    """
    check = design.verification
    chosen = np.arange(len(task.targets)) if chosen is None else chosen
    best = check.joints[chosen]
    branches = design.arm.inverse_kinematics(task.table.positions[chosen])
    other = np.abs(branches.joints - best[:, None]).max(axis=-1) > 1e-3
    other &= branches.miss <= task.tolerances[chosen, None]
    other &= np.array(check.within_tolerance)[chosen, None]
    other[other] = clear_of_everything(task, design.arm, branches.joints[other])
    return [np.vstack([joints, branches.joints[index][other[index]]]) for index, joints in enumerate(best)]


def target_results(
    task: Task, design: Design, chosen: NDArray[np.intp] | None = None
) -> tuple[TargetResult, ...]:
    """Return what becomes of each target of a task in one shape, or of those chosen by their indices."""
    check = design.verification
    chosen = np.arange(len(task.targets)) if chosen is None else chosen
    joints = joints_reaching(task, design, chosen)
    return tuple(
        TargetResult(
            name=task.table.names[index],
            position=task.table.positions[index],
            tolerance=float(task.tolerances[index]),
            reached=frozen(check.reached[index]),
            miss=float(check.misses[index]),
            within_tolerance=check.within_tolerance[index],
            clearance=float(check.clearances[index]),
            joints=frozen(joints[row][0]),
            alternatives=frozen(joints[row][1:]),
        )
        for row, index in enumerate(chosen.tolist())
    )


def worst_targets(task: Task, design: Design, most: int) -> NDArray[np.intp]:
    """Return the indices of the targets that are missed most in a shape, by their tolerances, worst first.

    Args:
        task: The task.
        design: The shape.
        most: How many at most.
    """
    return np.argsort(-design.verification.misses / task.tolerances, kind="stable")[:most]
