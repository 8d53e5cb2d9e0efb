"""What is wrong with what is told of surfaces and paths, judged by the oracle at points of its own."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np
from fuzz_faults import Fault, wrongly_told
from fuzz_guide import GUIDE_LINES
from fuzz_lines import SUMMARY_LINES, Told
from oracle import SLACK, OracleArm
from scipy.spatial import cKDTree

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fuzz_drawn import FuzzTask

    from synth.task import Task

_NUMBER = r"(-?\d+\.?\d*)"
_COVERED = (
    rf"(✓|✗) (\w+): {_NUMBER} % of its (?:area|points) (?:is|are) within {_NUMBER} mm"
    rf"(?:, {_NUMBER} % is asked)?; it is missed(?: of the {_NUMBER} % covered best)? by {_NUMBER} mm RMS, "
    rf"{_NUMBER} mm for 95 %, {_NUMBER} mm at most(?:; what is not covered is about .*)?"
)
_BETWEEN = rf"(\w+): all of it is covered, between the samples, too: missed by {_NUMBER} mm at most"
_FOLLOWED = (
    rf"(✓|✗) (\w+): {_NUMBER} mm followed in one go; P5 strays by {_NUMBER} mm at most; joint 1 turns "
    rf"through {_NUMBER} deg, joint 2 through {_NUMBER} deg(?:; at {_NUMBER} mm/s they turn at up to "
    rf"{_NUMBER} and {_NUMBER} deg/s)?"
)
# Whose numbers are those of the JSON, or of nothing that the oracle knows.
_UNJUDGED = (
    r"\w+: all this holds for its points; between them nothing is known",
    rf"\w+: (?:all of it|{_NUMBER} % of its area for certain) is covered, between the samples, too: .*",
    r"\w+: its samples are covered, but between them .*",
    r"\w+: between its samples nothing is certain",
    r"(?:✓|✗) \w+: it is not followed in one go: .*",
    r"\w+ is no surface of revolution about axis 1, .*",
    r"\w+: \d+ points? of it would be reached, too, if .*",
    r"solving with --(?:why|prove) .*",
    r"more time may find a shape",
)
_NARROWED = {"samples": 361, "valleys": 4, "halvings": 32}  # of the oracle's search: to 1e-8 rad
_WAY_SLACK = 3e-5  # m: by so much a clearance on a way is known to the package
_SHARE = 0.03  # by which the share of an area may differ from that of the points of one's own


def judge_sampled(fuzz: FuzzTask, task: Task, content, text: str) -> list[Fault]:
    """Return the faults of an answer to a task with a surface or a path."""
    faults, status = [], content["status"]
    if fuzz.kind == "planted" and status != "found":
        faults.append(Fault("planted missed", content["message"]))
    if status == "failed":
        faults.append(Fault("failed", content["message"]))
    if not content["link"]:
        return faults
    arm, places = OracleArm.stated(task, content), {name: i for i, name in enumerate(task.table.names)}
    chosen = np.array([places[target["name"]] for target in content["targets"]])
    part = task.asking_for(task.table.take(chosen))
    faults += _of_targets(part, content, arm, partial=task.is_partial)
    found = status == "found"  # of paths nothing is told where their samples are missed
    for told, asked in zip(content["surfaces"] or [], task.surfaces, strict=found):
        faults += _of_surface(fuzz.fine[told["name"]], told, asked, arm, found=found)
    for told, asked in zip(content["paths"] or [], task.paths, strict=found):
        faults += _of_path(fuzz.fine[told["name"]], told, asked, arm, task)
    return [*faults, *faults_of_sampled_text(Told(part, content, arm), content, text)]


def _of_targets(part, content, arm: OracleArm, *, partial: bool) -> Iterator[Fault]:
    """Check the samples that are told of: their misses, and that the arm is legal where they are reached."""
    solids = [obstacle.solid for obstacle in part.obstacles]
    joints = np.array([target["joints"] for target in content["targets"]])
    for breach in arm.breaches_of_shape(part.floor_in_base):
        yield Fault("false found", f"{breach.limit} by {1e3 * breach.amount:.6f} mm or mrad")
    if not arm.is_topology(part.topology.value):
        yield Fault("false found", f"topology {part.topology.value}: off by {arm.off_topology}")
    misses = arm.misses(joints, part.table.positions)
    least = arm.misses(arm.closest(part.table.positions, **_NARROWED), part.table.positions)
    for i, target in enumerate(content["targets"]):
        if abs(misses[i] - target["miss"]) > 2.0 * SLACK:
            yield Fault("misstated", f"{target['name']} misses by {misses[i]}, said {target['miss']}")
        if target["within_tolerance"] != (misses[i] <= target["tolerance"]) and not solids:
            yield Fault("misstated", f"{target['name']}: within tolerance {target['within_tolerance']}")
        breaches = arm.breaches_at(joints[i], part.floor_in_base, solids)
        if target["within_tolerance"] and breaches:
            yield Fault("false found", f"{target['name']}: {breaches[0].limit} by {breaches[0].amount}")
        if not breaches and not solids and not partial and target["miss"] > least[i] + 1e-5:
            yield Fault("not the closest", f"{target['name']}: {least[i]} is possible, said {target['miss']}")


def _of_surface(fine, told, asked, arm: OracleArm, *, found: bool) -> Iterator[Fault]:
    """Check what is told of a surface, at points all over it."""
    misses = arm.misses(arm.closest(fine, **_NARROWED), fine)
    share, between = float(np.mean(misses <= asked.tolerance)), told["between"]
    scan = not asked.samples.are_joined
    if told["share"] > share + (1e-9 if scan else _SHARE):
        yield Fault("misstated", f"{share} of {told['name']} is within tolerance, said {told['share']}")
    if found and share < asked.coverage - (1e-9 if scan else _SHARE):
        yield Fault("false found", f"{share} of {told['name']} is within tolerance, asked {asked.coverage}")
    if found and asked.coverage == 1.0 and misses.max() > asked.tolerance + SLACK:
        yield Fault("false found", f"{told['name']} is missed by {misses.max()} of {asked.tolerance}")
    if between and asked.coverage == 1.0 and (between["largest"] or np.inf) < misses.max() - SLACK:
        yield Fault("false bound", f"{told['name']} is missed by {misses.max()}, said {between['largest']}")
    if found and not scan and (not between or between["share"] < asked.coverage - 1e-6):
        yield Fault("false found", f"{told['name']} is not proven between its samples: {between}")


def _of_path(fine, told, asked, arm: OracleArm, task) -> Iterator[Fault]:
    """Follow the joint angles that are told, with the oracle, and see whether all of the path is passed."""
    if not told["followed"]:
        return
    joints, solids = np.array(told["joints"]), [obstacle.solid for obstacle in task.obstacles]
    share = np.linspace(0.0, 1.0, 8)[:, None, None]
    passed = arm.reached((joints[:-1] + share * np.diff(joints, axis=0)).reshape(-1, 2))
    # A way between points of the path is no farther off than they lie apart.
    curve = asked.at(np.linspace(0.0, asked.ends[-1], 50_001))
    off = float(cKDTree(curve).query(passed)[0].max())
    if off > told["largest"] + 1e-5 or told["largest"] > asked.tolerance:
        yield Fault("false found", f"{told['name']} is left by {off}, said {told['largest']}")
    gaps = np.linalg.norm(np.diff(passed.reshape(8, -1, 3), axis=0), axis=-1).max()
    missed = float(cKDTree(passed).query(fine)[0].max())
    if missed > asked.tolerance + gaps:
        yield Fault("false found", f"a point of {told['name']} is never nearer than {missed}")
    for posture in joints[:: max(len(joints) // 30, 1)]:
        for breach in arm.breaches_at(posture, task.floor_in_base, solids):
            if breach.amount > _WAY_SLACK:
                yield Fault("false found", f"{told['name']}: {breach.limit} by {breach.amount}")


def faults_of_sampled_text(told: Told, content, text: str) -> Iterator[Fault]:
    """Check the lines of the text: each must be one that is known, every number that the JSON has right."""
    surfaces = {each["name"]: each for each in content["surfaces"] or []}
    paths = {each["name"]: each for each in content["paths"] or []}
    patterns = SUMMARY_LINES | (GUIDE_LINES if content["status"] == "found" else {})
    for line in filter(None, text.split("\n")[2:]):
        bare = line.removeprefix("• ")
        if bare in content["reasons"] or bare in content["notes"]:
            continue
        if match := re.fullmatch(_COVERED, bare):
            yield from _covered(surfaces[match[2]], *match.groups())
        elif match := re.fullmatch(_BETWEEN, bare):
            largest = surfaces[match[1]]["between"]["largest"]
            yield from wrongly_told(bare, match[2], 1e3 * largest, "up")
        elif match := re.fullmatch(_FOLLOWED, bare):
            yield from _followed(paths[match[2]], *match.groups())
        elif not any(re.fullmatch(words, bare) for words in _UNJUDGED):
            found = [(judge, m) for words, judge in patterns.items() if (m := re.fullmatch(words, bare))]
            if not found:
                yield Fault("not judged", f"a line: {bare}")
            elif not bare.startswith(("tolerances of", "✓", "✗")):
                yield from found[0][0](told, *found[0][1].groups())


def _covered(surface, sign, _, share, within, asked, best, rms, most, largest) -> Iterator[Fault]:
    name = surface["name"]
    yield from wrongly_told(f"{name}: covered", share, 1e2 * surface["share"], "down", 1e-4)
    for number in filter(None, (asked, best)):
        yield from wrongly_told(f"{name}: asked", number, 1e2 * surface["coverage"], "down", 1e-4)
    for number, key in ((rms, "rms"), (most, "percentile_95"), (largest, "largest")):
        yield from wrongly_told(f"{name}: {key}", number, 1e3 * surface[key], "up")
    if (sign == "✓") != surface["covered"]:
        yield Fault("untrue", f"{name}: {sign}, but covered {surface['covered']}")
    if sign == "✓" and float(largest) > float(within) + 1e-9:
        yield Fault("puzzling", f"{name} is covered within {within} mm, but missed by {largest} mm")


def _followed(path, sign, name, length, most, first, second, speed, *rates) -> Iterator[Fault]:
    if (sign == "✓") != path["followed"]:
        yield Fault("untrue", f"{name}: {sign}, but followed {path['followed']}")
    yield from wrongly_told(f"{name}: strays", most, 1e3 * path["largest"], "up")
    yield from wrongly_told(f"{name}: long", length, 1e3 * path["lengths"][-1], "near")
    for number, turn in zip((first, second), np.degrees(np.ptp(path["joints"], axis=0)), strict=True):
        yield from wrongly_told(f"{name}: turns", number, turn, "near")
    if speed:
        turned = np.abs(np.diff(path["joints"], axis=0)) / np.diff(path["times"])[:, None]
        for number, rate in zip(rates, np.degrees(turned.max(axis=0)), strict=True):
            yield from wrongly_told(f"{name}: deg/s", number, rate, "near")
