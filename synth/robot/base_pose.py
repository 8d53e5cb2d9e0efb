"""Where the robot stands."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, GivenArray, frozen, frozen_value, given
from synth.checks import Checks
from synth.geometry import rotation_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

_UPRIGHT = 1e-9  # rad; an axis 1 that leans by less does so by rounding


@frozen_value
class BasePose:
    """The pose of the robot's base frame in the task frame.

    Attributes:
        position: P1 in the task frame, shape (3,), m.
        yaw: Rotation of the base frame about the vertical, rad, after the two others.
        pitch: Rotation about the y axis of the task frame, rad, after `roll`.
        roll: Rotation about the x axis of the task frame, rad: 90 deg hangs the robot on a wall with axis 1
            along -y, 180 deg on a ceiling.
    """

    position: GivenArray = given(default_factory=lambda: np.zeros(3))
    yaw: float = 0.0
    pitch: float = 0.0
    roll: float = 0.0

    def __post_init__(self) -> None:
        checks = Checks(self)
        checks.array("position", (3,))
        for key in ("yaw", "pitch", "roll"):
            checks.number(key)
        checks.refuse()

    @cached_property
    def rotation(self) -> FloatArray:
        """Rotation matrix from the base frame to the task frame, Rz(yaw) Ry(pitch) Rx(roll), shape (3, 3)."""
        return frozen(rotation_of(self.roll, self.pitch, self.yaw))

    @property
    def is_upright(self) -> bool:
        """Whether axis 1 is vertical and points up."""
        return bool(
            np.hypot(self.rotation[0, 2], self.rotation[1, 2]) < _UPRIGHT and self.rotation[2, 2] > 0.0
        )

    def to_task(self, points: ArrayLike) -> FloatArray:
        """Turn points of the base frame, shape (..., 3), into points of the task frame."""
        return np.asarray(points, dtype=np.float64) @ self.rotation.T + self.position

    def to_base(self, points: ArrayLike) -> FloatArray:
        """Turn points of the task frame, shape (..., 3), into points of the base frame."""
        return (np.asarray(points, dtype=np.float64) - self.position) @ self.rotation

    def turned_from(self, other: BasePose) -> float:
        """Return the angle by which the base is turned from another, about whatever axis, rad."""
        turn = other.rotation.T @ self.rotation
        skew = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
        return float(np.arctan2(np.linalg.norm(skew), np.trace(turn) - 1.0))
