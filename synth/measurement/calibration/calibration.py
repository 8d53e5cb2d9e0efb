"""The real arm from positions of its end effector: a sweep after the link was stiffened.

The unknowns are where the circle of P5 is, how axis 2 points, the zero of joint 2 and the radius, seven
numbers; axis 1 is the z axis of the frame. With the joint angles known each point is worth three numbers.
With unknown ones it is worth one, its distance from the surface, and only the five invariants of the surface
can be found: the zeros of the joints stay open. Gauss-Newton steps from several starts, derivatives by
differences.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen, frozen_value
from synth.geometry import Invariants, SweptCircle
from synth.measurement.calibration.sweep_fit import SMALL, UNKNOWNS, changed, fit_sweep
from synth.measurement.markers import joints_closest_to
from synth.rounding import rounded_up, told_apart

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.measurement.markers import StandingArm

SURFACE_RMS = 0.3e-3  # m; a calibration that promises no better than this is refused, unless told
_STARTS = 4
_START_SPREAD = np.array([8e-3] * 3 + [0.06] * 3 + [2e-3])  # m and rad
_OPEN = 1.0  # m and rad: what no point shows stays this uncertain
_OUTLIER = 4.5  # standard deviations
_MOST_OUTLIERS = 0.1  # of the points
_IMPLAUSIBLE = 1e-4
_SECONDS = 181  # angles of joint 2 at which the surface is looked at
_FEWEST = 8
_HALVES_AGREE = 4.0  # times what half of the points leave open


@frozen_value
class Calibration:
    """The arm that fits a sweep best.

    Attributes:
        arm: The arm, in the base frame; with unknown joints the zeros of its joints mean nothing.
        covariance: Of the circle's centre (3, m), rotation vector about it (3, rad) and radius (m), (7, 7).
        invariants_covariance: Of (a, alpha, z0, h, R), shape (5, 5), m and rad.
        surface_rms: Expected distance of the fitted surface from the true one, root mean square over all that
            joint 2 can reach, m; more where halves of the points contradict each other.
        plausibility: Chance that points with errors as supposed fit no better.
        used: Which points were used, shape (n,).
        joints_known: Whether the joint angles were given.
        refusal: Why the arm is not to be believed, as a sentence, or empty.
    """

    arm: StandingArm
    covariance: FloatArray
    invariants_covariance: FloatArray
    surface_rms: float
    plausibility: float
    used: NDArray[np.bool_]
    joints_known: bool
    refusal: str

    def __post_init__(self) -> None:
        object.__setattr__(self, "covariance", frozen(self.covariance))
        object.__setattr__(self, "invariants_covariance", frozen(self.invariants_covariance))

    @property
    def invariants(self) -> Invariants:
        """The five numbers that determine the surface."""
        return Invariants.from_circle(_circle(self.arm))

    def samples(self, count: int, seed: int = 0) -> StandingArm:
        """Return arms drawn from what the sweep leaves open."""
        values, vectors = np.linalg.eigh(self.covariance)
        drawn = np.random.default_rng(seed).normal(size=(count, UNKNOWNS))
        return changed(self.arm, (drawn * np.sqrt(np.maximum(values, 0.0))) @ vectors.T)


def calibrate(
    points: FloatArray,
    joints: FloatArray | None,
    wanted: StandingArm,
    sigma: float,
    *,
    most_rms: float = SURFACE_RMS,
    seed: int = 0,
) -> Calibration:
    """Return the arm that fits a sweep best, with a refusal if it is not to be believed.

    Args:
        points: Positions of P5 in the base frame, shape (n, 3), m.
        joints: The joint angles there, shape (n, 2), rad; None if they are unknown.
        wanted: The arm that should stand there, where the search begins.
        sigma: Standard deviation of each coordinate of a point, m.
        most_rms: Largest `surface_rms` that is accepted, m.
        seed: Of the starts.
    """
    from scipy.special import gammaincc  # type: ignore[import-untyped]  # noqa: PLC0415

    rng = np.random.default_rng(seed)
    starts = [
        wanted,
        *(changed(wanted, rng.normal(size=UNKNOWNS) * _START_SPREAD) for _ in range(_STARTS - 1)),
    ]
    used = np.ones(len(points), dtype=bool)
    while True:
        some = None if joints is None else joints[used]
        fits = sorted(
            (fit_sweep(points[used], some, start, sigma) for start in starts), key=lambda fit: fit[2]
        )
        arm, information, chi_square, misses = fits[0]
        numbers = int(used.sum()) * (1 if joints is None else 3)
        plausibility = float(
            gammaincc(0.5 * max(numbers - (5 if joints is None else UNKNOWNS), 1), 0.5 * chi_square)
        )
        worst = int(np.argmax(misses))
        if (
            plausibility >= _IMPLAUSIBLE
            or misses[worst] < _OUTLIER * sigma
            or (~used).sum() >= _MOST_OUTLIERS * len(points)
        ):
            break
        used[np.flatnonzero(used)[worst]] = False
        starts = [arm, wanted]
    covariance = _covariance(information)
    rms = _surface_rms(arm, covariance)
    if joints is None and len(points) >= 2 * _FEWEST:
        rms = max(rms, _told_by_halves(points[used], arm, wanted, sigma))
    refusal = ""
    if len(points) < _FEWEST:
        refusal = f"{len(points)} points are too few: {_FEWEST} at least, over the whole range of joint 2"
    elif rms > most_rms:
        refusal = _too_little_swept(points, joints, wanted, rms, most_rms)
    elif plausibility < _IMPLAUSIBLE:
        off = float(np.sqrt(np.mean(misses**2)))
        refusal = (
            "the points fit no arm of this kind: they are "
            f"{rounded_up(off, digits=2)} mm off the best one (root mean square)"
        )
    return Calibration(
        arm, covariance, _of_invariants(arm, covariance), rms, plausibility, used, joints is not None, refusal
    )


def _covariance(information: FloatArray) -> FloatArray:
    """Return the covariance, shape (7, 7); what no point shows stays open."""
    return np.asarray(np.linalg.inv(information + np.eye(UNKNOWNS) / _OPEN**2), dtype=np.float64)


def _surface_rms(arm: StandingArm, covariance: FloatArray) -> float:
    """Return the expected distance of the surface from the true one, root mean square by area, m."""
    second = np.linspace(arm.limits.second.lower, arm.limits.second.upper, _SECONDS)
    joints = np.stack([np.full(_SECONDS, arm.joint1), second], axis=-1)
    _, velocities = arm.velocities(joints)
    normal = np.cross(velocities[..., 0], velocities[..., 1])
    area = np.linalg.norm(normal, axis=-1)
    normal /= np.maximum(area, 1e-12)[:, None]
    steps = SMALL * np.vstack([np.eye(UNKNOWNS), -np.eye(UNKNOWNS)])
    moved = changed(arm, steps).forward(np.broadcast_to(joints, (2 * UNKNOWNS, *joints.shape)))
    by = np.einsum("knj,nj->kn", (moved[:UNKNOWNS] - moved[UNKNOWNS:]) / (2.0 * SMALL), normal)
    variances = np.einsum("kn,kl,ln->n", by, covariance, by)
    return float(np.sqrt(np.sum(area * variances) / np.sum(area)))


def _told_by_halves(points: FloatArray, arm: StandingArm, wanted: StandingArm, sigma: float) -> float:
    """Return how far from an arm's surface those are that half of the points give, m, the farther of two.

    Where it is about as far as half as many points leave open, 0. The covariance tells of one valley. Where
    axes nearly meet or are nearly parallel the workspace has two sheets near each other, each point takes the
    nearer one, and a short sweep fits arms whose surfaces are far apart elsewhere.
    """
    apart, expected = [], []
    for half in (points[::2], points[1::2]):
        fits = (fit_sweep(half, None, start, sigma) for start in (arm, wanted))
        found, information, *_ = min(fits, key=lambda fit: fit[2])
        apart.append(_between(arm, found))
        expected.append(_surface_rms(found, _covariance(information)))
    return max(apart) if max(apart) > _HALVES_AGREE * max(expected) else 0.0


def _between(arm: StandingArm, other: StandingArm) -> float:
    """Return the distance of another arm's surface from an arm's, root mean square by area, nearly, m."""
    second = np.linspace(arm.limits.second.lower, arm.limits.second.upper, _SECONDS)
    points = other.forward(np.column_stack([np.full(_SECONDS, other.joint1), second]))
    area = np.hypot(points[:, 0], points[:, 1])
    return float(np.sqrt(np.sum(area * _circle(arm).distance(points) ** 2) / np.sum(area)))


def _of_invariants(arm: StandingArm, covariance: FloatArray) -> FloatArray:
    """Return the covariance of the invariants."""

    def numbers(by: FloatArray) -> FloatArray:
        five = Invariants.from_circle(_circle(changed(arm, by)))
        return np.array([five.a, five.alpha, five.z0, five.h, five.R])

    slope = np.array([(numbers(e) - numbers(-e)) / (2.0 * SMALL) for e in SMALL * np.eye(UNKNOWNS)])
    return np.asarray(slope.T @ covariance @ slope)


def _circle(arm: StandingArm) -> SweptCircle:
    return SweptCircle(arm.centre, arm.axis, float(arm.radius))


def _too_little_swept(
    points: FloatArray, joints: FloatArray | None, arm: StandingArm, rms: float, most_rms: float
) -> str:
    """Return that a sweep does not determine the surface, and what to move more."""
    angles = joints_closest_to(arm, points)[:, 1] if joints is None else joints[:, 1]
    seen, whole = np.ptp(angles), arm.limits.second.upper - arm.limits.second.lower
    would, asked = told_apart(rms, most_rms, digits=2)
    return (
        f"the sweep does not determine the surface: it would be off by {would} mm root mean square, and "
        f"{asked} mm is asked. Joint 2 moved over {np.degrees(seen):.0f} of its {np.degrees(whole):.0f} deg: "
        "move it over the whole range" + ("" if joints is not None else ", or give the joint angles")
    )
