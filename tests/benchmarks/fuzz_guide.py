"""Whether what a person is told to do is right: the steps, the table of points, and how precise to be."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np
from fuzz_faults import Fault, wrongly_told
from oracle import turned

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

_NUMBER = r"(-?\d+\.?\d*)"
_HAND = r"a hand as published \(9\.6 ± 2\.1 mm, 4 ± 1\.2 deg\) meets every target in"
_THEN = rf"joints recomputed from the measured arm; expect a worst miss of {_NUMBER} mm"
_SO = r"\. So measure, and correct until it is right\."
_CLEAR_SLACK = 3e-5  # m: by so much a clearance is known to the package


def _little_chance(told, miss):
    if told.content["guide"]["forgiveness"]["chance"] >= 0.02:
        yield Fault("untrue", "less than 2 % of tries")
    yield from _expected(told, miss)


def _chance(told, share, miss):
    chance = told.content["guide"]["forgiveness"]["chance"]
    if share != "99" or chance < 0.99:
        yield from wrongly_told("chance", share, 1e2 * chance, "down")
    yield from _expected(told, miss)


def _expected(told, miss):
    expected = told.content["guide"]["forgiveness"]["expected_worst_miss"]
    yield from wrongly_told("expected worst miss", miss, 1e3 * expected, "up")


def _base(told, x, y, z, yaw):
    for number, true in zip((x, y, z), 1e3 * np.array(told.task.base.position), strict=True):
        yield from wrongly_told("the base stands", number, true, "near")
    yield from wrongly_told("turned by", yaw, np.degrees(told.task.base.yaw), "near")


def _cut(told, d35, d45):
    yield from wrongly_told("d35", d35, 1e3 * told.arm.d35, "near")
    yield from wrongly_told("d45", d45, 1e3 * told.arm.d45, "near")
    if told.task.robot.rigid_link.is_fixed:
        yield Fault("untrue", "to be cut, but the rigid link is fixed")


def _take(told, name, d35, d45):
    """Check the choice from a catalogue: one of its rigid links, by its name and its lengths."""
    for number, true in ((d35, told.arm.d35), (d45, told.arm.d45)):
        yield from wrongly_told(f"of {name}", number, 1e3 * true, "near")
    known = told.task.robot.rigid_links
    names = dict(zip(known.names, known.links, strict=True)) if known else {}
    if name not in names or abs(names[name].d35.lower - told.arm.d35) > 1e-6:
        yield Fault("untrue", f"{name} is not the rigid link of the shape")


def _hold(told, first, second, not_clear):
    """Check the posture to hold: angles that the joints can take as they are printed, clear of everything."""
    hold, limits = told.content["guide"]["hold"], told.task.robot.joint_limits
    joints = np.array([hold["joint1"], hold["joint2"]])
    for number, angle, interval in zip((first, second), joints, (limits.base, limits.second), strict=True):
        yield from wrongly_told("hold joint", number, np.degrees(angle), "near")
        if not np.degrees(interval.lower) - 1e-6 <= float(number) <= np.degrees(interval.upper) + 1e-6:
            yield Fault(
                "untrue", f"hold at {number} deg: limits {np.degrees([interval.lower, interval.upper])}"
            )
    solids = [obstacle.solid for obstacle in told.task.obstacles]
    breaches = told.arm.breaches_at(joints, told.task.floor_in_base, solids)
    if not not_clear and any(breach.amount > _CLEAR_SLACK for breach in breaches):
        yield Fault("untrue", f"the posture to hold is not clear: {breaches}")


def link_faults(told, length, radius, bend):
    """Check the numbers of the link; as good as straight is what bends less than a hand can tell."""
    yield from wrongly_told("link long", length, 1e3 * told.arm.length, "near")
    true = 1e3 / max(float(told.arm.bends.max()), 1e-12)
    if radius is None:
        if true < 1e5:
            yield Fault("untrue", f"as good as straight, but a bend radius of {true} mm")
        return
    yield from wrongly_told("smallest bend radius", radius, true, "down")
    yield from wrongly_told("bend in all", bend, np.degrees(told.arm.total_bend), "near")


def _soften(told, length, radius, bend, limit, name, along):
    yield from link_faults(told, length, radius, bend)
    yield from wrongly_told("no tighter than", limit, 1e3 * told.task.robot.link.min_bend_radius, "up")
    stations = {point["name"]: point["arc_length"] for point in told.content["guide"]["centreline"]}
    if name is None and len(stations) > 1:
        yield Fault("untrue", f"END is no point alone: {stations}")
    elif name is not None and abs(1e3 * stations.get(name, np.inf) - float(along)) > 0.5:
        yield Fault("untrue", f"{name} is no point of the table, {along} mm along")


def _soften_straight(told, length, *others):
    yield from _soften(told, length, None, None, *others)


def _held(told):
    """Return P1 to P4, the link's end and the direction of axis 2, held as told, in the task frame."""
    arm, angle = told.arm, told.content["guide"]["hold"]["joint1"]
    points = arm.to_task(turned(np.vstack([arm.axis_points, arm.end[1]]), angle))
    return points, turned(turned(arm.end[0][:, 0], angle), arm.yaw)


