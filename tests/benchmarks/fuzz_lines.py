"""Whether the lines of a summary are true: of targets, ways, the kind of shape, the link, what would help."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np
from fuzz_faults import Fault, wrongly_told
from fuzz_guide import link_faults

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from oracle import OracleArm

    from synth.task import Task

_NUMBER = r"(-?\d+\.?\d*)"
_SIGNED = r"([+-]\d+\.?\d*)"
_TARGET_LINE = (
    rf"(✓|✗) (.+?) +(reached|MISSED) +miss +{_NUMBER} of {_NUMBER} mm(, the default)? +"
    rf"joints +{_NUMBER}, +{_NUMBER} deg(?: +clear by {_NUMBER} mm( at least)?)?"
)
MOST_LINES, MOST_REASONS = 10, 5  # of targets and of ways; of reasons
_FARTHEST = 0.1  # m; a clearance is told no farther
_CLEARANCE_SLACK = 2e-5  # m: by so much a clearance may be told to be less than it is


class Told:
    """An answer, to hold lines against: what was asked, what the JSON says, the arm in the oracle's hands.

    Attributes:
        task: What was asked.
        content: The JSON of the solution.
        arm: The shape that it states, or None.
        names: Indices of the targets by their names.
    """

    def __init__(self, task: Task, content, arm: OracleArm | None) -> None:
        self.task, self.content, self.arm = task, content, arm
        self.names = {name: index for index, name in enumerate(task.table.names)}
        self.targets = {target["name"]: target for target in content["targets"]}
        if arm is not None:
            self.joints = np.array([target["joints"] for target in content["targets"]])
            self.misses = arm.misses(self.joints, task.table.positions)


def _target(told: Told, sign, name, word, miss, tolerance, default, theta1, theta2, clear, least):
    """Check the line of a target."""
    if name not in told.names:
        yield Fault("untrue", f"there is no target {name}")
        return
    index, target = told.names[name], told.targets[name]
    reached = target["within_tolerance"]
    if (sign, word) != (("✓", "reached") if reached else ("✗", "MISSED")):
        yield Fault("untrue", f"{name} is {word}, but within tolerance: {reached}")
    if reached and float(miss) > float(tolerance) + 1e-9:
        yield Fault("puzzling", f"{name} is {word}, with a miss of {miss} of {tolerance} mm")
    if bool(default) != (told.task.tolerances[index] == 1e-3):
        yield Fault("untrue", f"{name}: whether {tolerance} mm is the default")
    yield from wrongly_told(f"{name}: miss", miss, 1e3 * told.misses[index], "up")
    yield from wrongly_told(f"{name}: tolerance", tolerance, 1e3 * told.task.tolerances[index], "down")
    for number, angle in ((theta1, target["joints"][0]), (theta2, target["joints"][1])):
        yield from wrongly_told(f"{name}: joint", number, np.degrees(angle), "near")
    solids = [obstacle.solid for obstacle in told.task.obstacles]
    if bool(clear) != bool(solids):
        yield Fault("untrue", f"{name}: whether it is clear of {len(solids)} obstacles")
    elif clear:
        true = float(told.arm.clearances(told.joints[index], solids).min())
        short = 1e3 * (true - float(clear) * 1e-3)
        if short < -2e-3 or (not least and short > 0.1 + 1e3 * _CLEARANCE_SLACK * 5):
            yield Fault("untrue", f"{name}: clear by {clear} mm, it is {1e3 * true:.4f}")
        if bool(least) != (target["clearance"] >= _FARTHEST - 1e-9) or (
            least and float(clear) != 1e3 * _FARTHEST
        ):
            yield Fault("untrue", f"{name}: whether clear by {clear} mm at least")


def _way(told: Told, start, end, first, second, long, via):
    """Check a way: by how much the joints turn, whether the short way is closed, what is passed."""
    way = next((w for w in told.content["ways"] if (w["from"], w["to"]) == (start, end)), None)
    if way is None or not way["found"]:
        yield Fault("untrue", f"there is no way from {start} to {end}")
        return
    joints = np.array(way["joints"])
    what = f"{start} to {end}"
    for number, change in zip((first, second), np.degrees(joints[-1] - joints[0]), strict=True):
        yield from wrongly_told(what, number, change, "near")
    turn, limits = joints[-1, 0] - joints[0, 0], told.task.robot.joint_limits.base
    if bool(long) != (abs(turn) > np.pi):
        yield Fault("untrue", f"{what}: whether it is the long way round, by {np.degrees(turn):.3f} deg")
    short = joints[-1, 0] - np.sign(turn) * 2.0 * np.pi
    if long and limits.lower <= short <= limits.upper:
        yield Fault("untrue", f"{what}: the short way is not closed by the limits of joint 1")
    said = re.findall(rf"\({_NUMBER}, {_NUMBER}\)", via or "")
    if len(said) != len(joints) - 2:
        yield Fault("untrue", f"{what}: {len(joints) - 2} corners, said {via}")
    for pair, corner in zip(said, np.degrees(joints[1:-1]), strict=False):
        for number, angle in zip(pair, corner, strict=True):
            yield from wrongly_told(f"{what} by way of", number, angle, "near")


def _no_way(told: Told, start, end):
    if not any((w["from"], w["to"], w["found"]) == (start, end, False) for w in told.content["ways"]):
        yield Fault("untrue", f"there is a way from {start} to {end}")


def _kind(told: Told, own, own_number, own_unit, others):
    """Check the kind of shape: within the limits of its kind, and how far from the others."""
    off = told.arm.off_topology
    in_units = {
        "PUMA-like": (1e3 * off["puma"], "mm"),
        "SCARA": (np.degrees(off["scara"]), "deg"),
        "spherical": (1e3 * off["spherical"], "mm"),
    }
    limits = {"PUMA-like": 1.0, "SCARA": 0.1, "spherical": 1.0}
    if own_number:
        true, unit = in_units.pop(own)
        yield from wrongly_told(own, own_number, true, "up", 1e-4)
        if own_unit != unit or true > limits[own] + 1e-6:
            yield Fault("untrue", f"{own} to {own_number} {own_unit}; it is off by {true} {unit}")
    elif own != "general" or any(in_units[name][0] < limit for name, limit in limits.items()):
        yield Fault("untrue", f"kind of shape {own}: {in_units}")
    said = re.findall(rf"{_NUMBER} (mm|deg) from ([\w-]+)", others)
    if {name for _, _, name in said} != set(in_units):
        yield Fault("not judged", f"kinds: {others}")
        return
    for number, unit, name in said:
        yield from wrongly_told(f"from {name}", number, in_units[name][0], "near", 1e-4)
        if unit != in_units[name][1]:
            yield Fault("untrue", f"{name} in {unit}")


def _would_be_met(told: Told, number):
    yield from wrongly_told("tolerances that would be met", number, 1e3 * float(told.misses.max()), "up")
    solids = [obstacle.solid for obstacle in told.task.obstacles]
    for name, joints in zip(told.names, told.joints, strict=True):
        if told.arm.breaches_at(joints, told.task.floor_in_base, solids):
            yield Fault("untrue", f"tolerances of {number} mm would be met, but {name} is no place to be")


def _count_within(told: Told, within, count, _, most):
    true = sum(target["within_tolerance"] for target in told.content["targets"])
    if (int(within), int(count), int(most)) != (true, len(told.names), MOST_LINES):
        yield Fault("untrue", f"{within} of {count} are within, it is {true} of {len(told.names)}")


def _none_reached(told: Told, count):
    if told.arm is not None or int(count) != len(told.names):
        yield Fault("untrue", f"{count} targets asked for, and no shape")


def _more_reasons(told: Told, more):
    if int(more) != len(told.content["reasons"]) - MOST_REASONS:
        yield Fault("untrue", f"{more} more of {len(told.content['reasons'])} reasons")


def _shapes(told: Told, count, best):
    others = len(told.content["alternatives"])
    if int(count) != others + 1 or (best == "best") != (told.content["status"] == "found"):
        yield Fault("untrue", f"{count} shapes, the {best}: there are {others} others")


def _search(told: Told, seed, starts, time):
    content = told.content
    if (int(seed), int(starts)) != (content["seed"], content["starts"]):
        yield Fault("untrue", f"seed {seed}, {starts} starts")
    yield from wrongly_told("time", time, content["time"]["total"], "near")


def _all_ways(told: Told, count):
    if int(count) != len(told.content["ways"]):
        yield Fault("untrue", f"{count} ways in all")


SUMMARY_LINES: dict[str, Callable[..., Iterator[Fault]]] = {
    _TARGET_LINE: _target,
    rf"([\w ]+) to ([\w ]+): joint 1 by {_SIGNED} deg, joint 2 by {_SIGNED} deg"
    r"( \(the long way round: the short one is closed by the limits of joint 1\))?"
    r"(, by way of .* deg)?": _way,
    r"([\w ]+) to ([\w ]+): no way was found that keeps clear": _no_way,
    rf"kind of shape: ([\w-]+)(?: to {_NUMBER} (mm|deg))?; (.*)": _kind,
    rf"link {_NUMBER} mm long, smallest bend radius {_NUMBER} mm, {_NUMBER} deg of bend in all": link_faults,
    rf"link {_NUMBER} mm long, as good as straight()()": lambda told, length, *_: link_faults(
        told, length, None, None
    ),
    rf"tolerances of {_NUMBER} mm would be met by the nearest shape found": _would_be_met,
    r"(\d+) of (\d+) targets (is|are) within tolerance; the (\d+) worst:": _count_within,
    r"(\d+) targets? asked for, none reached: there is no shape": _none_reached,
    r"and (\d+) more of this kind": _more_reasons,
    r"(\d+) distinct shapes; this is shape 1, the (best|nearest) "
    r"\(--all lists them, --shape K shows another\)": _shapes,
    r"(\d+) ways from target to target in all: see solution\.json": _all_ways,
    rf"seed (\d+), (\d+) starts?, {_NUMBER} s": _search,
}
