"""Tasks whose rigid link is to be chosen, with a known answer: an arm with a planted rigid link, and targets it reaches."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from planted import ROBOT, feasible, random_shape, reached_points

from synth.robot import Arm, Interval, RigidLink, RigidLinkChoices, Robot
from synth.task import PointTarget, Task

LENGTHS = (0.320, 0.365, 0.410, 0.455, 0.500, 0.545)  # m, of d35; d45 is 5 mm more
NAMES = ("A", "B", "C", "D", "E", "F")
CATALOGUE = RigidLinkChoices(NAMES, [RigidLink(d35, d35 + 0.005) for d35 in LENGTHS])
RANGE = Interval(0.30, 0.60)  # m


def planted_rigid_link(seed: int, count: int = 5) -> tuple[Task, str]:
    """Return a task with a catalogue of six rigid links, and the name of the one that was planted."""
    rng = np.random.default_rng([seed, 21])
    robot = replace(ROBOT, rigid_links=CATALOGUE)
    right = int(rng.integers(len(NAMES)))
    planted = replace(robot, rigid_link=CATALOGUE.links[right])
    return Task(f"catalogue {seed}", robot, _reached(planted, count, rng)), NAMES[right]


def free_rigid_link(seed: int, count: int = 5) -> tuple[Task, Arm]:
    """Return a task with d35 and d45 in ranges of 300 mm, and the arm that was planted."""
    rng = np.random.default_rng([seed, 22])
    d35 = rng.uniform(RANGE.lower + 0.04, RANGE.upper - 0.04)
    d45 = d35 + rng.uniform(-0.03, 0.03)
    planted = replace(ROBOT, rigid_link=RigidLink(d35, d45))
    robot = replace(ROBOT, rigid_link=RigidLink(RANGE, RANGE))
    return Task(f"free rigid link {seed}", robot, _reached(planted, count, rng))


def _reached(robot: Robot, count: int, rng: np.random.Generator) -> list[PointTarget]:
    """Return targets that a random shape of a robot reaches, to be met to half a millimetre."""
    rigid = robot.rigid_link
    while True:
        arm = Arm(robot, random_shape(rng), rigid.d35.lower, rigid.d45.lower)
        points = reached_points(arm, count, rng) if feasible(arm) else []
        if len(points) == count:
            return [PointTarget(f"target {i + 1}", point, 0.5e-3) for i, point in enumerate(points)]
