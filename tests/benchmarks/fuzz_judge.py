"""What is wrong with an answer, judged by the oracle: claims, proofs and the sentences that are printed."""

from __future__ import annotations

import re
import sys
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.optimize import least_squares

sys.path.insert(0, str(Path(__file__).parents[1]))

from fuzz_tasks import FuzzTask, random_arm
from oracle import SLACK, OracleArm, distance_from_solid, longest_rod

if TYPE_CHECKING:
    from synth.task import Task

_ROUNDED = 0.5000001  # of the last digit that is printed
_WAY_SLACK = 3e-5  # m: by so much a clearance on a way is known to the package
_MOST_LINES = 10  # of targets, in the summary
_NUMBER = r"(-?\d+\.?\d*)"
_OUT_OF_REACH = rf"(\w+) is {_NUMBER} mm from wherever .* at most {_NUMBER} mm .* at least {_NUMBER} mm"
_TARGET_LINE = (
    rf"(\w+) +(reached|MISSED) +miss +{_NUMBER} of {_NUMBER} mm +"
    rf"joints +{_NUMBER}, +{_NUMBER} deg(?: +clear by {_NUMBER} mm)?"
)


class Fault(NamedTuple):
    """What is wrong: a kind, by which faults are counted, and a sentence."""

    kind: str
    sentence: str


def arm_found(task: Task, content) -> OracleArm | None:
    return OracleArm.stated(task, content) if content["link"] else None


def judge(fuzz: FuzzTask, task: Task, content, text: str) -> list[Fault]:
    """Return the faults of an answer: the JSON of a solution, and the text that the terminal shows."""
    faults, status = [], content["status"]
    arm = arm_found(task, content)
    faults += [fault for each in (_found, _impossible) for fault in each(fuzz, task, content, arm)]
    if arm is not None:
        faults += _numbers(task, content, arm)
        faults += _ways(task, content, arm)
    faults += _sentences(fuzz, task, content, arm, text)
    if fuzz.kind == "planted" and status != "found":
        faults.append(Fault("planted missed", content["message"]))
    if status == "failed":
        faults.append(Fault("failed", content["message"]))
    return faults


def broken(task: Task, arm: OracleArm, joints, *, which=None) -> list[str]:
    """Return the limits that an arm breaks in itself and at the targets, as sentences."""
    solids = [obstacle.solid for obstacle in task.obstacles]
    told = [f"{b.limit} by {1e3 * b.amount:.6f} mm or mrad" for b in arm.breaches_of_shape(task.floor)]
    if not arm.is_topology(task.topology.value):
        told.append(f"topology {task.topology.value}: off by {arm.off_topology}")
    for index in range(len(joints)) if which is None else which:
        told += [
            f"{task.table.names[index]}: {b.limit} by {1e3 * b.amount:.6f} mm or mrad"
            for b in arm.breaches_at(joints[index], task.floor, solids)
        ]
    return told


def _found(_, task, content, arm):
    """Check what `found` claims."""
    if content["status"] != "found":
        if content["targets"] and all(target["within_tolerance"] for target in content["targets"]):
            yield Fault("not found though all are within", content["message"])
        return
    joints = np.array([target["joints"] for target in content["targets"]])
    misses = arm.misses(joints, task.table.positions)
    for index in np.flatnonzero(~(misses <= task.tolerances + SLACK)):
        excess = 1e3 * (misses[index] - task.tolerances[index])
        yield Fault("false found", f"{task.table.names[index]} is {excess:.6f} mm beyond its tolerance")
    for sentence in broken(task, arm, joints):
        yield Fault("false found", sentence)


def _impossible(fuzz, task, content, _):
    """Check a proof: what was planted is possible, and so is what a search of the oracle's own finds."""
    if content["status"] != "proven_impossible":
        return
    if fuzz.kind == "planted":
        yield Fault("false proof", content["message"])
    elif fuzz.kind == "wild" and (found := searched(task, seed=fuzz.number)) is not None:
        yield Fault(
            "false proof", f"{content['message']}; but arcs {found.curvatures}, {found.lengths} do it"
        )


