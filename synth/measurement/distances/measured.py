"""What was measured of a robot that stands there: distances or markers, and how precisely."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import GivenArray, GivenArrayOrNone, frozen, frozen_value, given

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from synth.geometry import Category
    from synth.robot import Robot

_BOUND_OF_SIGMA = 3.0  # a normal error beyond it is one in 370


@dataclass(frozen=True)
class Precision:
    """How far a measured number may be from the true one.

    Attributes:
        sigma: Standard deviation of the error, m.
        bound: Largest error that is believed, m: half the rounding step, or three sigma.
        is_rounding: Whether the error is uniform within the bound, and not normal.
    """

    sigma: float
    bound: float
    is_rounding: bool

    @classmethod
    def from_rounding(cls, step: float) -> Precision:
        """Return the precision of numbers rounded to a multiple of `step`, m."""
        return cls(step / math.sqrt(12.0), 0.5 * step, is_rounding=True)

    @classmethod
    def from_sigma(cls, sigma: float) -> Precision:
        """Return the precision of numbers with a normal error of this standard deviation, m."""
        return cls(sigma, _BOUND_OF_SIGMA * sigma, is_rounding=False)


@frozen_value
class MeasuredDistances:
    """Distances between points P1, P2, ...; not every pair need be there.

    A distance with sigma 0 is known, not measured: its bounds are the value itself.

    Attributes:
        pairs: Which two points each distance is between, as indices from 0, shape (m, 2).
        values: The distances d, shape (m,), m.
        sigma: Standard deviation of each one's error, shape (m,), m; its weight is 1 / sigma^2.
        lower: Least value that each may really have, shape (m,), m.
        upper: Largest value that each may really have, shape (m,), m; infinite for one not measured.
    """

    pairs: NDArray[np.intp]
    values: GivenArray
    sigma: GivenArray
    lower: GivenArray
    upper: GivenArray

    def __post_init__(self) -> None:
        pairs = np.array(self.pairs, dtype=np.intp).reshape(-1, 2)
        pairs.setflags(write=False)
        object.__setattr__(self, "pairs", pairs)
        for name in ("values", "sigma", "lower", "upper"):
            object.__setattr__(self, name, frozen(np.broadcast_to(getattr(self, name), len(pairs))))

    @classmethod
    def of(
        cls, measured: Mapping[str, float], precision: Precision, known: Mapping[str, float] | None = None
    ) -> MeasuredDistances:
        """Return distances by their names, such as {"d13": 0.671}, m.

        Args:
            measured: Those that were measured.
            precision: How precisely.
            known: Those that are known exactly; a name that is in both counts as measured.
        """
        both = {**(known or {}), **measured}
        names = sorted(both)
        values = np.array([both[name] for name in names])
        loose = np.array([name in measured for name in names])
        return cls(
            pairs=np.array([[int(digit) - 1 for digit in name[1:]] for name in names], dtype=np.intp),
            values=values,
            sigma=precision.sigma * loose,
            lower=np.maximum(values - precision.bound * loose, 0.0),
            upper=values + precision.bound * loose,
        )

    @property
    def names(self) -> tuple[str, ...]:
        """Names such as "d13", in order."""
        return tuple(f"d{i + 1}{j + 1}" for i, j in self.pairs)

    @property
    def count(self) -> int:
        """Number of points."""
        return int(self.pairs.max()) + 1

    @property
    def is_known(self) -> NDArray[np.bool_]:
        """Whether each distance is known and not measured, shape (m,)."""
        return np.asarray(self.sigma == 0.0)

    def __getitem__(self, name: str) -> float:
        """Return the value of a distance by its name."""
        return float(self.values[self.names.index(name)])

    def among(self, count: int) -> MeasuredDistances:
        """Return the distances among the first `count` points."""
        return self._take(np.asarray((self.pairs < count).all(axis=1)))

    def without(self, name: str) -> MeasuredDistances:
        """Return all but one distance."""
        return self._take(np.array([other != name for other in self.names]))

    def replaced(self, name: str, value: float, bound: float) -> MeasuredDistances:
        """Return the same with another value of one distance, and bounds this far from it, m."""
        k = self.names.index(name)
        values, lower, upper = np.array(self.values), np.array(self.lower), np.array(self.upper)
        values[k], lower[k], upper[k] = value, max(value - bound, 0.0), value + bound
        return MeasuredDistances(self.pairs, values, self.sigma, lower, upper)

    def unbounded(self) -> MeasuredDistances:
        """Return the same with no bounds for what was measured; what is known stays known."""
        known = self.is_known
        lower, upper = np.where(known, self.lower, 0.0), np.where(known, self.upper, np.inf)
        return MeasuredDistances(self.pairs, self.values, self.sigma, lower, upper)

    def _take(self, chosen: NDArray[np.bool_]) -> MeasuredDistances:
        return MeasuredDistances(
            self.pairs[chosen],
            self.values[chosen],
            self.sigma[chosen],
            self.lower[chosen],
            self.upper[chosen],
        )


@frozen_value
class Measurement:
    """One shape of a robot, as it was measured.

    Attributes:
        name: What it is called.
        robot: The hardware; its d12 and d34 are those measured, where they were.
        precision: How precisely the distances, or the coordinates of the markers, are known.
        distances: Distances of P1, ..., P4, of P5 to P3 and P4 and, where a pose of the end effector was
            measured, of P5 to P1 and P2.
        markers: P1, ..., P4 or P5 in any frame, shape (4, 3) or (5, 3), m; None if distances were measured.
        intended: Kind of shape that it was meant to be, or None if nothing is said of it.
    """

    name: str
    robot: Robot
    precision: Precision
    distances: MeasuredDistances
    markers: GivenArrayOrNone = given(default=None)
    intended: Category | None = None

    @property
    def has_pose(self) -> bool:
        """Whether a pose of the end effector was measured."""
        return {"d15", "d25"} <= set(self.distances.names)
