"""What the answers to six realistic tasks would be like to work with: margins, ways, swings, forgiveness.

    python tests/benchmarks/realistic.py [--seeds 1] [--margin-seeds 0]

All targets have a tolerance of 5 mm. Counted over all shapes of an answer: those with a joint within 5 deg of
a limit, with a link within 1 mm of a limit, and those with a way missing. Of the first shape: the least
distance of a joint from its limits, the largest swing of a joint from a target to the next, the worst miss,
and after a hand placed the link the expected worst miss and the chance that all targets are met. With
`--margin-seeds` another search, with joint ranges narrowed and many seeds, says whether a shape with all
joints 5 deg off their limits exists, and how calm the calmest was.
"""

from __future__ import annotations

import argparse
import itertools
import math
import time
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from synth.geometry import Box
from synth.robot import PRESETS, Interval, JointLimits
from synth.synthesis import motions, solve
from synth.synthesis.wanted.forgiveness import hand_forgiveness
from synth.task import Obstacle, PointTarget, Task

if TYPE_CHECKING:
    from synth.synthesis import Design, Motion

ROBOT = PRESETS["malleable-2dof"]
TOLERANCE = 5e-3  # m
NEAR_JOINT, NEAR_LENGTH = math.radians(5.0), 1e-3
WIDE_SWING = math.radians(120.0)


def box(name: str, centre: tuple[float, ...], size: tuple[float, ...], yaw_deg: float = 0.0) -> Obstacle:
    """Return a box, in mm and deg."""
    return Obstacle(name, Box(np.array(centre) / 1e3, np.array(size) / 1e3, math.radians(yaw_deg)))


def task(name: str, targets: dict[str, tuple[float, ...]], *obstacles: Obstacle) -> Task:
    """Return a task with targets in mm."""
    points = [PointTarget(key, np.array(at) / 1e3, TOLERANCE) for key, at in targets.items()]
    return Task(name, ROBOT, tuple(points), obstacles=obstacles)


TASKS = (
    task(
        "two tables",
        {
            "over pick": (-520, 400, 400),
            "pick": (-520, 400, 250),
            "over place": (-520, -380, 400),
            "place": (-520, -380, 250),
        },
        box("table 1", (-600, 450, 110), (500, 400, 220)),
        box("table 2", (-600, -450, 110), (500, 400, 220)),
    ),
    task(
        "shelf",
        {"lower board": (-100, 720, 180), "middle board": (-100, 720, 480), "tray": (-600, -150, 250)},
        box("lower", (-100, 850, 90), (800, 300, 20)),
        box("middle", (-100, 850, 400), (800, 300, 20)),
        box("upper", (-100, 850, 750), (800, 300, 20)),
    ),
    task(
        "bench",
        {
            "screws": (150, 600, 150),
            "plates": (-150, 650, 150),
            "jig": (-450, 500, 150),
            "tester": (-600, 200, 250),
            "tray": (-620, -200, 150),
        },
        box("bench top", (-150, 650, 60), (1100, 300, 80)),
    ),
    task(
        "conveyor",
        {
            "upstream": (-350, 650, 350),
            "middle": (0, 650, 350),
            "downstream": (350, 650, 350),
            "box": (-650, 0, 150),
        },
        box("conveyor", (0, 700, 150), (1600, 300, 300)),
    ),
    task(
        "bin",
        {"over the bin": (-500, 350, 550), "in the bin": (-500, 350, 200), "chute": (-450, -450, 350)},
        box("wall left", (-680, 350, 150), (20, 400, 300)),
        box("wall right", (-320, 350, 150), (20, 400, 300)),
        box("wall behind", (-500, 540, 150), (360, 20, 300)),
        box("wall before", (-500, 160, 150), (360, 20, 300)),
    ),
    task(
        "two stations",
        {"hang": (-400, 400, 700), "drop": (-300, -550, 300)},
        box("post", (-750, 0, 400), (100, 100, 800)),
    ),
)


