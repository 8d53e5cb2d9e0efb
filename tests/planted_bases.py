"""Tasks whose base is free, with a known answer: a planted arm at a random place, and targets it reaches."""

from __future__ import annotations

import numpy as np
from planted import ROBOT, planted_arm, reached_points

from synth.robot import BaseChoices, BasePose, BaseRange, Interval
from synth.task import PointTarget, Task

WIDTH = 0.4  # m
LEANING = np.radians(20.0)


def planted_base(seed: int, count: int = 8, leaning: float = 0.0) -> tuple[Task, BasePose]:
    """Return a task with the base anywhere in 400 mm and turned by anything, and maybe leaning a little."""
    rng = np.random.default_rng([seed, 7])
    middle = rng.uniform(-1.0, 1.0, 3)
    coordinates = [Interval(*(centre + np.array([-0.5, 0.5]) * WIDTH)) for centre in middle]
    angles = [Interval(-leaning, leaning), Interval(-leaning, leaning), Interval(-np.pi, np.pi)]
    places = BaseRange(*coordinates, *angles)
    while True:
        arm = planted_arm(rng)
        points = reached_points(arm, count, rng)
        if len(points) == count:
            break
    base = places.pose(places.sample(1, rng)[0])
    targets = [PointTarget(f"target {i + 1}", point, 0.5e-3) for i, point in enumerate(base.to_task(points))]
    floor = {} if leaning == 0.0 else {"floor": None}
    return Task(f"planted base {seed}", ROBOT, targets, places=places, **floor), base


def planted_choice(seed: int, count: int = 5, choices: int = 5) -> tuple[Task, str]:
    """Return a task with places of which one was planted, and its name."""
    rng = np.random.default_rng([seed, 8])
    task, planted = planted_base(seed, count)
    names, right = [f"place {i + 1}" for i in range(choices)], int(rng.integers(choices))
    poses = [task.places.pose(row) for row in task.places.sample(choices, rng)]
    poses[right] = planted
    places = BaseChoices(names, poses)
    return Task(f"planted choice {seed}", ROBOT, task.targets, places=places), names[right]
