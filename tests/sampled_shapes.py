"""Shapes at random, and boxes of parameters drawn around them: what a bound must hold for."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from planted import planted_task

from synth.synthesis.bound.boxes import _CHARTS, Boxes
from synth.synthesis.bound.misses import MissBounds
from synth.synthesis.shapes.shapes import Shapes, into_limits
from synth.task import PointTarget, Task


def noisy_task(seed, count=None, least=0.01, most=0.03):
    """A planted task whose targets are moved by noise, m, so that no shape meets them."""
    rng = np.random.default_rng([seed, 7])
    count = count or int(rng.integers(4, 9))
    noise = rng.uniform(least, most)
    task, _ = planted_task(seed, count)
    targets = []
    for target in task.targets:
        direction = rng.normal(size=3)
        position = target.position + noise * direction / np.linalg.norm(direction)
        position[2] = max(position[2], 0.0)
        targets.append(PointTarget(target.name, position, 1e-3))
    return replace(task, targets=tuple(targets))


def shapes_about(robot, count, rng):
    """Shapes in the limits of the link that differ from one of them by little or much."""
    drawn = Shapes.sample(robot, count, rng).unknowns
    share = 10.0 ** rng.uniform(-3.0, 0.0, (count, 1))
    return Shapes(robot, into_limits(robot, drawn[0] + share * (drawn - drawn[0])))


def task_about(shapes, count, rng, noise=0.02):
    """A task of points near the workspace of the first shape, at random angles within the joint limits."""
    robot, limits = shapes.robot, shapes.robot.joint_limits
    theta1 = rng.uniform(limits.base.lower, limits.base.upper, count)
    theta2 = rng.uniform(limits.second.lower, limits.second.upper, count)
    points = shapes.take(np.array([0])).kinematics.each_target().forward(theta1, theta2)[0]
    points = points + noise * rng.uniform() * rng.normal(size=points.shape)
    tolerances = 1e-3 * rng.uniform(1.0, 2.0, count)
    targets = [
        PointTarget(f"{i}", point, tol) for i, (point, tol) in enumerate(zip(points, tolerances, strict=True))
    ]
    return Task("about a shape", robot, tuple(targets), floor=None)


def parameters(shapes):
    """Chart and (rho, h, alpha, beta, psi) of shapes, after a turn about axis 1 and a reflection."""
    frame, p = shapes.end
    azimuth = np.arctan2(p[:, 1], p[:, 0])
    cos, sin, zero, one = np.cos(azimuth), np.sin(azimuth), np.zeros(len(p)), np.ones(len(p))
    back = np.array([[cos, sin, zero], [-sin, cos, zero], [zero, zero, one]]).transpose(2, 0, 1)
    u, t = ((back @ frame[..., column, None])[..., 0] for column in (0, 2))
    mirror = np.where(u[:, 1] < 0.0, -1.0, 1.0)
    u[:, 1] *= mirror
    t[:, 1] *= mirror
    largest = np.argmax(np.abs(u), axis=1)
    chart = np.choose(largest, [np.where(u[:, 0] > 0.0, 1, 2), 0, np.where(u[:, 2] > 0.0, 3, 4)])
    middle, sign, towards_a, towards_b = (np.array([c[i] for c in _CHARTS])[chart] for i in range(4))
    rows = np.arange(len(u))
    alpha = np.arcsin(np.clip(u[rows, towards_a], -1.0, 1.0))
    beta = np.arctan2(u[rows, towards_b], sign * u[rows, middle.astype(int)])
    found = np.stack([np.hypot(p[:, 0], p[:, 1]), p[:, 2], alpha, beta, np.zeros(len(u))], axis=-1)
    at = boxes_at(chart, found, np.zeros_like(found))
    _, e1, e2 = at.frame
    assert np.allclose(at.frame[0], u, atol=1e-9)
    found[:, 4] = np.arctan2(np.einsum("bi,bi->b", t, e2), np.einsum("bi,bi->b", t, e1))
    return chart, found


def boxes_at(chart, middle, half):
    numbers = np.arange(len(chart))
    return Boxes(chart, middle, half, np.zeros(len(chart)), np.zeros(len(chart), dtype=bool), numbers)


def worst_misses(task, shapes):
    """The worst weighted miss of each shape, by forward kinematics at many angles of joint 2."""
    factors = task.tolerances.min() / task.tolerances
    second = task.robot.joint_limits.second
    points = shapes.kinematics.each_target().forward(0.0, np.linspace(second.lower, second.upper, 3001))
    rho, z = np.hypot(points[..., 0], points[..., 1]), points[..., 2]
    worst = np.zeros(len(rho))
    for (x, y, height), factor in zip(task.positions_in_base, factors, strict=True):
        worst = np.maximum(worst, factor * np.hypot(rho - np.hypot(x, y), z - height).min(axis=1))
    return worst


def contradictions(task, shapes, rng):
    """How many shapes contradict the bounds of boxes around them, of how many, and bounds over misses."""
    chart, where = parameters(shapes)
    count = len(chart)
    size = 10.0 ** rng.uniform(-4.5, -0.5, (count, 1)) * rng.uniform(0.2, 1.0, (count, 5))
    psi_half = np.where(rng.uniform(size=count) < 0.5, np.pi, size[:, 4])
    size[:, 4] = psi_half
    inside = rng.uniform(-1.0, 1.0, (count, 5))
    inside[:, :4] = np.where(rng.uniform(size=(count, 4)) < 0.1, np.sign(inside[:, :4]), inside[:, :4])
    middle = where - inside * size
    middle[:, 4] = np.where(psi_half == np.pi, 0.0, middle[:, 4])
    # A box does not reach beyond axis 1, nor psi beyond a turn.
    lower = np.maximum(middle - size, [0.0, -np.inf, -np.inf, -np.inf, -np.pi])
    upper = np.minimum(middle + size, [np.inf, np.inf, np.inf, np.inf, np.pi])
    boxes = boxes_at(chart, 0.5 * (lower + upper), 0.5 * (upper - lower))
    worst = worst_misses(task, shapes)
    bounds = MissBounds(task, np.arange(len(task.targets)), task.tolerances.min() / task.tolerances)
    wrong, asked, ratios = 0, 0, []
    for enough in np.quantile(worst, [0.1, 0.5, 0.9]):
        rows = np.flatnonzero(worst < enough)
        left = bounds.evaluate(boxes.take(rows), enough)
        after = np.full(len(rows), -1)
        after[left.origin] = np.arange(len(left))
        below = left.bound[after] <= worst[rows] + 1e-12
        within = (np.abs(where[rows] - left.middle[after]) <= left.half[after] + 1e-9).all(axis=1)
        wrong += int(np.count_nonzero(~((after >= 0) & below & within)))
        asked += len(rows)
        ratios.append((left.bound[after] / worst[rows])[left.bound[after] > 0.0])
    return wrong, asked, np.concatenate(ratios)
