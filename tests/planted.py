"""Tasks with a known answer: a random feasible shape, and targets at random joint angles of it.

The shapes are drawn on their own, through nothing of the synthesis: links of three to six arcs of
unequal length, which the solver's four equal arcs can only imitate.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.optimize import least_squares

from synth.robot import PRESETS, Arm, ArmBody, LinkShape, Robot, clear_of_tube
from synth.task import PointTarget, TargetTable, Task, Topology

ROBOT = PRESETS["malleable-2dof"]


def feasible(arm: Arm, floor: float = 0.0) -> bool:
    """Whether the hardware can take a shape above the floor, by samples a millimetre apart."""
    link, shape = arm.robot.link, arm.shape
    s = np.arange(0.5 * link.diameter, shape.length, 1e-3)
    heights = arm.robot.d12 + shape.point_at(np.append(s, shape.length))[:, 2]
    return bool(
        link.length.contains(shape.length)
        and shape.bends.max() <= link.max_curvature * (1.0 + 1e-12)
        and shape.total_bend <= link.max_total_bend + 1e-12
        and heights.min() - 0.5 * link.diameter >= floor - 2e-6
        and arm.axis_points[2:, 2].min() >= floor
    )


def random_shape(rng: np.random.Generator) -> LinkShape:
    arcs = int(rng.integers(3, 7))
    length = rng.uniform(ROBOT.link.length.lower, ROBOT.link.length.upper)
    bends = np.sqrt(rng.uniform(size=arcs)) * ROBOT.link.max_curvature
    turns = rng.uniform(0.0, 2.0 * np.pi, arcs)
    shares = rng.uniform(0.5, 1.5, arcs)
    curvatures = bends[:, None] * np.column_stack([np.cos(turns), np.sin(turns)])
    return LinkShape(curvatures, length * shares / shares.sum())


def arm_of(shape: LinkShape) -> Arm:
    return Arm(ROBOT, shape, ROBOT.rigid_link.d35.lower, ROBOT.rigid_link.d45.lower)


def planted_arm(rng: np.random.Generator, topology: Topology = Topology.ANY) -> Arm:
    """Return a feasible arm, exactly of the topology asked for."""
    while True:
        arm = arm_of(random_shape(rng))
        if topology is not Topology.ANY:
            arm = _bent_into(arm, topology)
        if arm is not None and feasible(arm):
            return arm


def reached_points(arm: Arm, count: int, rng: np.random.Generator) -> np.ndarray:
    """Return points above the floor at random joint angles at which the arm is clear: `count` at most."""
    limits = ROBOT.joint_limits
    theta1 = rng.uniform(limits.base.lower, limits.base.upper, 50 * count)
    theta2 = rng.uniform(limits.second.lower, limits.second.upper, 50 * count)
    points = arm.forward_kinematics(theta1, theta2)
    return points[(points[:, 2] >= 0.0) & (clear_of_tube(ArmBody(arm), theta2) > 0.0)][:count]


def planted_task(seed: int, count: int | None = None, topology: Topology = Topology.ANY) -> tuple[Task, Arm]:
    """Return a task with 1 to 20 exact targets above the floor, and the arm that was planted."""
    rng = np.random.default_rng(seed)
    count = count or int(rng.integers(1, 21))
    while True:
        arm = planted_arm(rng, topology)
        points = reached_points(arm, count, rng)
        if len(points) == count:
            break
    targets = tuple(PointTarget(f"target {i + 1}", point, 0.5e-3) for i, point in enumerate(points))
    return Task(f"planted {seed}", ROBOT, targets), arm


def noisy(seed: int, count: int = 8, robot: Robot = ROBOT, noise: float = 0.02, **changes: object) -> Task:
    """Return a planted task whose targets are off by a normal error of each coordinate, m; no floor."""
    task, _ = planted_task(seed, count)
    shifts = np.random.default_rng(seed).normal(scale=noise, size=(count, 3))
    targets = [PointTarget(t.name, t.position + n, 0.5e-3) for t, n in zip(task.targets, shifts, strict=True)]
    return Task("noisy", robot, tuple(targets), floor=None, **changes)


def scanned(
    count: int, noise: float = 1e-3, seed: int = 3, tolerance: float = 5e-3, **changes: object
) -> tuple[Task, Arm]:
    """Return points at random joint angles of a planted arm, off its surface by noise, m; and the arm."""
    task, arm = planted_task(seed, 4)
    rng, limits = np.random.default_rng(seed), task.robot.joint_limits
    theta1 = rng.uniform(limits.base.lower + 0.05, limits.base.upper - 0.05, 2 * count)
    theta2 = rng.uniform(limits.second.lower + 0.05, limits.second.upper - 0.05, 2 * count)
    theta2 = theta2[clear_of_tube(ArmBody(arm), theta2) > 0.0]
    points = arm.forward_kinematics(theta1[: len(theta2)], theta2)[:count]
    points += rng.normal(0.0, noise, points.shape)
    table = TargetTable(
        [f"point {i}" for i in range(len(points))],
        points,
        np.full(len(points), tolerance),
        np.ones(len(points)),
    )
    return replace(task, targets=table, floor=None, **changes), arm


def nearly_special_task(seed: int, tolerance: float) -> Task:
    """Return a task whose exact answer has axes that nearly meet, or are nearly parallel: two sheets."""
    rng = np.random.default_rng([seed, 99])
    topology = (Topology.SPHERICAL, Topology.PUMA, Topology.SCARA)[seed % 3]
    while True:
        special = planted_arm(rng, topology).shape
        bent = rng.normal(size=special.curvatures.shape) * rng.choice([0.005, 0.02, 0.05])
        arm = arm_of(LinkShape(special.curvatures + bent, special.lengths))
        if not feasible(arm):
            continue
        count = int(rng.integers(5, 16))
        points = reached_points(arm, count, rng)
        if len(points) == count:
            targets = tuple(
                PointTarget(f"target {i + 1}", point, tolerance) for i, point in enumerate(points)
            )
            return Task(f"nearly special {seed}", ROBOT, targets)


def out_of_reach(seed: int) -> Task:
    """Return a planted task with one target moved beyond what any shape can reach."""
    task, _ = planted_task(seed)
    rng = np.random.default_rng([seed, 1])
    direction = rng.normal(size=3)
    direction[2] = abs(direction[2])
    # Link and rigid link, stretched out from P2, reach 0.7 m + 0.457 m.
    distance = rng.uniform(1.16, 1.5)
    far = np.array([0.0, 0.0, ROBOT.d12]) + distance * direction / np.linalg.norm(direction)
    victim = int(rng.integers(len(task.targets)))
    targets = list(task.targets)
    targets[victim] = replace(targets[victim], position=far)
    return replace(task, targets=tuple(targets))


def _bent_into(arm: Arm, topology: Topology) -> Arm | None:
    """Bend a link until its axes meet, or are parallel, to rounding."""
    lengths = arm.shape.lengths

    def bent(curvatures: np.ndarray) -> Arm:
        return arm_of(LinkShape(curvatures.reshape(-1, 2), lengths))

    def off(curvatures: np.ndarray) -> np.ndarray:
        frame, position = bent(curvatures).end_frame
        if topology is Topology.SCARA:
            return frame[:2, 0]
        meeting = np.array([0.0, 0.0, 0.0 if topology is Topology.SPHERICAL else ROBOT.d12])
        return frame[:, 1:].T @ (position - meeting)

    answer = least_squares(off, arm.shape.curvatures.ravel(), xtol=1e-15, ftol=1e-15, gtol=1e-15)
    return bent(answer.x) if np.abs(answer.fun).max() < 1e-10 else None
