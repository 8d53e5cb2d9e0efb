"""What is asked of the robot, as frozen values in metres and radians."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field
from enum import Enum
from functools import cached_property
from typing import TYPE_CHECKING, Any

from synth.arrays import FloatArray, frozen, frozen_value
from synth.checks import Checks, described, wrong_type
from synth.geometry import Box, Capsule, Sphere
from synth.names import given_twice
from synth.robot import BasePose, LinkShape, Robot
from synth.task.targets import PointTarget, TargetTable

if TYPE_CHECKING:
    from synth.geometry import Solid


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


@frozen_value
class Obstacle:
    """A solid that link, rigid link and end effector keep clear of.

    Attributes:
        name: How the result speaks of it.
        solid: Where it is, in the task frame, m.
    """

    name: str
    solid: Solid

    def __post_init__(self) -> None:
        checks = Checks(self)
        checks.name("name")
        checks.is_a("solid", (Sphere, Box, Capsule))
        checks.refuse()


@frozen_value
class Task:
    """A synthesis task: reach the targets with one shape of the link.

    Attributes:
        name: What the task is called.
        robot: The hardware.
        targets: What is to be reached.
        base: Where the robot stands.
        floor: Height in the base frame, m, that link, joint and end effector stay above; None
            where there is no floor.
        topology: Kind of shape asked for.
        objective: Norm of the misses that is made small.
        obstacles: What the robot keeps clear of at every target.
        current: The present shape of the link; among the shapes that reach every target that is then the
            best which changes it least.
    """

    name: str
    robot: Robot
    targets: Sequence[PointTarget]
    base: BasePose = field(default_factory=BasePose)
    floor: float | None = 0.0
    topology: Topology = Topology.ANY
    objective: Objective = Objective.LEAST_SQUARES
    obstacles: tuple[Obstacle, ...] = ()
    current: LinkShape | None = None

    def __post_init__(self) -> None:
        checks = Checks(self)
        checks.name("name")
        checks.is_a("robot", Robot)
        # In columns, so that a task like this one but for its floor costs no look at a million targets.
        if not isinstance(self.targets, TargetTable) and _are_all(
            checks, "targets", self.targets, PointTarget
        ):
            checks.put("targets", TargetTable.of(self.targets))
        if isinstance(self.targets, TargetTable):
            if not len(self.targets):
                checks.report("targets", "must hold one target at least, but is empty")
            table = self.targets
            _report_names_given_twice(checks, "targets", table.names, table.names_given_twice)
        checks.is_a("base", BasePose)
        if self.floor is not None:
            checks.number("floor")
        checks.word("topology", Topology)
        checks.word("objective", Objective)
        if _are_all(checks, "obstacles", self.obstacles, Obstacle):
            checks.put("obstacles", tuple(self.obstacles))
            names = [obstacle.name for obstacle in self.obstacles]
            _report_names_given_twice(checks, "obstacles", names, given_twice(names))
        if self.current is not None:
            checks.is_a("current", LinkShape)
        checks.refuse()

    @cached_property
    def table(self) -> TargetTable:
        """The targets in columns."""
        return TargetTable.of(self.targets)

    @cached_property
    def positions_in_base(self) -> FloatArray:
        """Positions of all targets in the base frame, shape (n, 3), m."""
        return frozen(self.base.to_base(self.table.positions))

    @property
    def tolerances(self) -> FloatArray:
        """Tolerances of all targets, shape (n,), m."""
        return self.table.tolerances

    @property
    def weights(self) -> FloatArray:
        """Weights of all targets, shape (n,)."""
        return self.table.weights

    @property
    def solids(self) -> tuple[Solid, ...]:
        """The obstacles in the base frame."""
        base = self.base
        return tuple(obstacle.solid.seen_from(base.position, base.yaw) for obstacle in self.obstacles)


def _report_names_given_twice(
    checks: Checks, key: str, names: Sequence[str], twice: Sequence[tuple[int, int]]
) -> None:
    """Report names that stand in a list twice, by the places that `given_twice` returned."""
    for index, first in twice:
        checks.report(f"{key}[{index}].name", f"{names[index]!r} is the name of {key}[{first}] already")


def _are_all(checks: Checks, key: str, given: Any, kind: type) -> bool:
    """Whether a field is a sequence of values of one kind."""
    if not isinstance(given, Sequence) or isinstance(given, str):
        checks.report(key, f"must be a list of {kind.__name__}, but is {described(given)}")
        return False
    wrong_ones = [(index, wrong) for index, one in enumerate(given) if (wrong := wrong_type(one, kind))]
    for index, wrong in wrong_ones[:10]:
        checks.report(f"{key}[{index}]", wrong)
    return not wrong_ones
