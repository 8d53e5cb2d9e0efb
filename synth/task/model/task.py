"""What is asked of the robot, as frozen values in metres and radians."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field, replace
from enum import Enum
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from synth.arrays import FloatArray, Given, frozen, frozen_value, given
from synth.checks import Checks, described, wrong_type
from synth.names import given_twice
from synth.paths import Path
from synth.robot import BaseChoices, BasePlaces, BasePose, BaseRange, LinkShape, Robot
from synth.surfaces import Surface
from synth.task.model.standing import Floor, Obstacle, Standing
from synth.task.model.targets import PointTarget, TargetTable

if TYPE_CHECKING:
    from numpy.typing import NDArray


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
class Task(Standing):
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
        paths: Likewise the paths, each to be followed in one go.
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
    topology: Given[Topology | str, Topology] = given(default=Topology.ANY)
    objective: Given[Objective | str, Objective] = given(default=Objective.LEAST_SQUARES)
    obstacles: Given[Sequence[Obstacle], tuple[Obstacle, ...]] = given(default=())
    current: LinkShape | None = None
    places: BasePlaces | None = None
    surfaces: Given[Sequence[Surface], tuple[Surface, ...]] = given(default=())
    paths: Given[Sequence[Path], tuple[Path, ...]] = given(default=())

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
        for key, kind in (("obstacles", Obstacle), ("surfaces", Surface), ("paths", Path)):
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
        """Of which surface each target is a sample, shape (n,); -1 for one of its own or of a path."""
        return np.where(self._sampled < len(self.surfaces), self._sampled, -1)

    @cached_property
    def path_of_targets(self) -> NDArray[np.intp]:
        """Of which path each target is a sample, shape (n,); -1 for any other."""
        return np.maximum(self._sampled - len(self.surfaces), -1)

    @cached_property
    def is_of_its_own(self) -> NDArray[np.bool_]:
        """Whether each target is no sample of a surface or of a path, shape (n,)."""
        return self._sampled < 0

    @cached_property
    def _sampled(self) -> NDArray[np.intp]:
        """Of which surface each target is a sample, then of which path, shape (n,); -1 for one of its own."""
        counts = [*(len(each.samples) for each in self.surfaces), *(len(each.samples) for each in self.paths)]
        return np.searchsorted(np.cumsum([0, *counts]), self.table.cell, side="right") - 1

    @property
    def is_partial(self) -> bool:
        """Whether a part of a surface may be left uncovered."""
        return any(surface.coverage < 1.0 for surface in self.surfaces)

    @property
    def by_worst_miss(self) -> Task:
        """The same task, judged by the worst miss over its tolerance whatever the weights: are all met?"""
        equal = replace(self.table, weights=np.ones(len(self.table)))
        return replace(self, objective=Objective.MINIMAX, targets=equal)

    def asking_for(self, targets: Sequence[PointTarget]) -> Task:
        """Return the same task with other targets, none of which is a sample of anything."""
        table = replace(TargetTable.of(targets), samples=None)
        return replace(self, targets=table, surfaces=(), paths=())


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
