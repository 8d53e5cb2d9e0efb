"""Are the markers to be believed? Wrong units, frames and names are refused, bad markers left out.

What is known of any arm decides: distances on its axes and to P5, that axis 1 is the z axis of its base, the
sense in which joints turn. Where a mirrored or turned frame leaves all that as it is, the arm that was wanted
decides.
"""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import frozen_value
from synth.measurement.markers.arm_fit import ArmFit, fit_arm, marker_positions
from synth.measurement.markers.frames import PLAUSIBLE, frame_nearer, frame_that_fits, wrong_base
from synth.measurement.markers.markers import Place, Readings
from synth.rounding import rounded_up

if TYPE_CHECKING:
    from collections.abc import Callable

    from synth.measurement.markers.standing_arm import StandingArm
    from synth.robot import Robot

    _Fitter = Callable[[Readings], ArmFit]

_IMPLAUSIBLE = 1e-3  # chance below which the markers are not believed
_MOST_REJECTED = 2
_FACTORS = {"1000 times too large": 1e3, "1000 times too small": 1e-3, "10 times too large": 10.0,
            "10 times too small": 0.1, "in inches, not millimetres": 1 / 25.4}  # fmt: skip
_SHORTEST = 0.02  # m; distances below tell nothing of a unit


@frozen_value
class Examination:
    """What is to be believed of readings.

    Attributes:
        fit: The arm that stands there; None if the readings are refused.
        used: The readings that it was fitted to.
        rejected: Markers left out, each with the reason.
        refusal: Why the readings are refused, as a sentence, or empty.
    """

    fit: ArmFit | None
    used: Readings
    rejected: tuple[tuple[str, str], ...] = ()
    refusal: str = ""


def examine(
    readings: Readings, wanted: StandingArm, robot: Robot, sigma: float, *, base_calibrated: bool
) -> Examination:
    """Return what is to be believed of readings.

    Args:
        readings: Where markers were seen.
        wanted: The arm that should stand there.
        robot: The hardware.
        sigma: Standard deviation of each coordinate of a marker, m.
        base_calibrated: Whether axis 1 is known to be the z axis of the frame.
    """
    lost = [(name, "it is on the link and says nothing of the axes")
            for name in dict.fromkeys(readings.names[k] for k in readings.at(Place.LINK))]  # fmt: skip
    used = readings.take([k for k, marker in enumerate(readings.markers) if marker.place is not Place.LINK])
    refusal = (
        what_is_missing(used, base_calibrated=base_calibrated)
        or _wrong_scale(used, wanted, robot)
        or wrong_base(used)
    )
    if refusal:
        return Examination(None, used, tuple(lost), refusal)

    def fitted(some: Readings) -> ArmFit:
        return fit_arm(some, wanted, robot.tip_offset, sigma, base_calibrated=base_calibrated)

    fit = fitted(used)
    while fit.plausibility < _IMPLAUSIBLE:
        if refusal := frame_that_fits(used, fitted) or _swap_that_fits(used, fitted):
            return Examination(None, used, tuple(lost), refusal)
        culprit = (
            _culprit(used, fitted, robot.tip_offset)
            if len(lost) < _MOST_REJECTED + readings.at(Place.LINK).size
            else None
        )
        if culprit is None:
            worst = float(np.linalg.norm(fit.residuals, axis=1).max())
            return Examination(
                None, used, tuple(lost),
                f"the markers contradict each other by up to {rounded_up(worst)} mm, and which of them is "
                "wrong cannot be told",
            )  # fmt: skip
        name, off = culprit
        lost.append((name, f"it is {1e3 * off:.1f} mm from where the other markers say that it must be"))
        used = used.without(name)
        fit = fitted(used)
    if refusal := frame_nearer(fit, wanted):
        return Examination(None, used, tuple(lost), refusal)
    return Examination(fit, used, tuple(lost))


