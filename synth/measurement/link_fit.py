"""Whether the malleable link can take a measured pose: an explicit shape, or how near one came."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from synth.robot import Arm, BasePose
from synth.synthesis.population import Population, into_limits

if TYPE_CHECKING:
    from synth.arrays import FloatArray
    from synth.robot import Robot
    from synth.task.measured import MeasuredDistances

PAIRS = ("d13", "d14", "d23", "d24")
_DRAWN = 30_000
_STARTS = 64
_ITERATIONS = 80
_DIFFERENCE = 1e-6  # step of the finite differences over the unknowns, which are of order one
_ROUNDING = 2e-8  # m
_LENGTH_SLACK = 1e-9
# How closely distances that are aimed at are met, m: near parallel axes 1e-6 would still be 1 deg.
_AIM = 1e-8


@dataclass(frozen=True, eq=False)
class LinkFit:
    """A shape of the link for a measured pose.

    Attributes:
        arm: The robot with its link in the best shape found.
        beyond: By how much its worst distance is beyond the bounds of the measurement, m; 0 if the link
            can take the pose.
        obstacle: Why no shape at all can, if that is certain; else empty.
    """

    arm: Arm
    beyond: float
    obstacle: str = ""

    @property
    def found(self) -> bool:
        """Whether the shape keeps the limits of the link and all bounds of the measurement."""
        return self.beyond == 0.0 and not self.obstacle


def fit_link(
    robot: Robot, distances: MeasuredDistances, rng: np.random.Generator, aim: FloatArray | None = None
) -> LinkFit:
    """Return the gentlest shape found with which P3 and P4 are where they were measured.

    The link leaves P2 along axis 1 and ends on axis 2, its end frame's x axis along it. How it is turned
    about axis 1 is what distances leave open, and so is which mirror image it is: its shape is right if
    d13, d14, d23 and d24 are. Random shapes are improved together by damped Gauss-Newton steps until
    these distances are within their bounds.

    Args:
        robot: The hardware, with d12 and d34 as measured.
        distances: What was measured.
        rng: Source of randomness.
        aim: Realisable values of d13, d14, d23, d24 to be met if the link can, shape (4,), m; the bounds
            are resorted to only if it cannot.

    Returns:
        The shape, checked by the arm's own forward kinematics, or the one that came nearest. Only
        `LinkFit.obstacle` proves that there is none.
    """
    k = [distances.names.index(name) for name in PAIRS]
    lower, upper = distances.lower[k], distances.upper[k]
    population = Population.sample(robot, _DRAWN, rng)
    apart = _in_any_frame(_distances(population)) - _in_any_frame(0.5 * (lower + upper))
    nearest = np.argsort(np.linalg.norm(apart, axis=1), kind="stable")[:_STARTS]
    population = population.take(nearest)
    obstacle = _obstacle(robot, lower[2:])
    if aim is not None:
        fit = _best(_improved(population, aim - _AIM, aim + _AIM), aim, aim)
        if fit.found:
            return fit
    return replace(_best(_improved(population, lower, upper), lower, upper), obstacle=obstacle)


def _best(population: Population, lower: FloatArray, upper: FloatArray) -> LinkFit:
    """Return the gentlest shape within the bounds or, if there is none, the nearest one."""
    arms = [population.arm(index, BasePose()) for index in range(len(population.unknowns))]
    beyond = np.array([_beyond(arm, lower, upper) for arm in arms])
    energy = np.where(beyond == 0.0, population.bending, np.inf)
    best = int(np.argmin(energy) if np.isfinite(energy).any() else np.argmin(beyond))
    return LinkFit(arms[best], float(beyond[best]))


def _distances(population: Population) -> FloatArray:
    """Return d13, d14, d23, d24 of shapes, (..., 4), m."""
    robot = population.robot
    frame, end = population.end
    p3 = end - robot.tip_offset * frame[..., 0]
    p4 = p3 + robot.d34 * frame[..., 0]
    p2 = np.array([0.0, 0.0, robot.d12])
    return np.stack([np.linalg.norm(v, axis=-1) for v in (p3, p4, p3 - p2, p4 - p2)], axis=-1)


def _in_any_frame(d: FloatArray) -> FloatArray:
    """Return a length and three differences, which the short baselines make worth ten times as much."""
    d13, d14, d23, d24 = np.moveaxis(d, -1, 0)
    return np.stack([d13, 10.0 * (d14 - d13), 10.0 * (d23 - d13), 10.0 * (d24 - d14)], axis=-1)


def _improved(population: Population, lower: FloatArray, upper: FloatArray) -> Population:
    robot, x = population.robot, population.unknowns
    count = x.shape[-1]
    damping = np.full(len(x), 1e-3)
    off = _off(population, lower, upper)
    for _ in range(_ITERATIONS):
        if not off.any():
            break
        nearby = _distances(Population(robot, x[:, None] + _DIFFERENCE * np.eye(count)))
        jacobian = (nearby - _distances(Population(robot, x))[:, None]) / _DIFFERENCE
        jacobian = jacobian * (off != 0.0)[:, None]  # within its bounds a distance is free
        normal = np.einsum("apk,aqk->apq", jacobian, jacobian)
        slope = np.einsum("apk,ak->ap", jacobian, off)
        diagonal = np.einsum("app->ap", normal)
        scale = diagonal + 1e-3 * diagonal.max(axis=1, keepdims=True) + 1e-12
        damped = normal + damping[:, None, None] * scale[:, :, None] * np.eye(count)
        step = -np.linalg.solve(damped, slope[..., None])[..., 0]
        moved = into_limits(robot, x + step)
        moved_off = _off(Population(robot, moved), lower, upper)
        better = np.sum(moved_off**2, axis=1) < np.sum(off**2, axis=1)
        x, off = np.where(better[:, None], moved, x), np.where(better[:, None], moved_off, off)
        damping = np.clip(np.where(better, 0.2 * damping, 8.0 * damping), 1e-9, 1e9)
    return Population(robot, x)


def _off(population: Population, lower: FloatArray, upper: FloatArray) -> FloatArray:
    d = _distances(population)
    return np.asarray(d - np.clip(d, lower, upper))


def _beyond(arm: Arm, lower: FloatArray, upper: FloatArray) -> float:
    """Return the worst excess of a shape that keeps the link's limits, by the arm's own kinematics."""
    link, shape = arm.robot.link, arm.shape
    if not (
        link.length.contains(shape.length, _LENGTH_SLACK)
        and shape.bends.max() <= link.max_curvature * (1.0 + 1e-9)
        and shape.total_bend <= link.max_total_bend * (1.0 + 1e-9)
    ):
        return np.inf
    d = np.sqrt(arm.squared_distances[[0, 0, 1, 1], [2, 3, 2, 3]])
    worst = float(np.max(np.maximum(lower - d, d - upper)))
    return worst if worst > _ROUNDING else 0.0


def _obstacle(robot: Robot, lower: FloatArray) -> str:
    """Return why no link can be long enough, or nothing.

    By Stewart's theorem |p - P2|^2 = (1 - l) s23 + l s24 - l (1 - l) s34 with l = tip_offset / d34: for l
    between 0 and 1 it is least where both distances are.
    """
    part = robot.tip_offset / robot.d34
    if not 0.0 <= part <= 1.0:
        return ""
    squared = (1.0 - part) * lower[0] ** 2 + part * lower[1] ** 2 - part * (1.0 - part) * robot.d34**2
    chord = float(np.sqrt(max(squared, 0.0)))
    longest = robot.link.length.upper
    if chord <= longest + _LENGTH_SLACK:
        return ""
    return (
        f"the link's end would be at least {1e3 * chord:.1f} mm from P2, "
        f"and the link is at most {1e3 * longest:.1f} mm long"
    )
