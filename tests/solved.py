"""Tasks to be solved, and their misses by a computation of its own."""

from dataclasses import replace

import numpy as np
from oracle_kinematics import rotation as turn_by
from planted import planted_task

from synth.task import PointTarget


def points(*positions, tolerance=1e-3):
    return tuple(PointTarget(f"target {i}", position, tolerance) for i, position in enumerate(positions, 1))


def noisy(seed, count, scale, **changes):
    """Return a planted task whose targets are off by a normal error: it has no exact answer."""
    task, _ = planted_task(seed, count)
    shifts = np.random.default_rng([seed, 2]).normal(scale=scale, size=(count, 3))
    targets = tuple(
        replace(target, position=target.position + shift)
        for target, shift in zip(task.targets, shifts, strict=True)
    )
    return replace(task, targets=targets, floor=None, **changes)


def independent_misses(solution):
    """Recompute the misses from arcs and joints, by the formulas of the file format alone."""
    arm, misses = solution.robot, []
    for target in solution.targets:
        rotation, p = np.eye(3), np.array([0.0, 0.0, arm.robot.d12])
        for (kx, ky), length in zip(arm.shape.curvatures, arm.shape.lengths, strict=True):
            for _ in range(2000):  # Euler's method about the middle of each step
                step = length / 2000
                half = rotation @ turn_by(np.array([-ky, kx, 0.0]) * step / 2)
                p = p + half[:, 2] * step
                rotation = rotation @ turn_by(np.array([-ky, kx, 0.0]) * step)
        u, t = rotation[:, 0], rotation[:, 2]
        s34, s35, s45 = arm.robot.d34**2, arm.d35**2, arm.d45**2
        along = (s35 - s45 + s34) / (2.0 * arm.robot.d34)
        centre = p - arm.robot.tip_offset * u + along * u
        theta1, theta2 = target.joints
        on_circle = centre + np.sqrt(s35 - along**2) * (-np.cos(theta2) * t - np.sin(theta2) * np.cross(u, t))
        turned = turn_by(np.array([0.0, 0.0, theta1])) @ on_circle
        base = solution.task.base
        reached = turn_by(np.array([0.0, 0.0, base.yaw])) @ turned + base.position
        misses.append(np.linalg.norm(reached - target.position))
    return np.array(misses)
