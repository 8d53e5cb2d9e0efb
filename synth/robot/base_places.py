"""Where the robot may be made to stand: ranges of its base's pose, or a choice of places."""

from __future__ import annotations

from dataclasses import fields
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen, frozen_value, given
from synth.checks import Checks, wrong_type
from synth.names import given_twice
from synth.robot.base_pose import BasePose
from synth.robot.hardware import GivenInterval, Interval, check_interval, into_turn

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

_ZERO = Interval(0.0, 0.0)
_ANGLES = 3  # in a row (x, y, z, roll, pitch, yaw) the first of them
_FULL = 1e-9  # rad; a range that is short of a full turn by this is one


@frozen_value
class BaseRange:
    """Ranges of the base's pose, each of its numbers on its own; see `BasePose`.

    Attributes:
        x: Of P1 in the task frame, m.
        y: Likewise.
        z: Likewise.
        roll: Rotation about the x axis of the task frame, rad.
        pitch: About the y axis, after roll, rad.
        yaw: About the vertical, after both, rad.
    """

    x: GivenInterval = given(default=_ZERO)
    y: GivenInterval = given(default=_ZERO)
    z: GivenInterval = given(default=_ZERO)
    roll: GivenInterval = given(default=_ZERO)
    pitch: GivenInterval = given(default=_ZERO)
    yaw: GivenInterval = given(default=_ZERO)

    def __post_init__(self) -> None:
        checks = Checks(self)
        for each in fields(self):
            check_interval(checks, self, each.name)
        checks.refuse()

    @cached_property
    def bounds(self) -> FloatArray:
        """Least and largest of x, y, z, roll, pitch and yaw, shape (2, 6), m and rad."""
        each = [getattr(self, each.name) for each in fields(self)]
        return frozen([[one.lower for one in each], [one.upper for one in each]])

    @property
    def ends(self) -> FloatArray:
        """As `bounds`, but infinite where a full turn has no ends."""
        return np.where(self._is_full_turn, np.array([[-np.inf], [np.inf]]), self.bounds)

    @property
    def is_fixed(self) -> bool:
        """Whether there is nothing to choose."""
        return bool((self.bounds[0] == self.bounds[1]).all())

    @property
    def middle(self) -> BasePose:
        """The pose in the middle of all ranges."""
        return self.pose(self.bounds.mean(axis=0))

    @staticmethod
    def pose(row: FloatArray) -> BasePose:
        """Return the pose of one row (x, y, z, roll, pitch, yaw), shape (6,), m and rad."""
        roll, pitch, yaw = row[3:].tolist()
        return BasePose(row[:3], yaw, pitch, roll)

    def sample(self, size: int, rng: np.random.Generator) -> FloatArray:
        """Draw rows (x, y, z, roll, pitch, yaw), uniform in their ranges, shape (size, 6)."""
        lower, upper = self.bounds
        return np.asarray(lower + (upper - lower) * rng.uniform(size=(size, 6)))

    def into_limits(self, rows: ArrayLike) -> FloatArray:
        """Return the nearest rows within the ranges, shape (..., 6); a full turn has no ends."""
        lower, upper = self.bounds
        rows = np.where(self._is_full_turn, into_turn(np.asarray(rows), 0.5 * (lower + upper)), rows)
        return np.asarray(np.clip(rows, lower, upper))

    @cached_property
    def _is_full_turn(self) -> NDArray[np.bool_]:
        wide = self.bounds[1] - self.bounds[0] >= 2.0 * np.pi - _FULL
        return np.asarray(wide & (np.arange(6) >= _ANGLES))

    def contains(self, pose: BasePose, slack: float = 1e-6) -> bool:
        """Whether a pose is within the ranges widened by `slack`, m and rad; angles count as they are."""
        row = np.array([*pose.position, pose.roll, pose.pitch, pose.yaw])
        return bool(((row >= self.bounds[0] - slack) & (row <= self.bounds[1] + slack)).all())


@frozen_value
class BaseChoices:
    """Places of which the robot is to stand at one, such as those where there are clamps.

    Attributes:
        names: What each is called.
        poses: The pose of the base at each.
    """

    names: Sequence[str]
    poses: Sequence[BasePose]

    def __post_init__(self) -> None:
        checks = Checks(self)
        checks.put("names", tuple(self.names))
        checks.put("poses", tuple(self.poses))
        if not self.poses or len(self.names) != len(self.poses):
            checks.report("poses", "must be as many as the names, and one at least")
        for index, pose in enumerate(self.poses):
            if wrong := wrong_type(pose, BasePose):
                checks.report(f"poses[{index}]", wrong)
        for index, first in given_twice(list(self.names)):
            checks.report(f"names[{index}]", f"{self.names[index]!r} is the name of names[{first}] already")
        checks.refuse()

    @property
    def middle(self) -> BasePose:
        """The pose at the first of them."""
        return self.poses[0]

    def contains(self, pose: BasePose, slack: float = 1e-6) -> bool:
        """Whether a pose is one of them but for `slack`, m and rad."""
        return self.name_of(pose, slack) is not None

    def name_of(self, pose: BasePose, slack: float = 1e-6) -> str | None:
        """Return what the place with a pose is called, or None if it is none of them."""
        for name, each in zip(self.names, self.poses, strict=True):
            moved = float(np.linalg.norm(each.position - pose.position))
            if moved <= slack and pose.turned_from(each) <= slack:
                return name
        return None


BasePlaces = BaseRange | BaseChoices
