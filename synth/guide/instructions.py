"""What the operator is told to do, for a task that is met: sentences for the terminal and the sheet.

Lengths in millimetres, angles in degrees, in the task frame. Nothing here is said of a task that is missed.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from synth.guide.sensitivity import LARGEST_TILT
from synth.rounding import Unit, rounded_down, rounded_up

if TYPE_CHECKING:
    from synth.guide.markers import Guide

_MOST_DIGITS = 6
_EXAMPLE = 0.1  # m along the link: a point that tells what the others are


def instructions(guide: Guide) -> tuple[str, ...]:
    """Return the steps of bending the link, each a sentence or a few.

    Args:
        guide: The guide to a shape that meets its task.
    """
    steps = [] if guide.cut is None else [rigid_link_sentence(*guide.cut, guide.rigid_link)]
    limit = rounded_up(guide.arm.robot.link.min_bend_radius)
    shape = (
        f"Soften the link and shape it: {guide.link.describe()}. "
        f"Bend it nowhere tighter than to a radius of {limit} mm. "
        f"P3 and P4 come to their places; {station_sentence(guide)}"
    )
    return (
        *steps,
        hold_sentence(guide),
        shape,
        f"{axis_sentence(guide)} {distances_sentence(guide)}",
        " ".join(tolerance_sentences(guide)),
        *([] if guide.forgiveness is None else [guide.forgiveness.describe()]),
    )


def station_sentence(guide: Guide) -> str:
    """Return what the points on the link are, by the one nearest to 100 mm from P2 that the table has."""
    if len(guide.stations) < 2:
        return "END is the end of the tube, in its middle."
    index = int(np.argmin(np.abs(guide.stations[:-1] - _EXAMPLE)))
    name, along = guide.station_names[index], 1e3 * guide.stations[index]
    return f"{name} is the middle of the tube, {along:.0f} mm along from P2, END its end."


def rigid_link_sentence(d35: float, d45: float, name: str) -> str:
    """Return which rigid link of a catalogue is to be taken, or to what it is to be cut without one."""
    lengths = f"d35 = {1e3 * d35:.1f} mm and d45 = {1e3 * d45:.1f} mm, from P3 and P4 to P5"
    return f"Of the rigid links take {name}: {lengths}." if name else f"Cut the rigid link to {lengths}."


def base_sentence(guide: Guide) -> str:
    """Return where the robot stands; where that was chosen, as what to do, and how precisely."""
    base, place = guide.arm.base, guide.place
    x, y, z = 1e3 * base.position
    digits = 1 if place is None else 2
    roll, pitch, yaw = (math.degrees(angle) for angle in (base.roll, base.pitch, base.yaw))
    turned = f"turned by {yaw:z.{digits}f} deg"
    if base.roll or base.pitch:
        turned = f"roll, pitch, yaw {roll:z.{digits}f}, {pitch:z.{digits}f}, {yaw:z.{digits}f} deg"
    where = f"with P1 at ({x:z.1f}, {y:z.1f}, {z:z.1f}) mm, {turned}"
    if place is None:
        return f"The base stands {where}."
    at = f"at {place.name}, " if place.name else ""
    off = f"{rounded_down(place.position, digits=2)} mm"
    by = f"{rounded_down(place.turn, Unit.DEG, 2)} deg"
    return f"Place the base {at}{where}; it may be {off} or {by} off if nothing else is."


def hold_sentence(guide: Guide) -> str:
    """Return what to do with the joints while the link is bent."""
    first, second = math.degrees(guide.posture.joint1), math.degrees(guide.posture.joint2)
    sentence = f"Set joint 1 to {first:z.1f} deg and hold it there, joint 2 at {second:z.1f} deg."
    if not guide.posture.clear:
        sentence += " No posture was found in which the bent arm is clear of everything: make room for it."
    return sentence


def axis_sentence(guide: Guide) -> str:
    """Return how axis 2 lies at the hold angle, as an elevation and a heading."""
    elevation, heading = math.degrees(guide.hold.elevation), guide.hold.heading
    if math.isnan(heading):
        side = "above" if elevation > 0.0 else "below"
        return f"Axis 2 runs through END, P3 and P4 and is vertical, P4 {side} P3."
    side = "below" if f"{elevation:z.1f}".startswith("-") else "above"
    turn = math.degrees(heading)
    return (
        f"Axis 2 runs through END, P3 and P4: from P3 to P4 {abs(elevation):.1f} deg {side} horizontal, "
        f"heading {turn:z.1f} deg (from x towards y)."
    )


def distances_sentence(guide: Guide) -> str:
    """Return the distances between the markers, for a tape."""
    told = ", ".join(f"{name} {1e3 * value:.1f}" for name, value in guide.marker_distances.items())
    return f"By tape: {told} mm."


def tolerance_sentences(guide: Guide) -> tuple[str, ...]:
    """Return how precisely the shape must be held, as sentences; none for a task that is not met."""
    tolerance = guide.tolerance
    if math.isnan(tolerance.position):
        return ()
    shift = f"Hold axis 2 within {_kept(tolerance.position, Unit.MM)} mm ({tolerance.position_target})"
    tilt = _kept(tolerance.direction, Unit.DEG)
    if tolerance.direction >= LARGEST_TILT:
        return (f"{shift}; its direction matters little: a tilt of {tilt} deg alone loses no target.",)
    d34 = guide.arm.robot.d34
    marker = _kept(2.0 * d34 * math.sin(0.5 * tolerance.direction), Unit.MM)
    return (
        f"{shift} and {tilt} deg ({tolerance.direction_target}); within half of each if both are off.",
        f"P3 off against P4 by {marker} mm across the axis is such a tilt.",
    )


def _kept(value: float, unit: Unit) -> str:
    """Return a tolerance to keep, rounded down, with two decimals or as many as it takes not to be zero."""
    told = [rounded_down(value, unit, digits) for digits in range(2, _MOST_DIGITS)]
    return next((each for each in told if float(each) > 0.0), told[-1])
