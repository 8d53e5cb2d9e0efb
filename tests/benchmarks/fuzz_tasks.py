"""Random tasks over the whole input space, as task files: other robots, places, obstacles, questions.

A task is planted (a legal shape of unequal arcs, its targets by the oracle's kinematics at legal joint
angles, clear of everything: so it can be done), impossible by construction, or wild (nobody knows).
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import least_squares

sys.path.insert(0, str(Path(__file__).parents[1]))

from fuzz_drawn import FuzzTask, is_meant, parsed
from fuzz_robots import chosen, log_uniform, random_content, random_obstacle, rounded
from oracle import OracleArm, distance_from_solid, longest_rod

if TYPE_CHECKING:
    from synth.task import Task

KINDS = {"planted": 0.55, "impossible": 0.15, "wild": 0.3}
ROOM = 2e-3  # m: the least clearance of a planted arm
_TRIES, _TRIES_BENT = 400, 25  # shapes drawn before the hardware is drawn anew


def random_arm(task: Task, rng) -> OracleArm:
    """Return a shape of three to six unequal arcs, mostly within the limits of length and bend."""
    robot = task.robot
    arcs = int(rng.integers(3, 7))
    length = rng.uniform(robot.link.length.lower, robot.link.length.upper)
    shares = rng.uniform(0.5, 1.5, arcs)
    lengths = length * shares / shares.sum()
    bends = np.sqrt(rng.uniform(size=arcs)) / robot.link.min_bend_radius
    bends *= min(1.0, rng.uniform(0.5, 1.0) * robot.link.max_total_bend / float(bends @ lengths))
    turns = rng.uniform(0.0, 2.0 * np.pi, arcs)
    curvatures = bends[:, None] * np.column_stack([np.cos(turns), np.sin(turns)])
    d35, d45 = (rng.uniform(i.lower, i.upper) for i in (robot.rigid_link.d35, robot.rigid_link.d45))
    base = task.base
    return OracleArm(robot, curvatures, lengths, d35, d45, np.array(base.position), base.yaw)


def bent_into(arm: OracleArm, topology: str) -> OracleArm | None:
    """Bend a shape until its axes meet, or are parallel, to rounding; None where that does not work."""

    def bent(flat):
        return OracleArm(arm.robot, flat.reshape(-1, 2), arm.lengths, arm.d35, arm.d45, arm.position, arm.yaw)

    def off(flat):
        frame, origin = bent(flat).end
        if topology == "scara":
            return frame[:2, 0]
        height = 0.0 if topology == "spherical" else arm.robot.d12
        return frame[:, 1:].T @ (origin - [0.0, 0.0, height])

    answer = least_squares(off, arm.curvatures.ravel(), xtol=1e-15, ftol=1e-15, gtol=1e-15, max_nfev=60)
    return bent(answer.x) if np.abs(answer.fun).max() < 1e-10 else None


def planted_arm(task: Task, rng) -> OracleArm | None:
    """Return a legal shape of the topology asked for, or None if none is drawn."""
    topology = task.topology.value
    special = topology not in {"any", "general"}
    for _ in range(_TRIES_BENT if special else _TRIES):
        arm = random_arm(task, rng)
        if special:
            arm = bent_into(arm, topology)
        if arm is None or not arm.is_topology(topology):
            continue
        if not arm.breaches_of_shape(task.floor_in_base, spacing=2e-3) and not arm.breaches_of_shape(
            task.floor_in_base
        ):
            return arm
    return None


def legal_joints(task: Task, arm: OracleArm, count, rng):
    """Return joint angles [count, 2] at which the arm is legal, off the ends of their ranges, or None."""
    limits = task.robot.joint_limits
    kept = []
    for _ in range(20 * count):
        joints = [
            rng.uniform(i.lower + 1e-3 * (i.upper - i.lower), i.upper - 1e-3 * (i.upper - i.lower))
            for i in (limits.base, limits.second)
        ]
        if not arm.breaches_at(joints, task.floor_in_base) and arm.rod_from_tube(joints) > 1e-4:
            kept.append(joints)
            if len(kept) == count:
                return np.array(kept)
    return None


def with_obstacles(task_of, content, around, size, rng, clear):
    """Return the content with up to four obstacles, each of them, as a solid, one that `clear` lets pass."""
    obstacles = []
    for _ in range(int(rng.choice([0, 1, 2, 4], p=[0.5, 0.2, 0.15, 0.15]))):
        for _ in range(30):
            entry = rounded(random_obstacle(rng, size, around))
            if clear(task_of(content | {"obstacles": [entry]}).obstacles[0].solid):
                obstacles.append(entry)
                break
    return content | ({"obstacles": obstacles} if obstacles else {})


def with_targets(content, points, rng):
    """Return the content with points, m, as targets: a tolerance for all or for each, some with weights."""
    count = len(points)
    if rng.uniform() < 0.5:
        tolerances = np.full(count, log_uniform(rng, 0.01, 20.0))
    else:
        tolerances = log_uniform(rng, 0.01, 20.0, count)
    targets = [
        {"name": f"t{i + 1}", "position": 1e3 * point, "tolerance": tolerance}
        for i, (point, tolerance) in enumerate(zip(points, tolerances, strict=True))
    ]
    if rng.uniform() < 0.2:
        for target in targets:
            target["weight"] = log_uniform(rng, 0.1, 10.0)
    return rounded(content | {"targets": targets})


def fuzz_task(number: int) -> FuzzTask:
    """Return the task of a number."""
    rng = np.random.default_rng([number, 10])
    kind = chosen(rng, KINDS)
    while True:
        tags: list[str] = []
        content = random_content(rng, tags)
        task = parsed(content)
        count = round(float(log_uniform(rng, 1.0, 30.0)))
        arm = planted_arm(task, rng)
        joints = legal_joints(task, arm, count, rng) if arm is not None else None
        if joints is None:
            continue
        drawn = _drawn(rng, kind, content, task, arm, joints)
        if drawn is None or not is_meant(drawn[0]):
            continue
        content, why, solvable = drawn
        if solvable:
            # What goes to the task file and back must still be what was planted.
            task = parsed(content)
            assert arm.misses(joints, task.table.positions).max() < 1e-9
        content = {"synth": content["synth"], "name": f"fuzz {number}"} | content
        return FuzzTask(
            number, kind, content, arm if solvable else None, joints if solvable else None, why, tags
        )


def _drawn(rng, kind, content, task, arm, joints):
    """Return the whole content, what is special, and whether the planted arm does it; None to try again."""
    points = arm.reached(joints)
    size = 1e3 * (task.robot.link.length.upper + longest_rod(task.robot))
    middle = 1e3 * points.mean(axis=0)
    p2 = arm.to_task(arm.axis_points[1])

    def clear(solid):
        return (
            distance_from_solid(solid, p2) > arm.tube_radius + ROOM and arm.clearance(joints, [solid]) >= ROOM
        )

    if kind == "planted":
        content = with_obstacles(parsed, content, middle, size, rng, clear)
        return with_targets(content, points, rng), "", True
    if kind == "wild":
        noise = size * log_uniform(rng, 1e-4, 0.3) * 1e-3
        moved = points + rng.normal(size=points.shape) * noise
        content = with_obstacles(parsed, content, middle, size, rng, lambda _: True)
        return with_targets(content, moved, rng), f"noise {1e3 * noise:.2f} mm", False
    return _impossible(rng, content, task, points, size, p2)


def _impossible(rng, content, task, points, size, p2):
    """Return a content in which one thing is impossible."""
    victim = int(rng.integers(len(points)))
    why = str(
        rng.choice(["too far", "below the floor", "in an obstacle", "base in an obstacle", "floor above P2"])
    )
    content = with_targets(content, points, rng)
    tolerance = content["targets"][victim]["tolerance"]
    target = content["targets"][victim]
    if why == "too far":
        direction = rng.normal(size=3)
        distance = size * (1.0 + log_uniform(rng, 1e-4, 0.5)) + tolerance
        target["position"] = 1e3 * p2 + distance * direction / np.linalg.norm(direction)
    elif why == "below the floor":
        if task.floor_in_base is None:
            return None
        position = np.array(target["position"])
        height = 1e3 * task.floor_height
        position[2] = height - tolerance - log_uniform(rng, 0.01, 200.0)
        target["position"] = position
    elif why == "in an obstacle":
        depth = tolerance + log_uniform(rng, 0.05, 100.0)
        radius = depth * rng.uniform(1.0, 1.5)
        direction = rng.normal(size=3)
        centre = 1e3 * points[victim] + (radius - depth) * direction / np.linalg.norm(direction)
        content["obstacles"] = [{"sphere": {"center": centre, "radius": radius}}]
    elif why == "base in an obstacle":
        extent = log_uniform(rng, 5.0, 200.0, 3)
        centre = 1e3 * p2 + rng.uniform(-0.4, 0.4, 3) * extent
        content["obstacles"] = [{"box": {"center": centre, "size": extent, "yaw_deg": 0.0}}]
    else:
        content["floor"] = 1e3 * task.robot.d12 + log_uniform(rng, 0.1, 100.0)
        base = content.get("base", {"position": [0.0, 0.0, 0.0]})
        content["base"] = base | {"position": [*base["position"][:2], 0.0]}
    return rounded(content), why, False
