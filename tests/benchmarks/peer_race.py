"""What all methods of `peers.py` share: the goal, the clock, and the judgement of what they found."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import compiled_miss
import numpy as np
from compiled_link import UNKNOWNS, constants
from compiled_residuals import jacobian, residuals

from synth.synthesis.check import verify
from synth.synthesis.shapes.shapes import Shapes, into_limits
from synth.task import PointTarget, Task

if TYPE_CHECKING:
    from synth.robot import Arm

REACHED = 1e-3  # worst miss of a planted task that counts as reached, m
EQUAL = 1.001  # RMS misses this close count as equal
TIMES = 5  # a multi-start that is not told the goal ends when it has found its least miss so often
CLOCKS = {"wall": time.perf_counter, "cpu": time.process_time}


@dataclass(frozen=True)
class Result:
    """What a method reached on a task.

    Attributes:
        rms, worst: Its misses, m, by the independent check; infinite where a limit is broken.
        seconds: Until the goal was reached, or until the method was stopped.
        reached: Whether the goal was reached.
    """

    rms: float
    worst: float
    seconds: float
    reached: bool

    @property
    def time(self) -> float:
        """Time until the goal was reached, s; infinite if it was not."""
        return self.seconds if self.reached else math.inf


NOTHING = Result(math.inf, math.inf, math.inf, reached=False)


@dataclass
class Race:
    """One method on one task, against the clock.

    Attributes:
        task: The task.
        goal: RMS miss to be equalled, m; None where the worst miss shall be at most REACHED.
        budget: Time after which the method is stopped, s.
        seed: Seed of the method.
        clock: Name of the clock.
        told: Whether the race ends as soon as the goal is reached. If not, the method must end it.
    """

    task: Task
    goal: float | None
    budget: float
    seed: int
    clock: str = "wall"
    told: bool = True
    best: Result = NOTHING
    best_cost: float = math.inf
    rng: np.random.Generator = field(init=False)

    def __post_init__(self) -> None:
        self.rng = np.random.default_rng(self.seed)
        self.targets = np.ascontiguousarray(self.task.positions_in_base)
        self.constants = constants(self.task)
        self.arguments = (self.constants, self.targets)
        self._least, self._times, self._finished = math.inf, 0, False
        self._began = CLOCKS[self.clock]()

    @property
    def seconds(self) -> float:
        return CLOCKS[self.clock]() - self._began

    @property
    def over(self) -> bool:
        """Whether the method may stop."""
        return (self.told and self.best.reached) or self._finished or self.seconds > self.budget

    def finish(self) -> None:
        """Say that the method has come to its own end; one that is told the goal starts again."""
        self._finished = not self.told

    def count_minimum(self, cost: float) -> None:
        """Take note of where a local search ended, m^2: a multi-start ends when its least comes again."""
        rms = math.sqrt(cost)
        if rms < self._least / EQUAL:
            self._least, self._times = rms, 0
        self._times += rms <= self._least * EQUAL
        if self._times == TIMES:
            self.finish()

    @property
    def enough(self) -> float:
        """The mean squared miss above which no shape reaches the goal, m^2."""
        return (self.goal * EQUAL if self.goal else REACHED) ** 2

    def is_enough(self, x: np.ndarray, cost: float) -> bool:
        """Whether a shape reaches the goal, by the compiled miss."""
        if not self.told or cost > self.enough:
            return False
        return self.goal is not None or compiled_miss.misses(x, *self.arguments).max() <= REACHED

    def offer(self, x: np.ndarray, cost: float) -> bool:
        """Take a shape if it is the best so far; return whether the method may stop."""
        if cost < self.best_cost:
            self.best_cost, self.best_x = cost, np.array(x)
            if self.is_enough(x, cost):
                self.offer_arm(self.arm(x))
        return self.over

    def arm(self, x: np.ndarray) -> Arm:
        return Shapes(self.task.robot, into_limits(self.task.robot, x[None])).arm(0, self.task.base)

    def offer_arm(self, arm: Arm, joints: np.ndarray | None = None) -> bool:
        """Let the independent check judge a shape; return whether the method may stop."""
        check = verify(self.task, arm, joints)
        if check.possible:
            self.offer_misses(check.misses)
        return self.over

    def offer_misses(self, misses: np.ndarray) -> bool:
        """Take misses, m, as they are; return whether the method may stop."""
        rms, worst = math.sqrt(np.mean(misses**2)), float(misses.max())
        self.count_minimum(rms**2)
        if (rms if self.goal else worst) < (self.best.rms if self.goal else self.best.worst):
            reached = rms <= self.goal * EQUAL if self.goal else worst <= REACHED
            self.best = Result(rms, worst, self.seconds, reached)
        return self.over

    def starts(self, size: int = 64) -> np.ndarray:
        """Return random shapes within the limits, shape (size, 9)."""
        return np.array(Shapes.sample(self.task.robot, size, self.rng).unknowns)

    def result(self) -> Result:
        """Return what was reached; a shape that did not reach the goal is judged now."""
        if self.told and self.best.reached:
            return self.best
        seconds = self.seconds
        if math.isfinite(self.best_cost):
            self.offer_arm(self.arm(self.best_x))
        return replace(self.best, seconds=seconds)


def warmed_up(task: Task) -> None:
    """Compile, or load, what is compiled, before any clock runs."""
    x = np.append(np.full(UNKNOWNS - 1, 0.1), 0.6)
    race = Race(replace(task, targets=(PointTarget("one", np.array([0.3, 0.2, 0.3])),)), None, 0.0, 0)
    for compiled in (
        compiled_miss.cost,
        residuals,
        jacobian,
        compiled_miss.misses,
    ):
        compiled(x, *race.arguments)
    compiled_miss.costs(x[:, None].copy(), *race.arguments)
