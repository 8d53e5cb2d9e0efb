"""Where the robot stands."""

from __future__ import annotations

import math
from dataclasses import field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen, frozen_value
from synth.checks import Checks

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


@frozen_value
class BasePose:
    """The pose of the robot's base frame in the task frame.

    Attributes:
        position: P1 in the task frame, shape (3,), m.
        yaw: Rotation of the base frame about the vertical, rad.
    """

    position: FloatArray = field(default_factory=lambda: np.zeros(3))
    yaw: float = 0.0

    def __post_init__(self) -> None:
        checks = Checks(self)
        checks.array("position", (3,))
        checks.number("yaw")
        checks.refuse()

    @cached_property
    def rotation(self) -> FloatArray:
        """Rotation matrix from the base frame to the task frame, shape (3, 3)."""
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        return frozen([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])

    def to_task(self, points: ArrayLike) -> FloatArray:
        """Turn points of the base frame, shape (..., 3), into points of the task frame."""
        return np.asarray(points, dtype=np.float64) @ self.rotation.T + self.position

    def to_base(self, points: ArrayLike) -> FloatArray:
        """Turn points of the task frame, shape (..., 3), into points of the base frame."""
        return (np.asarray(points, dtype=np.float64) - self.position) @ self.rotation