def joints_of(ways: tuple[Motion, ...], design: Design) -> np.ndarray:
    """Return the joint angles at the targets, shape (n, 2), rad: where the ways lead, if there are all."""
    if not ways or not all(way.found for way in ways):
        return design.verification.joints
    return np.array([ways[0].joints[0], *(way.joints[-1] for way in ways)])


def least_joint_margin(joints: np.ndarray) -> float:
    """Return the least distance of a joint from its limits, rad."""
    limits = ROBOT.joint_limits
    return min(
        float(np.minimum(angles - each.lower, each.upper - angles).min())
        for angles, each in zip(joints.T, (limits.base, limits.second), strict=True)
    )


def link_near_a_limit(design: Design) -> bool:
    """Whether length or bend radius are within a millimetre of a limit."""
    shape, link = design.arm.shape, ROBOT.link
    room = min(
        shape.length - link.length.lower,
        link.length.upper - shape.length,
        shape.min_bend_radius - link.min_bend_radius,
    )
    return room < NEAR_LENGTH


def largest_swing(ways: tuple[Motion, ...], joints: np.ndarray) -> float:
    """Return the most that a joint turns between neighbouring targets, corners of the ways included, rad."""
    steps = [np.ptp(way.joints, axis=0).max() for way in ways if way.found]
    return float(max(steps, default=np.abs(np.diff(joints, axis=0)).max(initial=0.0)))


def report(each: Task, seed: int) -> None:
    """Solve a task and print its row."""
    solve(each, seed=seed)  # builds the program
    began = time.perf_counter()
    solution = solve(each, seed=seed)
    took = time.perf_counter() - began
    ways = [motions(each, design) for design in solution.designs]
    joints = [joints_of(*pair) for pair in zip(ways, solution.designs, strict=True)]
    near = sum(least_joint_margin(angles) < NEAR_JOINT - 1e-6 for angles in joints)
    links = sum(link_near_a_limit(design) for design in solution.designs)
    missing = sum(not all(way.found for way in some) for some in ways)
    hand = hand_forgiveness(each, solution.best.arm)
    off, swing = (math.degrees(a) for a in (least_joint_margin(joints[0]), largest_swing(ways[0], joints[0])))
    worst = 1e3 * max(target.miss for target in solution.targets)
    print(
        f"{each.name:<13} {solution.status.value}, {len(solution.designs)} shapes: {near} near a joint "
        f"limit, {links} links at a limit, {missing} without a way; first: joints {off:5.1f} deg off, "
        f"swing {swing:5.1f} deg, miss {worst:5.2f} mm, after a hand "
        f"{1e3 * hand.expected_worst_miss:5.2f} mm, chance {100 * hand.chance:3.0f} %; {took:.2f} s",
        flush=True,
    )


def exists(each: Task, seeds: int) -> str:
    """Say what another search knows: many seeds, joint ranges narrowed by 5 deg."""
    limits = ROBOT.joint_limits
    base, second = (
        Interval(limit.lower + NEAR_JOINT, limit.upper - NEAR_JOINT) for limit in (limits.base, limits.second)
    )
    narrow = replace(each, robot=replace(ROBOT, joint_limits=JointLimits(base, second)))
    found, calmest = 0, math.inf
    for seed in range(seeds):
        for design in solve(narrow, seed=1000 + seed, alternatives=0).designs:
            ways = motions(narrow, design)
            if design.verification.found and all(way.found for way in ways):
                found += 1
                calmest = min(calmest, largest_swing(ways, joints_of(ways, design)))
    return (
        f"{found} shapes with joints 5 deg off and all ways in {seeds} seeds; "
        f"the calmest swings {math.degrees(calmest):.1f} deg"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--margin-seeds", type=int, default=0)
    arguments = parser.parse_args()
    for seed, each in itertools.product(range(arguments.seeds), TASKS):
        report(each, seed)
    if arguments.margin_seeds:
        for each in TASKS:
            print(f"{each.name:<13} {exists(each, arguments.margin_seeds)}", flush=True)


if __name__ == "__main__":
    main()
