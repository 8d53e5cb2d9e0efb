"""The fastest motion along a straight piece in the joint angles, from rest to rest: a trapezoid of speed."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen, frozen_value

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


_ROUNDING = 1e-12  # of the duration: when a share of the way begins


@frozen_value
class Profile:
    """A motion from rest to rest, straight in the joint angles, both joints in step.

    Attributes:
        start: Angles at which it starts, shape (2,), rad.
        change: By how much they change, shape (2,), rad.
        speed: Largest rate of the share of the way, 1/s.
        acceleration: Rate of that rate while it grows and falls, 1/s^2; infinite for a piece of no length.
    """

    start: FloatArray
    change: FloatArray
    speed: float
    acceleration: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "start", frozen(self.start))
        object.__setattr__(self, "change", frozen(self.change))

    @classmethod
    def fastest(cls, start: FloatArray, end: FloatArray, speeds: FloatArray, rates: FloatArray) -> Profile:
        """Return the fastest motion within limits.

        Args:
            start: Angles at which it starts, shape (2,), rad.
            end: Angles at which it ends, shape (2,), rad.
            speeds: Largest speed of each joint, shape (2,), rad/s.
            rates: Largest acceleration of each joint, shape (2,), rad/s^2.
        """
        change = end - start
        moves = np.abs(change) > 0.0
        speed = float(np.min(speeds[moves] / np.abs(change[moves]), initial=math.inf))
        acceleration = float(np.min(rates[moves] / np.abs(change[moves]), initial=math.inf))
        # Of a short piece the speed is never reached: half of it is all acceleration.
        return cls(start, change, min(speed, math.sqrt(acceleration)), acceleration)

    @property
    def ramp(self) -> float:
        """How long it speeds up, and slows down, s."""
        return self.speed / self.acceleration if math.isfinite(self.acceleration) else 0.0

    @property
    def duration(self) -> float:
        """How long it takes, s."""
        return self.ramp + 1.0 / self.speed if math.isfinite(self.acceleration) else 0.0

    def at(self, time: ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return angles, rad, velocities, rad/s, and accelerations, rad/s^2, each of shape (..., 2).

        Args:
            time: Time since it began, shape (...), s; before and after, the arm rests.
        """
        t = np.clip(np.asarray(time, dtype=np.float64), 0.0, self.duration)
        if self.duration == 0.0:
            still = np.zeros((*t.shape, 2))
            return self.start + still, still, still.copy()
        left, slack = self.duration - t, _ROUNDING * self.duration
        falling = left <= self.ramp + slack
        rising = (t < self.ramp - slack) & ~falling
        share = self.speed * (t - 0.5 * self.ramp)
        share = np.where(rising, 0.5 * self.acceleration * t**2, share)
        share = np.where(falling, 1.0 - 0.5 * self.acceleration * left**2, share)
        rate = np.where(rising, self.acceleration * t, self.speed)
        rate = np.where(falling, self.acceleration * left, rate)
        bend = self.acceleration * (rising.astype(np.float64) - falling)
        return (
            self.start + share[..., None] * self.change,
            rate[..., None] * self.change,
            bend[..., None] * self.change,
        )
