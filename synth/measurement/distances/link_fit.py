"""Whether the malleable link can take a measured pose: an explicit shape, or how near one came."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import frozen_value
from synth.robot import ANYWHERE, ArcChains, Arm, BasePose, Interval, stepped
from synth.rounding import told_apart

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.measurement.distances.measured import MeasuredDistances
    from synth.robot import Robot

PAIRS = ("d13", "d14", "d23", "d24")
_ARCS = 4
_DRAWN = 30_000
_STARTS = 64
_STEPS = 80
_ROUNDING = 2e-8  # m
_LENGTH_SLACK = 1e-9
# How closely distances that are aimed at are met, m: near parallel axes 1e-6 would still be 1 deg.
_AIM = 1e-8


@frozen_value
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
    chains = ArcChains(robot.link, _ARCS)
    drawn = chains.random(_DRAWN, rng)
    x = np.column_stack([drawn, np.zeros(_DRAWN)])
    d, _ = _Bounds(robot, lower, upper).distances(chains, x)
    apart = _in_any_frame(d) - _in_any_frame(0.5 * (lower + upper))
    x = x[np.argsort(np.linalg.norm(apart, axis=1), kind="stable")[:_STARTS]]
    obstacle = _obstacle(robot, lower[2:])
    if aim is not None:
        fit = _best(chains, _Bounds(robot, aim - _AIM, aim + _AIM), x, aim, aim)
        if fit.found:
            return fit
    return replace(_best(chains, _Bounds(robot, lower, upper), x, lower, upper), obstacle=obstacle)


@frozen_value
class _Bounds:
    """Bounds of d13, d14, d23, d24 as an aim of chains, the same for each."""

    robot: Robot
    lower: FloatArray
    upper: FloatArray

    @property
    def theta1(self) -> Interval:
        """Anywhere: joint 1 changes no distance."""
        return ANYWHERE

    def take(self, rows: NDArray[np.intp]) -> _Bounds:
        """Return the aim of some of the rows."""
        del rows
        return self

    def distances(self, chains: ArcChains, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return d13, d14, d23, d24 of chains, shape (n, 4), m, and their derivatives by the unknowns."""
        radius, robot, ends = self.robot.link.min_bend_radius, self.robot, chains.ends(x[:, :-1])
        u, p1 = ends.frame[..., 0], np.array([0.0, 0.0, -robot.d12])
        about = np.cross(ends.rotation, u[..., None], axis=1)
        d, slopes = [], []
        for base in (p1, np.zeros(3)):
            for along in (-robot.tip_offset, robot.d34 - robot.tip_offset):
                v = radius * ends.position + along * u - base
                d.append(np.linalg.norm(v, axis=1))
                slopes.append(np.einsum("ni,nij->nj", v, radius * ends.d_position + along * about))
        distances = np.stack(d, axis=1)
        slope = np.stack(slopes, axis=1) / np.maximum(distances, 1e-12)[..., None]
        return distances, np.concatenate([slope, np.zeros((*distances.shape, 1))], axis=-1)

    def off(self, chains: ArcChains, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return how far distances are beyond their bounds, in bend radii, and the derivatives."""
        d, slope = self.distances(chains, x)
        off = d - np.clip(d, self.lower, self.upper)
        radius = self.robot.link.min_bend_radius
        return off / radius, slope * (off != 0.0)[..., None] / radius  # within its bounds a distance is free


def _best(chains: ArcChains, bounds: _Bounds, x: FloatArray, lower: FloatArray, upper: FloatArray) -> LinkFit:
    """Return the gentlest of the shapes improved to keep bounds or, if none does, the nearest one."""
    robot = bounds.robot
    x, _ = stepped(chains, bounds, x, _STEPS)
    rigid = robot.rigid_link
    arms = [Arm(robot, chains.shape(one), rigid.d35.lower, rigid.d45.lower, BasePose()) for one in x[:, :-1]]
    beyond = np.array([_beyond(arm, lower, upper) for arm in arms])
    energy = np.where(beyond == 0.0, chains.energy(x[:, :-1]), np.inf)
    best = int(np.argmin(energy) if np.isfinite(energy).any() else np.argmin(beyond))
    return LinkFit(arms[best], float(beyond[best]))


def _in_any_frame(d: FloatArray) -> FloatArray:
    """Return a length and three differences, which the short baselines make worth ten times as much."""
    d13, d14, d23, d24 = np.moveaxis(d, -1, 0)
    return np.stack([d13, 10.0 * (d14 - d13), 10.0 * (d23 - d13), 10.0 * (d24 - d14)], axis=-1)


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
    away, length = told_apart(chord, longest)
    return f"the link's end would be at least {away} mm from P2, and the link is at most {length} mm long"
