"""What is asked of the robot, as frozen values in metres and radians."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen
from synth.robot import BasePose

if TYPE_CHECKING:
    from synth.geometry import Solid
    from synth.robot import Robot

DEFAULT_TOLERANCE = 1e-3  # m: twice the error of the motion capture that measured the prototype


class Topology(Enum):
    """The kinds of shape that a task may ask for (Clark and Rojas 2020, section II)."""

    ANY = "any"
    GENERAL = "general"
    PUMA = "puma"
    SCARA = "scara"
    SPHERICAL = "spherical"


class Objective(Enum):
    """What is made small: a norm of (miss / tolerance) over the targets."""

    LEAST_SQUARES = "least_squares"
    MINIMAX = "minimax"


@dataclass(frozen=True, eq=False)
class PointTarget:
    """A point that the end effector shall reach: one kind of target.

    Attributes:
        name: How the result speaks of it.
        position: Where it is in the task frame, shape (3,), m.
        tolerance: Largest miss that counts as reached, m.
        weight: Factor of its (miss / tolerance)^2 in the objective.
    """

    name: str
    position: FloatArray
    tolerance: float = DEFAULT_TOLERANCE
    weight: float = 1.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "position", frozen(self.position))


@dataclass(frozen=True, eq=False)
class Obstacle:
    """A solid that link, rigid link and end effector keep clear of.

    Attributes:
        name: How the result speaks of it.
        solid: Where it is, in the task frame, m.
    """

    name: str
    solid: Solid


@dataclass(frozen=True, eq=False)
class Task:
    """A synthesis task: reach the targets with one shape of the link.

    Attributes:
        name: What the task is called.
        robot: The hardware.
        targets: What shall be reached.
        base: Where the robot stands.
        floor: Height in the base frame, m, that link, joint and end effector stay above; None
            where there is no floor.
        topology: Kind of shape asked for.
        objective: Norm of the misses that is made small.
        obstacles: What the robot keeps clear of at every target.
    """

    name: str
    robot: Robot
    targets: tuple[PointTarget, ...]
    base: BasePose = field(default_factory=BasePose)
    floor: float | None = 0.0
    topology: Topology = Topology.ANY
    objective: Objective = Objective.LEAST_SQUARES
    obstacles: tuple[Obstacle, ...] = ()

    @property
    def positions(self) -> FloatArray:
        """Positions of all targets in the base frame, shape (n, 3), m."""
        return self.base.to_base(np.array([target.position for target in self.targets]))

    @property
    def tolerances(self) -> FloatArray:
        """Tolerances of all targets, shape (n,), m."""
        return np.array([target.tolerance for target in self.targets])

    @property
    def weights(self) -> FloatArray:
        """Weights of all targets, shape (n,)."""
        return np.array([target.weight for target in self.targets])

    @property
    def solids(self) -> tuple[Solid, ...]:
        """The obstacles in the base frame."""
        base = self.base
        return tuple(obstacle.solid.seen_from(base.position, base.yaw) for obstacle in self.obstacles)