def searched(task: Task, seed: int, shapes: int = 200, polished: int = 3):
    """Return a shape that meets a task, by least squares from random shapes, or None if none is found."""
    rng = np.random.default_rng([seed, 5])
    robot, targets = task.robot, task.table.positions

    def cost(arm, halvings):
        return (
            arm.misses(arm.closest(targets, samples=91, valleys=1, halvings=halvings), targets)
            / task.tolerances
        )

    arms = [random_arm(task, rng) for _ in range(shapes)]
    arms.sort(key=lambda arm: float(np.sum(np.minimum(cost(arm, 0), 1e6) ** 2)))
    for arm in arms[:polished]:
        count = len(arm.lengths)

        def bent(x, arm=arm, count=count):
            limit = 1.0 / robot.link.min_bend_radius
            curvatures = x[: 2 * count].reshape(-1, 2)
            size = np.linalg.norm(curvatures, axis=1, keepdims=True)
            curvatures = curvatures / np.maximum(size / limit, 1.0)
            length = np.clip(x[-3], robot.link.length.lower, robot.link.length.upper)
            d35, d45 = (
                np.clip(value, i.lower, i.upper)
                for value, i in zip(x[-2:], (robot.rigid_link.d35, robot.rigid_link.d45), strict=True)
            )
            lengths = arm.lengths * length / arm.length
            return OracleArm(robot, curvatures, lengths, float(d35), float(d45), arm.position, arm.yaw)

        start = np.concatenate([arm.curvatures.ravel(), [arm.length, arm.d35, arm.d45]])
        answer = least_squares(lambda x, bent=bent: cost(bent(x), 12), start, max_nfev=25)
        best = bent(answer.x)
        joints = best.closest(targets)
        if (best.misses(joints, targets) <= task.tolerances).all() and not broken(task, best, joints):
            return best
    return None


def _numbers(task, content, arm):
    """Check the numbers of the JSON: misses, points reached, clearances, the link, the distances."""
    joints = np.array([target["joints"] for target in content["targets"]])
    reached, targets = arm.reached(joints), task.table.positions
    misses = np.linalg.norm(reached - targets, axis=1)
    size = task.robot.link.length.upper + longest_rod(task.robot)
    closest = None
    solids = [obstacle.solid for obstacle in task.obstacles]
    for index, target in enumerate(content["targets"]):
        name = target["name"]
        if np.abs(reached[index] - target["reached"]).max() > SLACK * size:
            yield Fault("misstated", f"{name} is reached elsewhere than said")
        if abs(misses[index] - target["miss"]) > SLACK * size:
            yield Fault("misstated", f"{name} misses by {misses[index]}, said {target['miss']}")
        if solids:
            clear = min(float(arm.clearances(joints[index], solids).min()), 0.1)
            said = target["clearance"]
            if not clear - 1e-4 <= said <= clear + 2e-6:
                yield Fault("misstated", f"{name} is clear by {clear}, said {said}")
        yield from _other_joints(task, arm, target, targets[[index]], solids)
        if target["miss"] > target["tolerance"]:
            # What is missed could not be reached in this shape: else the sentence "misses by" is none.
            closest = arm.closest(targets) if closest is None else closest
            nearer = arm.misses(closest[[index]], targets[[index]])[0]
            if nearer < misses[index] - 1e-5 and not arm.breaches_at(closest[index], task.floor, solids):
                yield Fault("not the closest", f"{name}: {nearer} is possible, said {misses[index]}")
    yield from _link(content, arm, size)


def _other_joints(task, arm, target, position, solids):
    """Check the other joint angles that are said to reach a target."""
    name = target["name"]
    for other in target["alternatives"]:
        if arm.misses(np.array([other]), position)[0] > target["tolerance"] + SLACK:
            yield Fault("misstated", f"{name}: other joint angles miss it")
        for breach in arm.breaches_at(other, task.floor, solids):
            yield Fault("misstated", f"{name}: other joint angles break {breach.limit} by {breach.amount}")


def _link(content, arm, size):
    """Check the numbers of the link and the distances of the points."""
    link = content["link"]
    for key, value in (("length", arm.length), ("total_bend", arm.total_bend)):
        if abs(link[key] - value) > SLACK:
            yield Fault("misstated", f"link {key} {link[key]} is {value}")
    for pair, said in content["distances"].items():
        points = [*arm.axis_points, arm.at_joint_2(np.pi)]
        true = float(np.linalg.norm(points[int(pair[0]) - 1] - points[int(pair[1]) - 1]))
        if abs(true - said) > SLACK * size:
            yield Fault("misstated", f"d{pair} is {true}, said {said}")