def what_is_missing(readings: Readings, *, base_calibrated: bool) -> str:
    """Return which axis the markers do not show, and what would show it; empty if they show both.

    Args:
        readings: Where markers were seen.
        base_calibrated: Whether axis 1 is known to be the z axis of the frame.
    """
    on_axis_2 = {readings.offsets[k] for k in readings.at(Place.AXIS_2)}
    if len(on_axis_2) < 2:
        return (
            "axis 2 is not shown: two markers on it are needed, P3 and P4 or a bar such as A2:-150 and A2:150"
        )
    on_axis_1 = {readings.offsets[k] for k in readings.at(Place.AXIS_1)}
    turned = np.ptp(readings.joints[:, 0]) > np.radians(30.0)
    if len(on_axis_1) < 2 and not base_calibrated and not turned:
        return (
            "axis 1 is not shown: P1 and P2 are needed, or a turn of joint 1, or the word that the frame "
            "was found by "
            "turning joint 1 (--base-calibrated)"
        )
    return ""


def _wrong_scale(readings: Readings, wanted: StandingArm, robot: Robot) -> str:
    """Return what is wrong with the unit, or nothing: by distances that every posture has."""
    ratios = []
    for i, j in combinations(range(len(readings.markers)), 2):
        a, b = readings.markers[i], readings.markers[j]
        if not np.allclose(readings.joints[i], readings.joints[j], atol=1e-6):
            continue
        if a.place is b.place and a.place in {Place.AXIS_1, Place.AXIS_2}:
            known = abs(a.offset - b.offset)
        elif {a.place, b.place} == {Place.AXIS_2, Place.END_EFFECTOR}:
            on_axis = a if a.place is Place.AXIS_2 else b
            known = float(np.hypot(wanted.offset + robot.tip_offset - on_axis.offset, wanted.radius))
        else:
            continue
        if known >= _SHORTEST:
            ratios.append(float(np.linalg.norm(readings.positions[i] - readings.positions[j])) / known)
    if not ratios:
        return ""
    ratio = float(np.median(ratios))
    if 0.8 < ratio < 1.25:
        return ""
    for words, factor in _FACTORS.items():
        if 0.8 < ratio / factor < 1.25:
            return f"the unit is wrong: distances between the markers are {words}"
    return (
        f"distances between the markers are {ratio:.3g} times what the hardware has: "
        "is the unit wrong, or are the names?"
    )


def _swap_that_fits(readings: Readings, fitted: _Fitter) -> str:
    """Return which two names must be exchanged for the readings to fit, or nothing."""
    names = dict.fromkeys(readings.names)
    for one, other in combinations(names, 2):
        a, b = (next(m for m in readings.markers if m.name == name) for name in (one, other))
        swapped = tuple(b if m.name == one else a if m.name == other else m for m in readings.markers)
        if fitted(Readings(swapped, readings.positions, readings.joints)).plausibility > PLAUSIBLE:
            return f"{one} and {other} seem to have each other's names"
    return ""


def _culprit(readings: Readings, fitted: _Fitter, tip_offset: float) -> tuple[str, float] | None:
    """Return the one marker without which all others agree, and how far off it is, m; or None."""
    found = []
    for name in dict.fromkeys(readings.names):
        rest = readings.without(name)
        if what_is_missing(rest, base_calibrated=True):
            continue
        fit = fitted(rest)
        if fit.excess > 0 and fit.plausibility > PLAUSIBLE and fit.shows_axes:
            found.append((fit.plausibility, name))
    found.sort(reverse=True)
    if not found or (len(found) > 1 and found[1][0] > 0.1 * found[0][0]):
        return None
    name = found[0][1]
    arm = fitted(readings.without(name)).arm
    off = readings.take([k for k, other in enumerate(readings.names) if other == name])
    away = marker_positions(arm, off, tip_offset) - off.positions
    return name, float(np.linalg.norm(away, axis=1).max())
