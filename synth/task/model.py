"""What is asked of the robot, as frozen values in metres and radians."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import Enum
from functools import cached_property
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from synth.arrays import FloatArray, compared_by_value, frozen
from synth.checks import LONGEST_NAME, SMALLEST, Checks, described, given_twice, wrong_name, wrong_type
from synth.geometry import Box, Capsule, Sphere
from synth.robot import BasePose, LinkShape, Robot

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.geometry import Solid

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


@compared_by_value
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
        checks = Checks(self)
        checks.name("name")
        checks.array("position", (3,))
        checks.number("tolerance", least=SMALLEST)
        checks.number("weight", least=SMALLEST)
        checks.refuse()


class _CheckedNames(tuple[str, ...]):
    """Names that were found right: those of a million points are looked at once, not with each new table."""

    __slots__ = ()


@compared_by_value
@dataclass(frozen=True, eq=False)
class TargetTable(Sequence[PointTarget]):
    """Targets in columns: as a sequence it is one of `PointTarget`, made when asked for.

    A hundred thousand points of a scanned surface are four arrays here, not as many objects.

    Attributes:
        names: How the result speaks of each.
        positions: Where they are in the task frame, shape (n, 3), m.
        tolerances: Largest misses that count as reached, shape (n,), m.
        weights: Factors of their (miss / tolerance)^2, shape (n,).
    """

    names: Sequence[str]
    positions: FloatArray
    tolerances: FloatArray
    weights: FloatArray

    def __post_init__(self) -> None:
        checks = Checks(self)
        if not isinstance(self.names, _CheckedNames):
            _check_names(checks, self.names)
        count = len(self.names)
        checks.array("positions", (count, 3), rows="targets[{}].position")
        checks.array("tolerances", (count,), least=SMALLEST, rows="targets[{}].tolerance")
        checks.array("weights", (count,), least=SMALLEST, rows="targets[{}].weight")
        checks.refuse()

    @cached_property
    def names_given_twice(self) -> list[tuple[int, int]]:
        """Where names stand that stood before, and where they stood first: looked for once in a table."""
        return given_twice(self.names)

    @classmethod
    def of(cls, targets: Sequence[PointTarget]) -> TargetTable:
        """Return targets in columns."""
        if isinstance(targets, TargetTable):
            return targets
        return cls(
            tuple(target.name for target in targets),
            np.array([target.position for target in targets]).reshape(-1, 3),
            np.array([target.tolerance for target in targets]),
            np.array([target.weight for target in targets]),
        )

    def __len__(self) -> int:
        return len(self.tolerances)

    @overload
    def __getitem__(self, index: int) -> PointTarget: ...
    @overload
    def __getitem__(self, index: slice) -> TargetTable: ...
    def __getitem__(self, index: int | slice) -> PointTarget | TargetTable:
        if isinstance(index, slice):
            return self.take(np.arange(len(self))[index])
        tolerance, weight = float(self.tolerances[index]), float(self.weights[index])
        return PointTarget(self.names[index], self.positions[index], tolerance, weight)

    def take(self, chosen: NDArray[np.intp]) -> TargetTable:
        """Return some of the targets."""
        return TargetTable(
            tuple(self.names[index] for index in chosen),
            self.positions[chosen],
            self.tolerances[chosen],
            self.weights[chosen],
        )

    def followed_by(self, other: TargetTable) -> TargetTable:
        """Return these targets and then others."""
        return TargetTable(
            (*self.names, *other.names),
            np.concatenate([self.positions, other.positions]),
            np.concatenate([self.tolerances, other.tolerances]),
            np.concatenate([self.weights, other.weights]),
        )


@compared_by_value
@dataclass(frozen=True, eq=False)
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


@compared_by_value
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
    def positions(self) -> FloatArray:
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


def _check_names(checks: Checks, given: Any) -> None:
    """Check the names of a table of targets."""
    if not isinstance(given, Sequence) or isinstance(given, str):
        checks.report("names", f"must be a list of texts, but is {described(given)}")
        checks.refuse()
    if _wrong_names(given):
        for index, name in enumerate(given):
            if wrong := wrong_name(name):
                checks.report(f"targets[{index}].name", wrong)
    checks.put("names", _CheckedNames(given))


def _wrong_names(names: Sequence[str]) -> bool:
    """Whether one of many names is wrong; those of a million points are looked at together."""
    try:
        together = "".join(names)
    except TypeError:  # one is no text
        return True
    longest = max(map(len, names), default=0)
    is_one_line = together.isprintable() and longest <= LONGEST_NAME
    return not (is_one_line and all(names) and not any(map(str.isspace, names)))


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
