"""Paths with a known answer: what a planted arm's end effector passes as its joints turn smoothly."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from planted_surfaces import patch

from synth.paths import Interpolation, Path
from synth.task import Task, sampled

if TYPE_CHECKING:
    from synth.robot import Arm


def joint_curve(seed: int, low: np.ndarray, high: np.ndarray, count: int) -> np.ndarray:
    """Return joint angles along a smooth curve within a patch, shape (count, 2), rad."""
    rng = np.random.default_rng([seed, 31])
    s = np.linspace(0.0, 1.0, count)[:, None]
    waves = rng.uniform(-1.0, 1.0, (3, 2)) * np.array([[1.0], [0.5], [0.3]])
    phases = rng.uniform(0.0, 2.0 * np.pi, (3, 2))
    curve = sum(
        w * np.sin((k + 1) * np.pi * s + p) for k, (w, p) in enumerate(zip(waves, phases, strict=True))
    )
    curve = (curve - curve.min(axis=0)) / np.ptp(curve, axis=0)
    return low + curve * (high - low)


def path_task(name: str, robot: object, *paths: Path, **changes: object) -> Task:
    return Task(name, robot, sampled(paths=paths), paths=paths, **({"floor": None} | changes))


def planted_path(seed: int, *, spline: bool = False, **changes: object) -> tuple[Task, Arm]:
    """Return a task with a path of 200 waypoints, or of 20 with a spline through them, and its arm."""
    arm, (low, high) = patch(seed)
    joints = joint_curve(seed, low, high, 20 if spline else 200)
    waypoints = arm.forward_kinematics(joints[:, 0], joints[:, 1])
    interpolation = Interpolation.SPLINE if spline else Interpolation.STRAIGHT
    path = Path("path", waypoints, interpolation=interpolation, **({"tolerance": 1e-3} | changes))
    return path_task(f"path {seed}", arm.robot, path), arm
