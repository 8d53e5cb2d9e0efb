"""From markers to the arm that really stands there, with its covariance: weighted least squares.

The unknowns are the eleven freedoms of `StandingArm.displaced`. Gauss-Newton steps begin at the arm that was
wanted, its end turned onto the markers seen; derivatives are central differences, all at once.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen, frozen_value
from synth.measurement.markers.markers import Place
from synth.measurement.markers.standing_arm import FREEDOMS, StandingArm

if TYPE_CHECKING:
    from synth.measurement.markers.markers import Readings

_STEPS = 20
_SMALL = 1e-6  # m and rad, of the differences
_ARRIVED = 1e-7  # m and rad
# How well a turn of joint 1 shows axis 1.
BASE_SHIFT = 0.15e-3  # m, where it passes the base
BASE_TILT = 0.3e-3  # rad, its direction
# A base of which only markers tell: so wide that they alone decide.
_ANY_SHIFT = 1.0  # m
_ANY_TILT = 1.0  # rad
# What is known of the roll of the link's end about axis 2 where no marker shows it: that somebody meant to
# bend the link as was asked.
_ROLL = 0.12  # rad
_ANYWHERE = 10.0  # m and rad
_NOT_SHOWN = 0.05  # a freedom left as uncertain as this, m or rad, was not measured


@frozen_value
class ArmFit:
    """The arm that fits the markers best, and how sure that is.

    Attributes:
        arm: The arm, with joint 1 where it stood in the first reading.
        covariance: Of its freedoms, as `StandingArm.displaced` has them, shape (11, 11), m and rad.
        residuals: Of the markers, seen minus fitted, shape (m, 3), m.
        chi_square: Sum of the squared residuals over the marker's variance.
        excess: How many more numbers were measured than the fit has freedoms.
    """

    arm: StandingArm
    covariance: FloatArray
    residuals: FloatArray
    chi_square: float
    excess: int

    def __post_init__(self) -> None:
        object.__setattr__(self, "covariance", frozen(self.covariance))
        object.__setattr__(self, "residuals", frozen(self.residuals))

    @property
    def plausibility(self) -> float:
        """Chance that markers with errors as supposed fit no better; 1 where nothing can contradict."""
        from scipy.special import gammaincc  # type: ignore[import-untyped]  # noqa: PLC0415

        return float(gammaincc(0.5 * self.excess, 0.5 * self.chi_square)) if self.excess > 0 else 1.0

    @property
    def point_sigma(self) -> float:
        """Uncertainty of the link's end across axis 2, root mean square of the two directions, m."""
        across = np.eye(3) - np.outer(self.arm.axis, self.arm.axis)
        return float(np.sqrt(0.5 * np.trace(across @ self.covariance[5:8, 5:8] @ across)))

    @property
    def direction_sigma(self) -> float:
        """Uncertainty of the direction of axis 2, root mean square of the two directions, rad."""
        across = np.eye(3) - np.outer(self.arm.axis, self.arm.axis)
        return float(np.sqrt(0.5 * np.trace(across @ self.covariance[8:11, 8:11] @ across)))

    @property
    def roll_sigma(self) -> float:
        """Uncertainty of the roll about axis 2, hence of the zero of joint 2, rad."""
        return float(np.sqrt(self.arm.axis @ self.covariance[8:11, 8:11] @ self.arm.axis))

    @property
    def shows_roll(self) -> bool:
        """Whether the markers show the zero of joint 2."""
        return self.roll_sigma < _NOT_SHOWN

    @property
    def shows_axes(self) -> bool:
        """Whether the markers show where both axes are and how they point."""
        return bool(
            np.sqrt(np.diag(self.covariance)[[0, 1, 3, 4]]).max() < _NOT_SHOWN
            and self.point_sigma < _NOT_SHOWN
            and self.direction_sigma < _NOT_SHOWN
        )

    def samples(self, count: int, seed: int = 0) -> StandingArm:
        """Return arms drawn from what the measurement leaves open, with a leading axis of `count`."""
        return self.arm.displaced(self.errors(count, seed))

    def errors(self, count: int, seed: int = 0) -> FloatArray:
        """Return errors of such a measurement, shape (count, 11)."""
        values, vectors = np.linalg.eigh(self.covariance)
        drawn = np.random.default_rng(seed).normal(size=(count, FREEDOMS))
        return np.asarray((drawn * np.sqrt(np.maximum(values, 0.0))) @ vectors.T)


