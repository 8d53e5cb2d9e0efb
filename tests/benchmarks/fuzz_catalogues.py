"""Random tasks whose rigid link is one of a catalogue."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from fuzz_drawn import FuzzTask, parsed
from fuzz_robots import rounded
from fuzz_tasks import fuzz_task
from oracle import longest_rod


def with_catalogue(number: int) -> FuzzTask:
    """Return a task of point targets whose rigid link is one of several."""
    fuzz, rng = fuzz_task(number), np.random.default_rng([number, 11])
    task = parsed(fuzz.content)
    arm = fuzz.planted
    if arm is None:
        rigid = task.robot.rigid_link
        lengths = (rigid.d35.upper, rigid.d45.upper)
        if not abs(lengths[0] - lengths[1]) < task.robot.d34:
            lengths = (lengths[0], lengths[0])
    else:
        lengths = (arm.d35, arm.d45)
    content = catalogued(rng, fuzz.content, task.robot, lengths)
    if arm is not None:
        arm = replace(arm, robot=parsed(content).robot)
    return replace(fuzz, content=content, planted=arm, tags=[*fuzz.tags, "catalogue"])


def catalogued(rng, content, robot, lengths):
    """Return a content whose robot has one to four rigid links, of these lengths, m, or shorter ones."""
    mine = {"d35": 1e3 * lengths[0], "d45": 1e3 * lengths[1]}
    longest = longest_rod(_carrying(robot, mine))
    items = [mine]
    for _ in range(int(rng.integers(0, 4))):
        share = rng.uniform(0.5, 1.0)
        other = {"d35": share * mine["d35"], "d45": share * mine["d35"] + (mine["d45"] - mine["d35"])}
        apart = min(abs(other[key] - each[key]) for key in other for each in items)
        flat = other["d35"] + other["d45"] <= 1e3 * robot.d34 * 1.01 or min(other.values()) <= 0.0
        if apart < 0.1 or flat or longest_rod(_carrying(robot, other)) > longest:
            continue
        items.append(other)
    rng.shuffle(items)
    if rng.uniform() < 0.3:
        rigid = {key: {"one_of": [item[key] for item in items]} for key in mine}
    else:
        rigid = {"one_of": [{"name": f"rod {chr(65 + i)}", **item} for i, item in enumerate(items)]}
    if robot.rigid_link.diameter:
        rigid["diameter"] = 1e3 * robot.rigid_link.diameter
    return rounded(content | {"robot": _as_mapping(robot) | {"rigid_link": rigid}})


def _carrying(robot, item):
    """Return a robot with a rigid link."""
    rigid = robot.rigid_link
    return replace(robot, rigid_link=replace(rigid, d35=item["d35"] / 1e3, d45=item["d45"] / 1e3))


def _as_mapping(robot):
    """Return a robot, but for its rigid link, as a task file says it, in mm."""
    link, limits = robot.link, robot.joint_limits
    told = {
        "length": [1e3 * link.length.lower, 1e3 * link.length.upper],
        "min_bend_radius": 1e3 * link.min_bend_radius,
    }
    if np.isfinite(link.max_total_bend):
        told["max_total_bend_deg"] = float(np.degrees(link.max_total_bend))
    if link.diameter:
        told["diameter"] = 1e3 * link.diameter
    return {
        "d12": 1e3 * robot.d12,
        "link": told,
        "d34": 1e3 * robot.d34,
        "tip_offset": 1e3 * robot.tip_offset,
        "joint_limits_deg": {
            name: np.degrees([each.lower, each.upper])
            for name, each in (("base", limits.base), ("second", limits.second))
        },
    }
