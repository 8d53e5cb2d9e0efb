"""Planted tasks with something in the way that the planted arm just keeps clear of.

Clearances are found here by brute force, at points half a millimetre apart, through nothing of the
package but the forward kinematics of the link.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from planted import ROBOT, planted_arm

from synth.geometry import Box, Capsule, Solid, Sphere
from synth.task import Obstacle, PointTarget, Task

if TYPE_CHECKING:
    from synth.robot import Arm

SPACING = 0.5e-3
LEAST, MOST = 2e-3, 60e-3  # clearance of the planted arm, m


def brute_distance(solid: Solid, points: np.ndarray) -> np.ndarray:
    """Return the signed distance of points, (..., 3), from a solid; by the textbook."""
    if isinstance(solid, Sphere):
        return np.sqrt(np.sum((points - solid.centre) ** 2, axis=-1)) - solid.radius
    if isinstance(solid, Capsule):
        start, end = solid.ends
        along = end - start
        t = np.clip((points - start) @ along / max(along @ along, 1e-30), 0, 1)
        return np.linalg.norm(points - (start + t[..., None] * along), axis=-1) - solid.radius
    c, s = np.cos(solid.yaw), np.sin(solid.yaw)
    local = (points - solid.centre) @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    beyond = np.abs(local) - solid.size / 2
    outside = np.sqrt(np.sum(np.clip(beyond, 0, None) ** 2, axis=-1))
    return np.where(outside > 0, outside, beyond.max(axis=-1))


def brute_curves(arm: Arm, theta1: float, theta2: float) -> tuple[np.ndarray, np.ndarray]:
    """Return points of the malleable link beyond its mount, and of the rigid one, in the task frame."""
    s = np.arange(0.5 * arm.robot.link.diameter, arm.shape.length, SPACING)
    link = arm.shape.point_at(np.append(s, arm.shape.length)) + [0, 0, arm.robot.d12]
    c, s = np.cos(theta1), np.sin(theta1)
    link = arm.base.to_task(link @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]))
    tip = arm.forward_kinematics(theta1, theta2)
    share = np.linspace(0, 1, 1000)[:, None]
    return link, link[-1] + share * (tip - link[-1])


def brute_clearance(arm: Arm, joints: np.ndarray, solids: list) -> float:
    """Return the least distance between an arm at all its joint angles and solids of the task frame."""
    least = np.inf
    for theta1, theta2 in joints:
        link, rod = brute_curves(arm, theta1, theta2)
        for solid in solids:
            least = min(
                least,
                brute_distance(solid, link).min() - 0.5 * arm.robot.link.diameter,
                brute_distance(solid, rod).min() - 0.5 * arm.robot.rigid_link.diameter,
            )
    return float(least)


def turn(yaw: float) -> np.ndarray:
    c, s = np.cos(yaw), np.sin(yaw)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def wall_with_window(rng: np.random.Generator, arm: Arm, joints: np.ndarray, _points: np.ndarray) -> dict:
    """Return a wall across the arm's way, with a window through which it reaches at every target."""
    yaw = rng.uniform(0, 2 * np.pi)
    distance, thickness = rng.uniform(0.12, 0.45), 0.02
    crossing = []
    for theta1, theta2 in joints:
        for points, radius in zip(brute_curves(arm, theta1, theta2), (0.025, 0.0), strict=True):
            local = points @ turn(yaw)
            near = local[np.abs(local[:, 0] - distance) < thickness / 2 + radius + LEAST]
            crossing += [near[:, 1:] - radius, near[:, 1:] + radius]
    crossing = np.vstack(crossing)
    if not len(crossing):
        return {}
    low, high = (
        crossing.min(axis=0) - rng.uniform(4e-3, 30e-3, 2),
        crossing.max(axis=0) + rng.uniform(4e-3, 30e-3, 2),
    )
    low[1] = max(low[1], 0.0)
    half, top = 1.2, 1.3
    if low[0] < -half + 0.05 or high[0] > half - 0.05 or np.prod(high - low) > 0.12:
        return {}
    pieces = {
        "left of the window": (-half, low[0], 0, top),
        "right of the window": (high[0], half, 0, top),
        "over the window": (low[0], high[0], high[1], top),
        "under the window": (low[0], high[0], 0, low[1]),
    }
    return {
        name: Box(turn(yaw) @ [distance, (a + b) / 2, (c + d) / 2], np.array([thickness, b - a, d - c]), yaw)
        for name, (a, b, c, d) in pieces.items()
        if d - c > 1e-3
    }