def marker_positions(arm: StandingArm, readings: Readings, tip_offset: float) -> FloatArray:
    """Return where the markers of readings are on an arm, or on many.

    Args:
        arm: The arm, with leading axes "...".
        readings: Which markers, in which postures; none on the link.
        tip_offset: From P3 along axis 2 to the link's end, m.

    Returns:
        Positions, shape (..., m, 3), m.
    """
    lead = arm.end.shape[:-1]
    result = np.empty((*lead, len(readings.markers), 3))
    offsets = readings.offsets
    on_axis_1 = readings.at(Place.AXIS_1)
    result[..., on_axis_1, :] = (
        arm.point[..., None, :] + offsets[on_axis_1, None] * arm.direction[..., None, :]
    )
    for place, column, origin in ((Place.AXIS_2, 0, tip_offset), (Place.LINK_END, 2, 0.0)):
        some = readings.at(place)
        along = (offsets[some] - origin)[:, None] * arm.frame[..., None, :, column]
        result[..., some, :] = arm.about_axis_1(arm.end[..., None, :] + along, readings.joints[some, 0])
    some = readings.at(Place.END_EFFECTOR)
    result[..., some, :] = arm.forward(readings.joints[some])
    return result


def fit_arm(
    readings: Readings,
    wanted: StandingArm,
    tip_offset: float,
    sigma: float,
    *,
    base_calibrated: bool,
) -> ArmFit:
    """Return the arm that fits readings best.

    Args:
        readings: Where the markers were seen; those on the link say nothing of the axes.
        wanted: The arm that should stand there, with joint 1 at any angle: where the search begins, and all
            that is known of the roll about axis 2 if no marker shows it.
        tip_offset: From P3 along axis 2 to the link's end, m.
        sigma: Standard deviation of each coordinate of a marker, m.
        base_calibrated: Whether axis 1 is the z axis of the frame, found by turning joint 1.
    """
    readings = readings.take([k for k, m in enumerate(readings.markers) if m.place is not Place.LINK])
    joint1 = float(readings.joints[0, 0])
    axis_at = wanted.about_axis_1(np.vstack([wanted.end, wanted.end + wanted.frame.T]), np.full(4, joint1))
    wanted = replace(wanted, end=axis_at[0], frame=(axis_at[1:] - axis_at[0]).T, joint1=joint1)
    arm = _turned_onto(readings, wanted, tip_offset)
    roll = np.outer(arm.axis, arm.axis)
    shift, tilt = (BASE_SHIFT, BASE_TILT) if base_calibrated else (_ANY_SHIFT, _ANY_TILT)
    known = np.zeros((FREEDOMS, FREEDOMS))
    known[range(5), range(5)] = [shift**-2] * 3 + [tilt**-2] * 2
    known[5:, 5:] += np.eye(6) / _ANYWHERE**2
    known[8:, 8:] += roll / _ROLL**2
    steps = _SMALL * np.concatenate([np.eye(FREEDOMS), -np.eye(FREEDOMS), np.zeros((1, FREEDOMS))])
    away = np.zeros(FREEDOMS)  # from where the prior is
    for _ in range(_STEPS):
        predicted = marker_positions(arm.displaced(steps), readings, tip_offset)
        slope = (predicted[:FREEDOMS] - predicted[FREEDOMS:-1]) / (2.0 * _SMALL)
        residuals = readings.positions - predicted[-1]
        by = slope.reshape(FREEDOMS, -1) / sigma
        information = by @ by.T + known
        step = np.linalg.solve(information, by @ residuals.ravel() / sigma - known @ away)
        arm, away = arm.displaced(step), away + step
        if np.abs(step).max() < _ARRIVED:
            break
    residuals = readings.positions - marker_positions(arm, readings, tip_offset)
    covariance = np.linalg.inv(information)
    shown = round(float(np.trace(covariance @ (information - known))))  # freedoms that the markers took up
    chi_square = float(np.sum((residuals / sigma) ** 2))
    return ArmFit(
        arm, np.asarray(covariance, dtype=np.float64), residuals, chi_square, residuals.size - shown
    )


def _turned_onto(readings: Readings, wanted: StandingArm, tip_offset: float) -> StandingArm:
    """Return the wanted arm with axis 1 and the link's end brought onto the markers of the first posture."""
    on_end = [
        k
        for k, marker in enumerate(readings.markers)
        if marker.place is not Place.AXIS_1 and np.allclose(readings.joints[k], readings.joints[0], atol=1e-6)
    ]
    if not on_end:
        return wanted
    seen = readings.take(on_end)
    there = marker_positions(wanted, seen, tip_offset)
    # Where the markers are in line the wanted roll counts, by two points of little weight.
    reference = np.vstack(
        [there, wanted.end + 0.3 * wanted.frame[:, 1], wanted.end - 0.3 * wanted.frame[:, 1]]
    )
    weights = np.append(np.ones(len(there)), [1e-4, 1e-4])
    middle = weights[:-2] @ there / len(there)
    shift = seen.positions.mean(axis=0) - middle
    aim = np.vstack([seen.positions, reference[-2:] + shift])
    a, b = reference - middle, aim - middle - shift
    left, _, right = np.linalg.svd((weights[:, None] * a).T @ b)
    turn = right.T @ np.diag([1.0, 1.0, np.linalg.det(left @ right)]) @ left.T
    return replace(wanted, end=middle + shift + turn @ (wanted.end - middle), frame=turn @ wanted.frame)
