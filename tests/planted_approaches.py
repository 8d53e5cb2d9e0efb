"""Tasks that say in which direction the rigid link arrives, with a known answer."""

from __future__ import annotations

import numpy as np
from planted import ROBOT, planted_arm

from synth.robot import ArmBody, clear_of_tube
from synth.task import Approach, PointTarget, Task


def planted_approach(seed: int, count: int = 1, tolerance: float = np.radians(1.0)) -> Task:
    """Return a task whose targets a planted arm reaches in directions that are off by up to the tolerance."""
    rng = np.random.default_rng([seed, 11])
    limits = ROBOT.joint_limits
    while True:
        arm = planted_arm(rng)
        joints = np.column_stack(
            [rng.uniform(each.lower, each.upper, 40 * count) for each in (limits.base, limits.second)]
        )
        points = arm.forward_kinematics(*joints.T)
        good = (points[:, 2] >= 0.0) & (clear_of_tube(ArmBody(arm), joints[:, 1]) > 0.0)
        if good.sum() < count:
            continue
        targets = []
        for index in np.flatnonzero(good)[:count]:
            pointing = pointing_of(arm, joints[index])
            across = np.cross(pointing, rng.normal(size=3))
            across /= np.linalg.norm(across)
            off = rng.uniform(0.0, 0.9 * tolerance)
            direction = np.cos(off) * pointing + np.sin(off) * across
            target = PointTarget(
                f"target {len(targets) + 1}", points[index], 0.5e-3, 1.0, Approach(direction, tolerance)
            )
            targets.append(target)
        return Task(f"planted approach {seed}", ROBOT, targets)


def pointing_of(arm, joints: np.ndarray) -> np.ndarray:
    """Return the direction from axis 2 to P5, by points alone."""
    frame, end = arm.end_frame
    c, s = np.cos(joints[0]), np.sin(joints[0])
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    point, axis = arm.forward_kinematics(*joints), turn @ frame[:, 0]
    from_end = arm.base.to_base(point) - turn @ end
    across = from_end - (from_end @ axis) * axis
    return arm.base.rotation @ (across / np.linalg.norm(across))
