"""How fast joints may turn along a path: the fastest speeds within limits, from rest to rest.

With s the length of the path so far the joints move at q' v and accelerate by q'' v^2 + q' v dv/ds. So v^2
is at most that at which q'' alone takes all of the acceleration, and from there each step forwards, then
backwards, may change it by what is left.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from synth.arrays import FloatArray

_STILL = 1e-12  # rad/m, of a joint that does not turn


def timed(
    joints: FloatArray, lengths: FloatArray, wanted: float, speeds: FloatArray, rates: FloatArray
) -> FloatArray:
    """Return when joint angles along a path are passed, shape (k,), s, from rest to rest.

    Args:
        joints: Angles (theta1, theta2) along it, shape (k, 2), rad.
        lengths: How long it is up to each, rising, shape (k,), m.
        wanted: Speed along it that is not exceeded, m/s.
        speeds: Largest speed of each joint, shape (2,), rad/s.
        rates: Largest acceleration of each joint, shape (2,), rad/s^2.
    """
    steps = np.diff(lengths)
    slopes = np.diff(joints, axis=0) / steps[:, None]
    halves = 0.5 * (steps[1:] + steps[:-1])
    bends = np.abs(np.diff(slopes, axis=0)) / halves[:, None]
    slope = np.abs(slopes)
    # At each place the steeper of the two pieces that meet there counts.
    steepest = np.maximum(np.vstack([slope[:1], slope]), np.vstack([slope, slope[-1:]]))
    with np.errstate(divide="ignore"):
        fastest = np.minimum(wanted, (speeds / steepest).min(axis=1))
        squared = fastest**2
        squared[1:-1] = np.minimum(squared[1:-1], (rates / bends).min(axis=1))
    squared[[0, -1]] = 0.0
    bends = np.vstack([np.zeros(2), bends, np.zeros(2)])
    _pushed(squared, steps, steepest, bends, rates)
    _pushed(squared[::-1], steps[::-1], steepest[::-1], bends[::-1], rates)
    speed = np.sqrt(squared)
    times = np.append(0.0, np.cumsum(2.0 * steps / (speed[1:] + speed[:-1])))
    return times * _stretch(joints, times, speeds, rates)


def _pushed(
    squared: FloatArray, steps: FloatArray, slopes: FloatArray, bends: FloatArray, rates: FloatArray
) -> None:
    """Lower squared speeds so that none is more than the one before, sped up as much as the joints may."""
    for index, step in enumerate(steps):
        left = rates - bends[index] * squared[index]
        turning = slopes[index] > _STILL
        gain = 2.0 * step * float(np.min(left[turning] / slopes[index][turning], initial=np.inf))
        squared[index + 1] = min(squared[index + 1], squared[index] + max(gain, 0.0))


def _stretch(joints: FloatArray, times: FloatArray, speeds: FloatArray, rates: FloatArray) -> float:
    """Return by what factor times are to be stretched so that differences keep all limits, 1 at least."""
    velocities, accelerations = differences(joints, times)
    return float(
        max(
            1.0,
            (np.abs(velocities) / speeds).max(),
            np.sqrt((np.abs(accelerations) / rates).max(initial=0.0)),
        )
    )


def differences(joints: FloatArray, times: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return velocities between joint angles, shape (k - 1, 2), and accelerations at them, shape (k, 2).

    Before and after the arm rests.

    Args:
        joints: Angles, shape (k, 2), rad.
        times: When they are passed, shape (k,), s.
    """
    steps = np.diff(times)
    velocities = np.diff(joints, axis=0) / steps[:, None]
    around = np.vstack([np.zeros(2), velocities, np.zeros(2)])
    # To rest and from it there is half a step.
    halves = 0.5 * (np.append(0.0, steps) + np.append(steps, 0.0))
    return velocities, np.diff(around, axis=0) / halves[:, None]
