"""What is wrong with an answer, judged by the oracle: claims, proofs, numbers and sentences."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from fuzz_faults import Fault
from fuzz_lines import Told
from fuzz_proofs import faults_of_bound, faults_of_reasons, searched
from fuzz_sentences import faults_of_text
from oracle import SLACK, OracleArm, longest_rod

if TYPE_CHECKING:
    from fuzz_drawn import FuzzTask

    from synth.task import Task

_WAY_SLACK = 3e-5  # m: by so much a clearance on a way is known to the package


def arm_found(task: Task, content) -> OracleArm | None:
    return OracleArm.stated(task, content) if content["link"] else None


def judge(fuzz: FuzzTask, task: Task, content, text: str, proof: float = 0.0) -> list[Fault]:
    """Return the faults of an answer.

    Args:
        fuzz: The task, and what is known of its answer.
        task: The same as read.
        content: The JSON of the solution.
        text: What the terminal shows of it.
        proof: For how long a bound is looked for, s, which no shape known may beat.
    """
    faults, status = [], content["status"]
    arm = arm_found(task, content)
    faults += [fault for each in (_found, _impossible) for fault in each(fuzz, task, content, arm)]
    if arm is not None:
        faults += _numbers(task, content, arm)
        faults += _ways(task, content, arm)
        faults += _alternatives(task, content)
    faults += faults_of_reasons(fuzz, task, content)
    faults += faults_of_text(Told(task, content, arm), text)
    if proof > 0.0:
        joints = np.array([target["joints"] for target in content["targets"]])
        faults += faults_of_bound(fuzz, task, arm, joints, proof)
    if fuzz.kind == "planted" and status != "found":
        faults.append(Fault("planted missed", content["message"]))
    if fuzz.kind == "impossible" and status == "found":
        faults.append(Fault("false found", f"{fuzz.why}, but found"))
    if status == "failed":
        faults.append(Fault("failed", content["message"]))
    return faults


def broken(task: Task, arm: OracleArm, joints, *, which=None) -> list[str]:
    """Return the limits that an arm breaks in itself and at the targets, as sentences."""
    solids = [obstacle.solid for obstacle in task.obstacles]
    told = [
        f"{b.limit} by {1e3 * b.amount:.6f} mm or mrad" for b in arm.breaches_of_shape(task.floor_in_base)
    ]
    if not arm.is_topology(task.topology.value):
        told.append(f"topology {task.topology.value}: off by {arm.off_topology}")
    for index in range(len(joints)) if which is None else which:
        told += [
            f"{task.table.names[index]}: {b.limit} by {1e3 * b.amount:.6f} mm or mrad"
            for b in arm.breaches_at(joints[index], task.floor_in_base, solids)
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
    elif fuzz.kind == "wild" and (found := searched(task, fuzz.number, broken)) is not None:
        yield Fault(
            "false proof", f"{content['message']}; but arcs {found.curvatures}, {found.lengths} do it"
        )


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
            if nearer < misses[index] - 1e-5 and not arm.breaches_at(
                closest[index], task.floor_in_base, solids
            ):
                yield Fault("not the closest", f"{name}: {nearer} is possible, said {misses[index]}")
    yield from _link(content, arm, size)


def _other_joints(task, arm, target, position, solids):
    """Check the other joint angles that are said to reach a target."""
    name = target["name"]
    for other in target["alternatives"]:
        if arm.misses(np.array([other]), position)[0] > target["tolerance"] + SLACK:
            yield Fault("misstated", f"{name}: other joint angles miss it")
        for breach in arm.breaches_at(other, task.floor_in_base, solids):
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
    for way in content["ways"] or []:
        joints = np.array(way["joints"]).reshape(-1, 2)
        for start, end in pairwise(joints):
            for share in np.linspace(0.0, 1.0, 7):
                posture = start + share * (end - start)
                broken_here = [
                    breach
                    for breach in arm.breaches_at(posture, task.floor_in_base, solids)
                    if breach.amount > _WAY_SLACK
                ]
                if broken_here and content["status"] == "found":
                    limit, amount = broken_here[0]
                    name = f"{way['from']} to {way['to']}"
                    yield Fault("way not clear", f"{name}: {limit} by {1e3 * amount:.4f} mm at {posture}")
                    break


def _alternatives(task, content):
    """Check the other shapes: what they are said to miss by none of them can undercut."""
    for other in content["alternatives"]:
        stated = {"link": other["link"], "distances": other["distances"]}
        shape = OracleArm.stated(task, stated)
        least = shape.misses(shape.closest(task.table.positions), task.table.positions)
        name = f"shape {other['shape']}"
        for target, possible, tolerance in zip(other["targets"], least, task.tolerances, strict=True):
            if target["miss"] < possible - 1e-6:
                yield Fault(
                    "misstated", f"{name}: {target['name']} misses by {possible}, said {target['miss']}"
                )
            if target["within_tolerance"] and target["miss"] > tolerance + SLACK:
                yield Fault("false found", f"{name}: {target['name']} is not within its tolerance")
        for breach in shape.breaches_of_shape(task.floor_in_base):
            yield Fault("misstated", f"{name} breaks {breach.limit} by {breach.amount}")
