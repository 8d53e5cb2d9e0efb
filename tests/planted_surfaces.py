"""Surfaces with a known answer: patches of a planted arm's workspace, as points or triangles, and tori."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from planted import ROBOT, arm_of, feasible, planted_arm, random_shape

from synth.robot import Arm, ArmBody, clear_of_tube
from synth.surfaces import Profile, Revolved, Scan, Surface, TriangleMesh
from synth.task import Task, sampled

OUTLIERS = 0.1  # m, off the surface, normal in each coordinate


def patch(seed: int) -> tuple[Arm, tuple[np.ndarray, np.ndarray]]:
    """Return a planted arm and the ends of the joint angles of a patch, in which it is clear of itself."""
    rng = np.random.default_rng([seed, 12])
    while True:
        arm = planted_arm(rng)
        widths = rng.uniform([0.6, 0.5], [2.0, 1.5])
        limits = ROBOT.joint_limits
        lowest = np.array([limits.base.lower, limits.second.lower]) + 0.1
        highest = np.array([limits.base.upper, limits.second.upper]) - 0.1 - widths
        low = rng.uniform(lowest, highest)
        theta2 = np.linspace(low[1], low[1] + widths[1], 60)
        clear = clear_of_tube(ArmBody(arm), theta2) > 0.0
        above = arm.forward_kinematics(0.0, theta2)[:, 2] > 0.0
        if clear.all() and above.all():
            return arm, (low, low + widths)


def as_task(name: str, *surfaces: Surface) -> Task:
    return Task(name, ROBOT, sampled(surfaces), surfaces=surfaces, floor=None)


def as_points(
    seed: int, count: int = 600, noise: float = 0.0, outliers: float = 0.0, **changes: object
) -> tuple[Task, Arm, np.ndarray]:
    """Return a patch as points, its arm, and which points are no outliers."""
    arm, (low, high) = patch(seed)
    rng = np.random.default_rng([seed, 13])
    joints = rng.uniform(low, high, (count, 2))
    points = arm.forward_kinematics(joints[:, 0], joints[:, 1])
    points = points + rng.normal(0.0, noise, points.shape) if noise else points
    wrong = rng.choice(count, int(outliers * count), replace=False)
    points[wrong] += rng.normal(0.0, OUTLIERS, (len(wrong), 3))
    given = {"tolerance": max(5.0 * noise, 5e-4), "coverage": 1.0 if not outliers else 1.0 - outliers}
    surface = Surface("scan", Scan(points), **(given | changes))
    return as_task(f"points {seed}", surface), arm, np.setdiff1d(np.arange(count), wrong)


def as_mesh(seed: int, cells: int = 80, **changes: object) -> tuple[Task, Arm]:
    """Return a patch as triangles, and its arm."""
    arm, (low, high) = patch(seed)
    theta1, theta2 = (np.linspace(a, b, cells + 1) for a, b in zip(low, high, strict=True))
    grid = arm.forward_kinematics(theta1[:, None], theta2[None])
    a, b, c, d = grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]
    corners = np.concatenate([np.stack([a, b, c], axis=2), np.stack([a, c, d], axis=2)]).reshape(-1, 3, 3)
    surface = Surface("mesh", TriangleMesh(corners), **({"tolerance": 1e-3} | changes))
    return as_task(f"mesh {seed}", surface), arm


def as_torus(seed: int, **changes: object) -> Task:
    """Return the outer part of a torus about axis 1 that a planted arm sweeps: its axes are at right angles.

    P5 then describes a circle in a plane with axis 1, and the torus is the circle turned about it.
    """
    rng = np.random.default_rng([seed, 14])
    while True:
        arm = _across(rng)
        if arm is None:
            continue
        centre, radius = arm.kinematics.centre, float(arm.kinematics.radius)
        if np.hypot(*centre[:2]) > radius + 0.02:
            break
    torus = Revolved(Profile.TORUS, float(np.hypot(*centre[:2])), radius)
    surface = Surface(
        "torus",
        torus,
        position=np.array([0.0, 0.0, centre[2]]),
        **({"tolerance": 1e-3, "coverage": 0.25} | changes),
    )
    return as_task(f"torus {seed}", surface)


def _across(rng: np.random.Generator) -> Arm | None:
    """Return a feasible arm whose circle lies in a half-plane of axis 1, or None."""
    from scipy.optimize import least_squares  # noqa: PLC0415

    shape = random_shape(rng)

    def bent(unknowns: np.ndarray) -> Arm:
        return arm_of(replace(shape, curvatures=unknowns.reshape(-1, 2)))

    def off(unknowns: np.ndarray) -> np.ndarray:
        arm = bent(unknowns)
        axis, centre = arm.end_frame[0][:, 0], arm.kinematics.centre
        # Axis 2 is level, and at right angles to the way from axis 1 to the middle of the circle.
        return np.array([axis[2], axis[:2] @ centre[:2]])

    answer = least_squares(off, shape.curvatures.ravel(), xtol=1e-15, ftol=1e-15, gtol=1e-15)
    arm = bent(answer.x)
    return arm if np.abs(answer.fun).max() < 1e-10 and feasible(arm) else None
