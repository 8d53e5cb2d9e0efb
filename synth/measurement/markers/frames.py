"""The frame that markers were seen in, if not the base frame: as markers or the arm that was wanted show."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from synth.measurement.markers.markers import Place, Readings

if TYPE_CHECKING:
    from collections.abc import Callable

    from synth.arrays import FloatArray
    from synth.measurement.markers.arm_fit import ArmFit
    from synth.measurement.markers.standing_arm import StandingArm

PLAUSIBLE = 1e-2  # chance from which on readings that were changed are believed
_UPRIGHT = np.radians(20.0)  # that axis 1 may lean before the frame is another
_AT_ORIGIN = 0.05  # m, that P1 may be off
_FAR = 0.07  # m from the arm that was wanted; a hand places a link to some 15 mm
_NEAR = 0.06  # m from it, in the frame that is taken for the right one
_FRAMES: dict[str, FloatArray] = {
    "mirrored: x and -x are exchanged": np.diag([-1.0, 1.0, 1.0]),
    "mirrored: y and -y are exchanged": np.diag([1.0, -1.0, 1.0]),
    "mirrored: x and y are exchanged": np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]),
    "upside down": np.diag([1.0, -1.0, -1.0]),
    "one with y up, not z": np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]),
    "one with y up, not z, and mirrored": np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]]),
    "one with x up, not z": np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]),
}
_UP = {"x": "one with x up, not z", "y": "one with y up, not z"}


def frames_with_z_up() -> dict[str, FloatArray]:
    """Return turns of a frame whose z, y or x is up so that z is, by what is to be said of them."""
    turns = {"": np.eye(3)}
    for axis, words in _UP.items():
        turns[f"{axis} is up in the file: its frame was turned so that z is up"] = _FRAMES[words]
    return turns


def upright(readings: Readings) -> Readings:
    """Return readings with z up, if the markers on axis 1 say that x or y is up; said among the warnings.

    By a turn, never a reflection: x stays x where y is up. What is mirrored stays so, and is refused later.
    """
    axis, turn = turn_upright(readings)
    if not axis:
        return readings
    said = f"P1 to P2 points along {axis} of the file: its frame was turned so that z is up"
    turned = readings.positions @ turn.T
    return Readings(readings.markers, turned, readings.joints, (*readings.warnings, said))


def turn_upright(readings: Readings) -> tuple[str, FloatArray]:
    """Return which axis is up, x or y, and the turn that brings it to z; none if it is z, or not shown."""
    axis = axis_up(readings)
    return axis if axis in _UP else "", turn_to_z(axis)


def axis_up(readings: Readings) -> str:
    """Return the axis along which the markers on axis 1 point, x, y or z; an empty text if none is shown."""
    found = _axis_1(readings)
    along = () if found is None else found[1]
    return next((axis for axis, part in zip("xyz", along, strict=False) if part >= np.cos(_UPRIGHT)), "")


def turn_to_z(axis: str) -> FloatArray:
    """Return the turn that brings an axis that is up, x or y, to z; none for any other."""
    return _FRAMES[_UP[axis]] if axis in _UP else np.eye(3)


def wrong_base(readings: Readings) -> str:
    """Return what is wrong with the frame by the markers on axis 1, or nothing."""
    found = _axis_1(readings)
    if found is None:
        return ""
    p1, up = found
    if up[2] < np.cos(_UPRIGHT):
        along = "xyz"[int(np.argmax(np.abs(up)))]
        sign = "-" if up[np.argmax(np.abs(up))] < 0.0 else ""
        if abs(up).max() < np.cos(_UPRIGHT):
            tilt = np.degrees(np.arccos(up[2]))
            return f"this is not the base frame: from P1 to P2 axis 1 leans {tilt:.0f} deg off z"
        hint = " or P1 and P2 have each other's names" if (sign, along) == ("-", "z") else ""
        return f"this is not the base frame, whose z is up: P1 to P2 points along {sign}{along}{hint}"
    if np.linalg.norm(p1) > _AT_ORIGIN:
        return f"this is not the base frame, whose origin is P1: P1 is at {_mm(p1)}"
    return ""


def _axis_1(readings: Readings) -> tuple[FloatArray, FloatArray] | None:
    """Return P1 and the direction to P2 as the markers on axis 1 show them; None where they show none."""
    some = readings.at(Place.AXIS_1)
    offsets = readings.offsets[some]
    if len(some) < 2 or np.ptp(offsets) == 0.0:
        return None
    at = readings.positions[some]
    slope = (offsets - offsets.mean()) @ (at - at.mean(axis=0)) / np.sum((offsets - offsets.mean()) ** 2)
    length = np.linalg.norm(slope)
    return (at.mean(axis=0) - offsets.mean() * slope, slope / length) if length > 0.0 else None


def frame_that_fits(readings: Readings, fitted: Callable[[Readings], ArmFit]) -> str:
    """Return which other frame the readings fit, or nothing."""
    for words, turn in _FRAMES.items():
        other = Readings(readings.markers, readings.positions @ turn.T, readings.joints)
        if fitted(other).plausibility > PLAUSIBLE:
            return f"the frame is {words}"
    return ""


def frame_nearer(fit: ArmFit, wanted: StandingArm) -> str:
    """Return in which other frame the arm would be where it was wanted, or nothing."""
    turn = wanted.about_axis_1(np.vstack([wanted.end, wanted.end + wanted.axis]), np.full(2, fit.arm.joint1))
    end, axis = turn[0], turn[1] - turn[0]

    def off(turn: FloatArray) -> float:
        return float(
            np.hypot(
                np.linalg.norm(turn @ fit.arm.end - end), 0.15 * np.linalg.norm(turn @ fit.arm.axis - axis)
            )
        )

    if float(fit.arm.axis @ axis) < 0.0 and np.linalg.norm(fit.arm.end - end) < _NEAR:
        return "axis 2 points the other way than was wanted: P3 and P4 seem to have each other's names"
    if off(np.eye(3)) > _FAR:
        for words, turn in _FRAMES.items():
            if off(turn) < min(_NEAR, 0.5 * off(np.eye(3))):
                near = f"{1e3 * off(turn):.0f} mm"
                return f"the frame is {words}: so seen, the arm is {near} from where it was wanted"
    return ""


def _mm(point: FloatArray) -> str:
    return "(" + ", ".join(f"{1e3 * value:.0f}" for value in point) + ") mm"