def _ways(task, content, arm):
    """Check that ways from target to target keep within limits and clear of everything, at many postures."""
    solids = [obstacle.solid for obstacle in task.obstacles]
    for motion in content["motions"] or []:
        joints = np.array(motion["joints"])
        for start, end in pairwise(joints):
            for share in np.linspace(0.0, 1.0, 7):
                posture = start + share * (end - start)
                broken_here = [
                    breach
                    for breach in arm.breaches_at(posture, task.floor, solids)
                    if breach.amount > _WAY_SLACK
                ]
                if broken_here and content["status"] == "found":
                    limit, amount = broken_here[0]
                    name = f"{motion['start']} to {motion['end']}"
                    yield Fault("way not clear", f"{name}: {limit} by {1e3 * amount:.4f} mm at {posture}")
                    break


def _sentences(fuzz, task, content, arm, text):
    """Check the sentences that state numbers, and those that ask a person to do something."""
    message, status = content["message"], content["status"]
    names = {target["name"]: target for target in content["targets"]}
    indices = {name: index for index, name in enumerate(task.table.names)}
    if status != "found":
        for words in ("Hold axis 2 within", "Set joint 1 to"):
            if words in text:
                yield Fault("instructions", f"a task that is not met is told: {words} ...")
    if not content["link"] and "nearest found" in text:
        yield Fault("untrue", "there is no shape, but: this is the nearest found")
    if re.search(r"\bnan\b|\binf\b", message + text):
        yield Fault("untrue", "a number is nan or inf")
    for name, number in re.findall(rf"(\w+) misses by {_NUMBER} mm", message):
        miss = 1e3 * arm.misses(np.array([names[name]["joints"]]), task.table.positions[[indices[name]]])[0]
        if abs(miss - float(number)) > 0.01 * _ROUNDED:
            yield Fault("untrue", f"{name} misses by {miss:.4f} mm, said {number}")
    yield from _reasons(fuzz, task, content, indices)
    if arm is None:
        return
    yield from _summary(content, arm, text, names)


def _reasons(fuzz, task, content, indices):
    """Check the proofs' numbers: bounds must be attained by nothing, so rounded to the safe side."""
    positions = task.base.to_base(task.table.positions)
    solids = {obstacle.name: obstacle.solid for obstacle in task.obstacles}
    p2 = task.base.to_task(np.array([0.0, 0.0, task.robot.d12]))

    def sunk(name, number):
        return number, task.floor - positions[indices[name], 2]

    def in_solid(name, solid, number):
        target = task.table.positions[indices[name]]
        rod = 0.5 * task.robot.rigid_link.diameter
        return number, rod - float(distance_from_solid(solids[solid], target))

    depths = {
        rf"(\w+) is {_NUMBER} mm below the floor": sunk,
        rf"(\w+) is in (.*): the end effector would be {_NUMBER} mm inside": in_solid,
        rf"the link starts at P2, {_NUMBER} mm below the floor": lambda number: (
            number,
            task.floor - task.robot.d12,
        ),
        rf"the link starts at P2, {_NUMBER} mm inside (.*)": lambda number, solid: (
            number,
            -float(distance_from_solid(solids[solid], p2)),
        ),
    }
    for reason in content["reasons"]:
        if content["status"] == "proven_impossible" and not any(
            re.match(pattern, reason) for pattern in (_OUT_OF_REACH, *depths)
        ):
            yield Fault("not judged", reason)
        if "by algebra" in reason and fuzz.kind == "planted":
            yield Fault("untrue", f"planted, but: {reason}")
        if found := re.match(_OUT_OF_REACH, reason):
            yield from _reach(task, reason, positions[indices[found.group(1)]], found.groups()[1:])
        for pattern, depth_of in depths.items():
            if found := re.match(pattern, reason):
                said, depth = depth_of(*found.groups())
                if abs(1e3 * depth - float(said)) > 0.1 * _ROUNDED + 0.05:
                    yield Fault("untrue", f"{reason}; it is {1e3 * depth:.4f} mm")


def _reach(task, reason, point, numbers):
    """Check a target out of reach: how far it is from the link's end, the rigid link, the least miss."""
    away, reach, least = map(float, numbers)
    rod, nearest = 1e3 * longest_rod(task.robot), 1e3 * nearest_end(task, point)
    if least > nearest - rod + 1e-6:
        yield Fault("untrue", f"{reason}; but {nearest - rod:.6f} mm is possible")
    if reach < rod - 1e-6:
        yield Fault("untrue", f"{reason}; but the rigid link reaches {rod:.6f} mm")
    if away > nearest + 1e-6:
        yield Fault("untrue", f"{reason}; but it can be {nearest:.6f} mm")


