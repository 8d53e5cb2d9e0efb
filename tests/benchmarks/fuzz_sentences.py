"""Whether what the terminal shows is true: every line must be one that is known, every number in it right.

A line that is worded anew is a fault until it is read anew here, or it would pass unread.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np
from fuzz_faults import Fault, wrongly_told
from fuzz_guide import GUIDE_LINES, faults_of_errors, link_faults

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
_STATUSES = {
    "every target is within its tolerance": "found",
    "no shape was found that reaches every target": "best_effort",
    "no shape of this robot can do the task": "proven_impossible",
    "stopped before the search was complete": "limit",
    "the solver broke down": "failed",
}
_OF_NEAREST = "; what follows is of the nearest shape found"
_MOST_LINES, _MOST_REASONS = 10, 5  # of targets and of ways; of reasons
_FARTHEST = 0.1  # m; a clearance is told no farther
_CLEARANCE_SLACK = 2e-5  # m: by so much a clearance may be told to be less than it is
_FIXED_LINES = (
    r"solving with --(why|prove) .*",
    r"more time may find a shape",
)


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


def faults_of_text(told: Told, text: str) -> Iterator[Fault]:
    """Check the message of the JSON, the text line by line, and by trial what is told of errors."""
    yield from faults_of_lines(told, text)
    if told.content["status"] == "found":
        yield from faults_of_errors(told)


def faults_of_lines(told: Told, text: str) -> Iterator[Fault]:
    """Check the message of the JSON, and the text line by line."""
    content = told.content
    if re.search(r"\bnan\b|\binf\b", content["message"] + text):
        yield Fault("untrue", "a number is nan or inf")
    yield from _message(told)
    headline, _, *lines = text.split("\n")
    yield from _headline(told, headline)
    patterns = _LINES | (GUIDE_LINES if content["status"] == "found" else {})
    for line in filter(None, lines):
        bare = line.removeprefix("• ")
        if bare in content["reasons"] or bare in content["notes"]:
            continue
        found = [(judge, match) for words, judge in patterns.items() if (match := re.fullmatch(words, bare))]
        if found:
            judge, match = found[0]
            yield from judge(told, *match.groups())
        elif not any(re.fullmatch(words, bare) for words in _FIXED_LINES):
            yield Fault("not judged", f"a line: {bare}")
    yield from _are_all_there(told, text)


def _message(told: Told) -> Iterator[Fault]:
    """Check the JSON's message: its status, the three worst misses, the reasons."""
    content, message = told.content, told.content["message"]
    for name, number in re.findall(rf"(?:: |; )(\w+) misses by {_NUMBER} mm", message):
        yield from wrongly_told(message, number, 1e3 * told.misses[told.names[name]], "up")
    if content["status"] != "found" and told.arm is not None:
        missed = sum(not target["within_tolerance"] for target in content["targets"])
        worst = len(re.findall(r"(?:: |; )\w+ misses by \d", message))
        more = sum(map(int, re.findall(r"; and (\d+) more(?:$|; )", message)))
        if missed != worst + more:
            yield Fault("untrue", f"{missed} targets are missed: {message}")
    if content["status"] == "found" and len(content["ways"]) == sum(way["found"] for way in content["ways"]):
        if message != "every target is within its tolerance":
            yield Fault("not judged", f"a message: {message}")
    elif not message.endswith("; ".join(content["reasons"])):
        yield Fault("untrue", f"the message leaves out a reason: {message}")


def _headline(told: Told, headline: str) -> Iterator[Fault]:
    """Check the first line: the sign, the task's name, and how it ended."""
    content, task = told.content, told.task
    sign, words = headline[0], headline[2:].removeprefix(f"{task.name}: ")
    if sign != ("✓" if content["status"] == "found" else "✗") or not content["message"].startswith(words):
        yield Fault("untrue", f"{content['status']}, but: {headline}")
    missing = [f"{way['from']} to {way['to']}" for way in content["ways"] or [] if not way["found"]]
    if content["status"] == "found" and missing:
        said = re.findall(r"no way was found from (\w+ to \w+)", words)
        more = sum(map(int, re.findall(r"and (\d+) more", words)))
        if said != missing[: len(said)] or len(said) + more != len(missing):
            yield Fault("untrue", f"no ways for {missing}, but: {words}")
    elif _STATUSES.get(words.removesuffix(_OF_NEAREST)) != content["status"]:
        yield Fault("not judged", f"a headline: {headline}")
    if words.endswith(_OF_NEAREST) != (content["status"] != "found" and told.arm is not None):
        yield Fault("untrue", f"of a nearest shape: {headline}")


def _are_all_there(told: Told, text: str) -> Iterator[Fault]:
    """Check that nothing is left out, and that nobody is told to bend a shape that misses."""
    content, count = told.content, len(told.names)
    lines = len(re.findall(r"^[✓✗] .* miss ", text, re.MULTILINE))
    if lines != (min(count, _MOST_LINES) if told.arm is not None else 0):
        yield Fault("not judged", f"{lines} lines of {count} targets are read")
    if content["status"] == "found":
        wanted = ["Set joint 1 to", "Hold axis 2 within", "kind of shape:", "as published", "By tape:"]
        wanted += [f"{way['from']} to {way['to']}: " for way in content["ways"][:_MOST_LINES]]
        for words in wanted:
            if words not in text:
                yield Fault("untrue", f"it is not told: {words}")
    else:
        for words in ("Hold axis 2 within", "Set joint 1 to", "Soften", "as published"):
            if words in text:
                yield Fault("instructions", f"a task that is not met is told: {words} ...")


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
        if told.arm.breaches_at(joints, told.task.floor, solids):
            yield Fault("untrue", f"tolerances of {number} mm would be met, but {name} is no place to be")


def _count_within(told: Told, within, count, _, most):
    true = sum(target["within_tolerance"] for target in told.content["targets"])
    if (int(within), int(count), int(most)) != (true, len(told.names), _MOST_LINES):
        yield Fault("untrue", f"{within} of {count} are within, it is {true} of {len(told.names)}")


def _none_reached(told: Told, count):
    if told.arm is not None or int(count) != len(told.names):
        yield Fault("untrue", f"{count} targets asked for, and no shape")


def _more_reasons(told: Told, more):
    if int(more) != len(told.content["reasons"]) - _MOST_REASONS:
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


_LINES: dict[str, Callable[..., Iterator[Fault]]] = {
    _TARGET_LINE: _target,
    rf"(\w+) to (\w+): joint 1 by {_SIGNED} deg, joint 2 by {_SIGNED} deg"
    r"( \(the long way round: the short one is closed by the limits of joint 1\))?"
    r"(, by way of .* deg)?": _way,
    r"(\w+) to (\w+): no way was found that keeps clear": _no_way,
    rf"kind of shape: ([\w-]+)(?: to {_NUMBER} (mm|deg))?; (.*)": _kind,
    rf"link {_NUMBER} mm long, smallest bend radius {_NUMBER} mm, {_NUMBER} deg of bend in all": link_faults,
    rf"link {_NUMBER} mm long, as good as straight()()": lambda told, length, *_: _link(
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
