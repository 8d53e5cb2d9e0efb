"""The targets of a task: points that the end effector must reach."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from synth.arrays import FloatArray, GivenArray, GivenArrayOrNone, frozen, frozen_value, given
from synth.checks import LONGEST_NAME, SMALLEST, Checks, described, numbers_in, wrong_name
from synth.names import given_twice

if TYPE_CHECKING:
    from numpy.typing import NDArray


DEFAULT_APPROACH_TOLERANCE = math.radians(5.0)
DEFAULT_TOLERANCE = 1e-3  # m: twice the error of the motion capture that measured the prototype


@frozen_value
class Approach:
    """The direction in which the rigid link points as it arrives at a target, from axis 2 to P5.

    Attributes:
        direction: In the task frame, shape (3,), without unit; its length does not count.
        tolerance: Largest angle between the two that counts as arrived, rad.
    """

    direction: GivenArray
    tolerance: float = DEFAULT_APPROACH_TOLERANCE

    def __post_init__(self) -> None:
        checks = Checks(self)
        if checks.array("direction", (3,)):
            length = float(np.linalg.norm(self.direction))
            if length > 0.0:
                checks.put("direction", frozen(self.direction / length))
            else:
                checks.report("direction", "must point somewhere, but is zero")
        checks.number("tolerance", least=SMALLEST, most=math.pi)
        checks.refuse()


@frozen_value
class PointTarget:
    """A point that the end effector must reach: one kind of target.

    Attributes:
        name: How the result speaks of it.
        position: Where it is in the task frame, shape (3,), m.
        tolerance: Largest miss that counts as reached, m.
        weight: Factor of its (miss / tolerance)^2 in the objective.
        approach: In which direction the rigid link points there; None if that is all one.
    """

    name: str
    position: GivenArray
    tolerance: float = DEFAULT_TOLERANCE
    weight: float = 1.0
    approach: Approach | None = None

    def __post_init__(self) -> None:
        checks = Checks(self)
        checks.name("name")
        checks.array("position", (3,))
        checks.number("tolerance", least=SMALLEST)
        checks.number("weight", least=SMALLEST)
        checks.is_a("approach", (Approach, type(None)))
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
        approaches: Directions of arrival in the task frame and their tolerances, rad, shape (n, 4), rows of
            NaN for targets without one; None if all are.
        samples: Which sample of the task's surfaces and paths each is, counted over all of them, shape (n,);
            -1 for a target of its own. By default all are of their own.
    """

    names: Sequence[str]
    positions: GivenArray
    tolerances: GivenArray
    weights: GivenArray
    approaches: GivenArrayOrNone = given(default=None)
    samples: NDArray[np.intp] | None = None

    def __post_init__(self) -> None:
        checks = Checks(self)
        if not isinstance(self.names, _CheckedNames):
            _check_names(checks, self.names)
        count = len(self.names)
        checks.array("positions", (count, 3), rows="targets[{}].position")
        checks.array("tolerances", (count,), least=SMALLEST, rows="targets[{}].tolerance")
        checks.array("weights", (count,), least=SMALLEST, rows="targets[{}].weight")
        if self.approaches is not None:
            rows = numbers_in(self.approaches)  # with NaN, which other arrays must not hold
            if rows is None or rows.shape != (count, 4):
                checks.report("approaches", f"must be {count} x 4 numbers")
            else:
                checks.put("approaches", frozen(rows))
        checks.refuse()

    @cached_property
    def cell(self) -> NDArray[np.intp]:
        """The samples, with -1 for each target where none is of a surface, shape (n,)."""
        return np.full(len(self), -1) if self.samples is None else self.samples

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
            _rows([target.approach for target in targets]),
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
        row = None if self.approaches is None else self.approaches[index]
        approach = None if row is None or np.isnan(row[3]) else Approach(row[:3], float(row[3]))
        return PointTarget(self.names[index], self.positions[index], tolerance, weight, approach)

    def take(self, chosen: NDArray[np.intp]) -> TargetTable:
        """Return some of the targets."""
        return TargetTable(
            tuple(self.names[index] for index in chosen),
            self.positions[chosen],
            self.tolerances[chosen],
            self.weights[chosen],
            None if self.approaches is None else self.approaches[chosen],
            None if self.samples is None else self.samples[chosen],
        )

    def followed_by(self, other: TargetTable) -> TargetTable:
        """Return these targets and then others."""
        rows = [_no_approaches(len(t)) if t.approaches is None else t.approaches for t in (self, other)]
        return TargetTable(
            (*self.names, *other.names),
            np.concatenate([self.positions, other.positions]),
            np.concatenate([self.tolerances, other.tolerances]),
            np.concatenate([self.weights, other.weights]),
            None if self.approaches is None and other.approaches is None else np.concatenate(rows),
            np.concatenate([self.cell, other.cell]),
        )


def _rows(approaches: Sequence[Approach | None]) -> FloatArray | None:
    """Return approaches as a table has them."""
    if not any(approaches):
        return None
    rows = _no_approaches(len(approaches))
    for row, approach in zip(rows, approaches, strict=True):
        if approach is not None:
            row[:] = [*approach.direction, approach.tolerance]
    return rows


def _no_approaches(count: int) -> FloatArray:
    return np.full((count, 4), np.nan)


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