def _axis(told, elevation, side, heading, distances):
    points, u = _held(told)
    true = np.degrees(np.arctan2(u[2], np.hypot(u[0], u[1])))
    said = f"-{elevation}" if side == "below" else elevation
    yield from wrongly_told("elevation of axis 2", said, true, "near")
    heading_true = np.degrees(np.arctan2(u[1], u[0]))
    if abs((float(heading) - heading_true + 180.0) % 360.0 - 180.0) > 0.05 + 1e-5 / np.hypot(u[0], u[1]):
        yield Fault("untrue", f"heading {heading}, it is {heading_true}")
    yield from _by_tape(points, distances)


def _upright(told, side, distances):
    points, u = _held(told)
    if np.hypot(u[0], u[1]) > 1e-8 or (u[2] > 0.0) != (side == "above"):
        yield Fault("untrue", f"axis 2 is vertical, P4 {side} P3; it is {u}")
    yield from _by_tape(points, distances)


def _by_tape(points, distances):
    said = re.findall(rf"d(\d)(\d) {_NUMBER}", distances)
    if len(said) != 4:
        yield Fault("not judged", f"by tape: {distances}")
    for i, j, number in said:
        true = 1e3 * np.linalg.norm(points[int(i) - 1] - points[int(j) - 1])
        yield from wrongly_told(f"d{i}{j} by tape", number, true, "near")


def _precise(told, place, first, tilt, second, across):
    tolerance = told.content["guide"]["tolerance"]
    yield from wrongly_told("hold axis 2 within", place, 1e3 * tolerance["position"], "down")
    yield from wrongly_told("hold axis 2 within", tilt, np.degrees(tolerance["direction"]), "down")
    chord = 2e3 * told.task.robot.d34 * np.sin(0.5 * tolerance["direction"])
    yield from wrongly_told("P3 off against P4", across, chord, "down")
    if (first, second) != (tolerance["position_target"], tolerance["direction_target"]):
        yield Fault("untrue", f"lost first: {first}, {second}")


def _precise_in_place(told, place, first, tilt):
    tolerance = told.content["guide"]["tolerance"]
    yield from wrongly_told("hold axis 2 within", place, 1e3 * tolerance["position"], "down")
    yield from wrongly_told("its direction matters little", tilt, np.degrees(tolerance["direction"]), "down")
    if first != tolerance["position_target"]:
        yield Fault("untrue", f"lost first: {first}")


def _table(told, spacing=None):
    stations = np.array([point["arc_length"] for point in told.content["guide"]["centreline"]])
    wanted = 50.0 if spacing is None else float(spacing)
    if len(stations) > 1 and np.abs(np.diff(stations[:-1], prepend=0.0) - 1e-3 * wanted).max() > 1e-9:
        yield Fault("untrue", f"points on the link every {wanted} mm: {stations}")