def shelf(rng: np.random.Generator, _arm: Arm, _joints: np.ndarray, points: np.ndarray) -> dict:
    """Return two boards and a back about the first target."""
    x, y, z = points[0]
    yaw = np.arctan2(y, x) + rng.uniform(-0.6, 0.6)
    below, above, depth, width = *rng.uniform(0.03, 0.12, 2), rng.uniform(0.15, 0.3), rng.uniform(0.3, 0.7)
    inside = rng.uniform(0.03, depth - 0.03)
    centre = np.array([x, y, z]) + turn(yaw) @ [depth / 2 - inside, rng.uniform(-0.1, 0.1), 0]
    boards = {"lower board": -below - 0.01, "upper board": above + 0.01}
    solids = {
        name: Box(centre + [0, 0, dz], np.array([depth, width, 0.02]), yaw) for name, dz in boards.items()
    }
    back = centre + turn(yaw) @ [depth / 2 + 0.01, 0, (above - below) / 2]
    return solids | {"back": Box(back, np.array([0.02, width, above + below + 0.04]), yaw)}


def crate(rng: np.random.Generator, _arm: Arm, _joints: np.ndarray, points: np.ndarray) -> dict:
    """Return a crate, open at the top, about the first target."""
    yaw = rng.uniform(0, np.pi)
    size, height = rng.uniform(0.15, 0.4, 2), rng.uniform(0.06, 0.25)
    inside = turn(yaw) @ [*(rng.uniform(-0.5, 0.5, 2) * (size - 0.06)), 0]
    floor = points[0] - [0, 0, rng.uniform(0.01, height - 0.02)] - inside
    wall = 0.015
    solids = {"bottom": Box(floor - [0, 0, wall / 2], np.array([*size, wall]), yaw)}
    for axis, name in enumerate(("front", "side")):
        for sign in (-1, 1):
            offset, extent = np.zeros(3), np.array([*(size + 2 * wall), height])
            offset[axis], extent[axis] = sign * (size[axis] + wall) / 2, wall
            offset[2] = height / 2
            solids[f"{name} {'-+'[sign > 0]}"] = Box(floor + turn(yaw) @ offset, extent, yaw)
    return solids


SCENES = {"window": wall_with_window, "shelf": shelf, "crate": crate}


def planted_with_obstacles(scene: str, seed: int) -> tuple[Task, Arm, np.ndarray]:
    """Return a task of 2 to 6 targets, the arm that was planted, and its joint angles."""
    rng = np.random.default_rng([seed, sorted(SCENES).index(scene)])
    limits = ROBOT.joint_limits
    while True:
        arm, count = planted_arm(rng), int(rng.integers(2, 7))
        # All targets on one side, so that one window serves them all.
        middle, spread = rng.uniform(1.0, 5.0), 0.25 if scene == "window" else 1.0
        joints = np.column_stack(
            [
                np.clip(middle + rng.uniform(-spread, spread, count), limits.base.lower, limits.base.upper),
                rng.uniform(limits.second.lower, limits.second.upper, count),
            ]
        )
        points = arm.forward_kinematics(joints[:, 0], joints[:, 1])
        if points[:, 2].min() < 0.02:
            continue
        for _ in range(20):
            solids = SCENES[scene](rng, arm, joints, points)
            if solids and LEAST <= brute_clearance(arm, joints, list(solids.values())) <= MOST:
                targets = tuple(PointTarget(f"target {i + 1}", p, 0.5e-3) for i, p in enumerate(points))
                obstacles = tuple(Obstacle(name, solid) for name, solid in solids.items())
                return Task(f"{scene} {seed}", ROBOT, targets, obstacles=obstacles), arm, joints


def without_obstacles(task: Task) -> Task:
    return replace(task, obstacles=())
