"""The noisy tasks of `peers.py` and `noisy.py`: targets that no shape reaches exactly.

They are drawn here, through nothing of tests/planted.py: the record of the least misses holds for these.
"""

from __future__ import annotations

import numpy as np

from synth.robot import PRESETS, Arm, LinkShape
from synth.task import PointTarget, Task

ROBOT = PRESETS["malleable-2dof"]
NOISE = 0.03  # standard deviation of each coordinate of a target, m
FEWEST, MOST = 6, 40


def _random_arm(rng: np.random.Generator) -> Arm:
    """Return an arm with a link of three to six arcs, within its limits, its centreline above the base."""
    link, rigid = ROBOT.link, ROBOT.rigid_link
    while True:
        arcs = int(rng.integers(3, 7))
        length = rng.uniform(link.length.lower, link.length.upper)
        bends = np.sqrt(rng.uniform(size=arcs)) * link.max_curvature
        turns = rng.uniform(0.0, 2.0 * np.pi, arcs)
        shares = rng.uniform(0.5, 1.5, arcs)
        curvatures = bends[:, None] * np.column_stack([np.cos(turns), np.sin(turns)])
        shape = LinkShape(curvatures, length * shares / shares.sum())
        arm = Arm(ROBOT, shape, rigid.d35.lower, rigid.d45.lower)
        above = ROBOT.d12 + shape.lowest() >= 0.0 and arm.axis_points[2:, 2].min() >= 0.0
        if above and shape.total_bend <= link.max_total_bend:
            return arm


def noisy_task(seed: int, count: int | None = None) -> Task:
    """Return 6 to 40 points within reach of a random arm, each off by a normal error of 30 mm; no floor."""
    count = count or int(np.random.default_rng([seed, 3]).integers(FEWEST, MOST + 1))
    rng, limits = np.random.default_rng(seed), ROBOT.joint_limits
    points = np.empty((0, 3))
    while len(points) < count:
        arm = _random_arm(rng)
        theta1 = rng.uniform(limits.base.lower, limits.base.upper, 50 * count)
        theta2 = rng.uniform(limits.second.lower, limits.second.upper, 50 * count)
        points = arm.forward_kinematics(theta1, theta2)
        points = points[points[:, 2] >= 0.0][:count]
    points = points + np.random.default_rng([seed, 2]).normal(scale=NOISE, size=(count, 3))
    targets = tuple(PointTarget(f"target {i + 1}", point, 0.5e-3) for i, point in enumerate(points))
    return Task(f"noisy {seed}", ROBOT, targets, floor=None)
