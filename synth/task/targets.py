"""The targets of a task: points that the end effector must reach."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from synth.arrays import FloatArray, frozen_value
from synth.checks import LONGEST_NAME, SMALLEST, Checks, described, wrong_name
from synth.names import given_twice

if TYPE_CHECKING:
    from numpy.typing import NDArray


DEFAULT_TOLERANCE = 1e-3  # m: twice the error of the motion capture that measured the prototype


@frozen_value
class PointTarget:
    """A point that the end effector must reach: one kind of target.

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


@frozen_value
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
