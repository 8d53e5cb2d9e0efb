"""What is asked of the robot, as frozen values in metres and radians."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import field, replace
from enum import Enum
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from synth.arrays import FloatArray, frozen, frozen_value
from synth.checks import Checks, described, wrong_type
from synth.geometry import Box, Capsule, Sphere
from synth.names import given_twice
from synth.robot import BaseChoices, BasePlaces, BasePose, BaseRange, LinkShape, Robot
from synth.surfaces import Surface
from synth.task.targets import PointTarget, TargetTable

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.geometry import Solid

_SLAB = 100.0  # m: the edge of the block that stands for a floor


class Topology(Enum):
    """The kinds of shape that a task may ask for (Clark and Rojas 2020, section II)."""

    ANY = "any"
    GENERAL = "general"
    PUMA = "puma"
    SCARA = "scara"
    SPHERICAL = "spherical"


class Floor(Enum):
    """A floor that is not told as a height."""

    AT_BASE = "at base"


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
        base: Where the robot stands; where the synthesis chooses it, the middle of the places or the first.
        floor: Height in the task frame, m, that link, joint and end effector stay above; None where there is
            none. By default that of P1 where the base is upright, and none where it leans.
        places: Where the robot may be made to stand; None where `base` says it.
        surfaces: What the targets that are samples of surfaces are samples of, see `sampled`.
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
    floor: float | Floor | None = Floor.AT_BASE
    topology: Topology = Topology.ANY
    objective: Objective = Objective.LEAST_SQUARES
    obstacles: tuple[Obstacle, ...] = ()
    current: LinkShape | None = None
    places: BasePlaces | None = None
    surfaces: tuple[Surface, ...] = ()

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
        if not isinstance(self.floor, Floor | None):
            checks.number("floor")
        checks.word("topology", Topology)
        checks.word("objective", Objective)
        for key, kind in (("obstacles", Obstacle), ("surfaces", Surface)):
            if _are_all(checks, key, given := getattr(self, key), kind):
                checks.put(key, tuple(given))
                names = [each.name for each in given]
                _report_names_given_twice(checks, key, names, given_twice(names))
        if self.current is not None:
            checks.is_a("current", LinkShape)
        if self.places is not None:
            checks.is_a("places", (BaseRange, BaseChoices))
        checks.refuse()
        if self.places is not None and not self.places.contains(self.base):
            checks.put("base", self.places.middle)

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

    @cached_property
    def approaches_in_base(self) -> FloatArray | None:
        """Directions of arrival in the base frame and their tolerances, shape (n, 4); see `TargetTable`."""
        rows = self.table.approaches
        return (
            None if rows is None else frozen(np.column_stack([rows[:, :3] @ self.base.rotation, rows[:, 3]]))
        )

    @property
    def weights(self) -> FloatArray:
        """Weights of all targets, shape (n,)."""
        return self.table.weights

    @cached_property
    def surface_of_targets(self) -> NDArray[np.intp]:
        """Of which surface each target is a sample, shape (n,); -1 for a target of its own."""
        ends = np.cumsum([0, *(len(surface.samples) for surface in self.surfaces)])
        return np.searchsorted(ends, self.table.cell, side="right") - 1

    @property
    def is_partial(self) -> bool:
        """Whether a part of a surface may be left uncovered."""
        return any(surface.coverage < 1.0 for surface in self.surfaces)

    def standing_at(self, base: BasePose) -> Task:
        """Return the same task with the base at one of its places, and no choice of it left."""
        return replace(self, base=base, places=None)

    def lowest_from(self, base: BasePose) -> float:
        """Return the height in the frame of an upright base that the arm stays above, m; -inf for none.

        Where the base leans the floor is a solid to keep clear of, see `solids_from`.
        """
        if self.floor is None or not base.is_upright:
            return -math.inf
        return 0.0 if isinstance(self.floor, Floor) else self.floor - float(base.position[2])

    def solids_from(self, base: BasePose) -> tuple[Solid, ...]:
        """Return what the arm keeps clear of in the frame of a base."""
        return tuple(
            obstacle.solid.seen_from(base.position, base.rotation) for obstacle in self.obstacles_from(base)
        )

    def obstacles_from(self, base: BasePose) -> tuple[Obstacle, ...]:
        """Return the obstacles, for a base that leans with a slab for the floor."""
        if base.is_upright or not isinstance(self.floor, float):
            return self.obstacles
        return (*self.obstacles, _slab(self.floor, base.position))

    @property
    def floor_height(self) -> float | None:
        """Height of the floor in the task frame, m; None where there is none."""
        if isinstance(self.floor, Floor):
            return float(self.base.position[2]) if self.base.is_upright else None
        return self.floor

    @cached_property
    def floor_in_base(self) -> float | None:
        """Height of the floor in the base frame, m; None where there is none or the base leans."""
        lowest = self.lowest_from(self.base)
        return None if lowest == -math.inf else lowest

    @property
    def solids_in_task(self) -> tuple[Solid, ...]:
        """What the arm keeps clear of in the task frame, a floor of a given height with it."""
        floor = [_slab(self.floor, self.base.position)] if isinstance(self.floor, float) else []
        return tuple(obstacle.solid for obstacle in (*self.obstacles, *floor))

    @cached_property
    def solids(self) -> tuple[Solid, ...]:
        """What the arm keeps clear of in the base frame."""
        return self.solids_from(self.base)


def _slab(height: float, position: FloatArray) -> Obstacle:
    """Return a block that stands for a floor about a position."""
    middle = np.array([position[0], position[1], height - 0.5 * _SLAB])
    return Obstacle("the floor", Box(middle, np.full(3, _SLAB)))


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