def _point(told, name, *numbers):
    points, _ = _held(told)
    known = dict(zip(("P1", "P2", "P3", "P4"), points, strict=False))
    if name not in known:
        stations = {point["name"]: point["arc_length"] for point in told.content["guide"]["centreline"]}
        if name not in stations or (name != "END" and abs(float(name[1:]) - 1e3 * stations[name]) > 0.5):
            yield Fault("untrue", f"there is no point {name}")
            return
        local = told.arm.centreline(np.array([stations[name]]))[0]
        known[name] = told.arm.to_task(turned(local, told.content["guide"]["hold"]["joint1"]))
    for number, true in zip(numbers, 1e3 * known[name], strict=True):
        yield from wrongly_told(f"point {name}", number, true, "near")


def _nothing(_):
    return iter(())


_ANY_LINK = rf"link {_NUMBER} mm long, smallest bend radius {_NUMBER} mm, {_NUMBER} deg of bend in all"
_STRAIGHT = rf"link {_NUMBER} mm long, as good as straight"
_BENT = (
    rf"\. Bend it nowhere tighter than to a radius of {_NUMBER} mm\. P3 and P4 come to their places; "
    r"(?:(L\d+) is the middle of the tube, (\d+) mm along from P2, END its end|"
    r"END is the end of the tube, in its middle)\."
)
_STEP = r"\d+\. "
_XYZ = rf"\({_NUMBER}, {_NUMBER}, {_NUMBER}\)"
_WITHIN = rf"{_STEP}Hold axis 2 within {_NUMBER} mm \(([\w ]+)\)"
_TAPE = r"By tape: (.*) mm\."
GUIDE_LINES: dict[str, Callable[..., Iterator[Fault]]] = {
    rf"No hand holds this at the first try: {_HAND} less than 2 % of tries, {_THEN}{_SO}": _little_chance,
    rf"At the first try {_HAND} about (\d+) % of tries, {_THEN}{_SO}": _chance,
    rf"{_STEP}The base stands with P1 at {_XYZ} mm, turned by {_NUMBER} deg\.": _base,
    rf"{_STEP}Cut the rigid link to d35 = {_NUMBER} mm and d45 = {_NUMBER} mm, from P3 and P4 to P5\.": _cut,
    rf"{_STEP}Of the rigid links take (.+): d35 = {_NUMBER} mm and d45 = {_NUMBER} mm, "
    r"from P3 and P4 to P5\.": _take,
    rf"{_STEP}Set joint 1 to {_NUMBER} deg and hold it there, joint 2 at {_NUMBER} deg\."
    r"( No posture was found in which the bent arm is clear of everything: make room for it\.)?": _hold,
    rf"{_STEP}Soften the link and shape it: {_ANY_LINK}{_BENT}": _soften,
    rf"{_STEP}Soften the link and shape it: {_STRAIGHT}{_BENT}": _soften_straight,
    rf"{_STEP}Axis 2 runs through END, P3 and P4: from P3 to P4 {_NUMBER} deg (above|below) horizontal, "
    rf"heading {_NUMBER} deg \(from x towards y\)\. {_TAPE}": _axis,
    rf"{_STEP}Axis 2 runs through END, P3 and P4 and is vertical, P4 (above|below) P3\. {_TAPE}": _upright,
    rf"{_WITHIN} and {_NUMBER} deg \(([\w ]+)\); within half of each if both "
    rf"are off\. P3 off against P4 by {_NUMBER} mm across the axis is such a tilt\.": _precise,
    rf"{_WITHIN}; its direction matters little: a tilt of {_NUMBER} deg "
    r"alone loses no target\.": _precise_in_place,
    r"Points in the task frame, mm:": _table,
    r"Points in the task frame, mm, on the link every (\d+) mm:": _table,
    r" +x +y +z": _nothing,
    rf"(P\d|L\d+|END) +{_NUMBER} +{_NUMBER} +{_NUMBER}": _point,
}
