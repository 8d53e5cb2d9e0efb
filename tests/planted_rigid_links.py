"""Tasks whose rigid link is to be chosen: an arm with a planted one, and targets that it reaches."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from planted import ROBOT, feasible, random_shape, reached_points

from synth.robot import Arm, Interval, RigidLink, RigidLinkChoices, Robot
from synth.task import PointTarget, Task

LENGTHS = (0.320, 0.365, 0.410, 0.455, 0.500, 0.545)  # m, of d35; d45 is 5 mm more
NAMES = ("A", "B", "C", "D", "E", "F")
CATALOGUE = RigidLinkChoices(NAMES, [RigidLink(d35, d35 + 0.005) for d35 in LENGTHS])
# m. Five targets fix the rigid link, but two that are nearly at one radius and height count as one; and the
# looser they are met, the more of the other rigid links do, too.
_APART, TOLERANCE = 0.1, 0.01e-3
RANGE = Interval(0.30, 0.60)  # m


def planted_rigid_link(seed: int, count: int = 5) -> tuple[Task, str]:
    """Return a task with a catalogue of six rigid links, and the name of the one that was planted."""
    rng = np.random.default_rng([seed, 21])
    robot = replace(ROBOT, rigid_links=CATALOGUE)
    right = int(rng.integers(len(NAMES)))
    planted = replace(robot, rigid_link=CATALOGUE.links[right])
    return Task(f"catalogue {seed}", robot, _reached(planted, count, rng, TOLERANCE, _APART)), NAMES[right]


def free_rigid_link(seed: int, count: int = 5) -> Task:
    """Return a task with d35 and d45 in ranges of 300 mm, which a planted arm does."""
    rng = np.random.default_rng([seed, 22])
    d35 = rng.uniform(RANGE.lower + 0.04, RANGE.upper - 0.04)
    d45 = d35 + rng.uniform(-0.03, 0.03)
    planted = replace(ROBOT, rigid_link=RigidLink(d35, d45))
    robot = replace(ROBOT, rigid_link=RigidLink(RANGE, RANGE))
    return Task(f"free rigid link {seed}", robot, _reached(planted, count, rng, 0.5e-3, 0.05))


def _reached(
    robot: Robot, count: int, rng: np.random.Generator, tolerance: float, apart: float
) -> list[PointTarget]:
    """Return targets that a random shape of a robot reaches, apart by as much in radius and height, m."""
    rigid = robot.rigid_link
    while True:
        arm = Arm(robot, random_shape(rng), rigid.d35.lower, rigid.d45.lower)
        points = reached_points(arm, 4 * count, rng) if feasible(arm) else np.empty((0, 3))
        meridian = np.column_stack([np.hypot(points[:, 0], points[:, 1]), points[:, 2]])
        chosen: list[int] = []
        for index, place in enumerate(meridian):
            if all(np.linalg.norm(place - meridian[other]) >= apart for other in chosen):
                chosen.append(index)
        if len(chosen) >= count:
            some = points[chosen[:count]]
            return [PointTarget(f"target {i + 1}", point, tolerance) for i, point in enumerate(some)]