def nearest_end(task: Task, point) -> float:
    """Return how near the link's end comes to a point of the base frame at least, by a search, m."""
    rng, link = np.random.default_rng(0), task.robot.link
    best = np.inf
    for _ in range(6):
        start = random_arm(task, rng)
        count = len(start.lengths)

        def end(x, start=start, count=count):
            curvatures = x[: 2 * count].reshape(-1, 2)
            size = np.linalg.norm(curvatures, axis=1, keepdims=True) * link.min_bend_radius
            curvatures = curvatures / np.maximum(size, 1.0)
            lengths = start.lengths * np.clip(x[-1], link.length.lower, link.length.upper) / start.length
            total = float(np.linalg.norm(curvatures, axis=1) @ lengths)
            curvatures = curvatures * min(1.0, link.max_total_bend / max(total, 1e-12))
            return OracleArm(
                task.robot, curvatures, lengths, start.d35, start.d45, start.position, start.yaw
            ).end[1]

        x = np.concatenate([0.3 * start.curvatures.ravel(), [start.length]])
        answer = least_squares(lambda x, end=end: end(x) - point, x, max_nfev=100)
        best = min(best, float(np.linalg.norm(answer.fun)))
    return best


def _summary(content, arm, text, names):
    """Check the lines of the summary: category, link, targets."""
    off = arm.off_topology
    numbers = {
        rf"PUMA-like within {_NUMBER} mm|{_NUMBER} mm from PUMA-like": 1e3 * off["puma"],
        rf"spherical within {_NUMBER} mm|{_NUMBER} mm from spherical": 1e3 * off["spherical"],
        rf"SCARA within {_NUMBER} deg|{_NUMBER} deg from SCARA": np.degrees(off["scara"]),
        rf"link {_NUMBER} mm long": 1e3 * arm.length,
        rf"smallest bend radius {_NUMBER} mm": 1e3 / max(arm.bends.max(), 1e-9),
        rf"{_NUMBER} deg of bend in all": np.degrees(arm.total_bend),
    }
    for pattern, true in numbers.items():
        found = re.search(pattern, text)
        if found is None:
            # A sentence that is worded anew must be read anew, or it would pass unread.
            if "bend" not in pattern or "straight" not in text:
                yield Fault("not judged", f"no such words: {pattern}")
            continue
        said = next(filter(None, found.groups()))
        if abs(float(said) - true) > 0.1 * _ROUNDED + 1e-4 + 1e-6 * abs(true):
            yield Fault("untrue", f"{found.group(0)}; it is {true:.4f}")
    lines = re.findall(_TARGET_LINE, text)
    if len(lines) != min(len(names), _MOST_LINES):
        yield Fault("not judged", f"{len(lines)} lines of {len(names)} targets are read")
    for line in lines:
        if line[0] not in names:
            yield Fault("untrue", f"there is no target {line[0]}")
        else:
            yield from _target_line(names[line[0]], *line)
    if content["status"] == "found" and "MISSED" in text:
        yield Fault("untrue", "found, but a target is MISSED")


def _target_line(target, name, verdict, miss, tolerance, theta1, theta2, clear):
    """Check what the summary says of a target."""
    if (verdict == "reached") != target["within_tolerance"]:
        yield Fault("untrue", f"{name} is {verdict}, but within tolerance: {target['within_tolerance']}")
    if (verdict == "reached") != (float(miss) <= float(tolerance)):
        yield Fault("puzzling", f"{name} is {verdict}, with a miss of {miss} of {tolerance} mm")
    for said, true, digit in (
        (miss, 1e3 * target["miss"], 1e-3),
        (tolerance, 1e3 * target["tolerance"], 1e-3),
        (theta1, np.degrees(target["joints"][0]), 1e-2),
        (theta2, np.degrees(target["joints"][1]), 1e-2),
    ):
        if abs(float(said) - true) > digit * _ROUNDED + 1e-9 * abs(true):
            yield Fault("untrue", f"{name}: {said} is {true:.6f}")
    if clear and abs(float(clear) - 1e3 * min(target["clearance"], 0.1)) > 0.1 * _ROUNDED + 0.05:
        yield Fault("untrue", f"{name}: clear by {clear} mm, it is {1e3 * target['clearance']:.4f}")
