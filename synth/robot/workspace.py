"""The workspace of an arm as a surface: area, bounding box, section, mesh and samples, with joint limits."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen, frozen_value
from synth.geometry import critical_angles, sampling_angles
from synth.robot.base_pose import BasePose
from synth.robot.hardware import Interval, JointLimits, into_turn
from synth.robot.surface_mesh import SurfaceMesh

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from synth.robot.arm import Arm

_TURN = 2.0 * math.pi
# Panels that shrink by 4 towards both ends of a stretch, down to rounding: whatever root of the
# integrand lies near an end, at a panel Gauss's 16 points err by 3^-32.
_GRADES = np.concatenate([[0.0], 0.5 * 0.25 ** np.arange(27.0)[::-1]])
_GAUSS = np.polynomial.legendre.leggauss(16)
_COARSEST = 1.0  # rad; seven cells a turn still close up


@frozen_value
class Workspace:
    """The surface that P5 sweeps within joint limits. Points are in the task frame, in metres.

    It is the image of a rectangle of joint angles; of limits wider than a turn, the first turn counts.
    Where the axes meet or are parallel, the whole surface is a sheet that is covered twice.

    Attributes:
        arm: The arm.
        limits: The joint limits, the arm's own or others.
    """

    arm: Arm
    limits: JointLimits

    def __post_init__(self) -> None:
        one_turn = JointLimits(_one_turn(self.limits.base), _one_turn(self.limits.second))
        object.__setattr__(self, "limits", one_turn)

    @classmethod
    def within_limits(cls, arm: Arm) -> Workspace:
        """Return the workspace within the robot's joint limits."""
        return cls(arm, arm.robot.joint_limits)

    @classmethod
    def unlimited(cls, arm: Arm) -> Workspace:
        """Return the whole surface, which both joints sweep in a full turn."""
        return cls(arm, JointLimits())

    def area_element(self, theta2: ArrayLike) -> FloatArray:
        """Return the area |dP5/dtheta1 x dP5/dtheta2| per square radian, shape (...), m^2.

        Joint 1 moves P5 = (x, y, z) across the half-plane of axis 1, in which joint 2 moves it by
        (rho', z') and out of which it only shears: with rho rho' = x x' + y y', the element is
        rho |(rho', z')| = sqrt((x x' + y y')^2 + (x^2 + y^2) z'^2), whatever theta1.

        Args:
            theta2: Angle of the second joint, shape (...), rad.
        """
        theta2 = np.asarray(theta2, dtype=np.float64)
        kinematics = self.arm.kinematics
        reached = kinematics.forward(0.0, theta2)
        joints = np.stack([np.zeros_like(theta2), theta2], axis=-1)
        (x, y, _), (dx, dy, dz) = (
            np.moveaxis(p, -1, 0) for p in (reached, kinematics.velocities(joints, reached)[1])
        )
        return np.asarray(np.hypot(x * dx + y * dy, np.hypot(x, y) * dz))

    @cached_property
    def area(self) -> float:
        """Area of the swept surface, m^2: the integral of `area_element`, to rounding.

        What the arm reaches in two ways is counted twice: with the axes coplanar and no limits, everything.
        """
        stretches = np.sort(self._stretches)
        first, widths = stretches[:-1, None], np.diff(stretches)[:, None]
        ends = first + widths * np.concatenate([_GRADES, 1.0 - _GRADES[-2::-1]])
        middles, halves = 0.5 * (ends[:, 1:] + ends[:, :-1]), 0.5 * np.diff(ends)
        nodes, weights = _GAUSS
        elements = self.area_element(middles[..., None] + halves[..., None] * nodes)
        return _width(self.limits.base) * float(np.sum(elements * weights * halves[..., None]))

    @cached_property
    def bounding_box(self) -> FloatArray:
        """Lowest and highest corner of the workspace in the task frame, shape (2, 3), m.

        Exact: a coordinate is extreme inside the limits of joint 1 only where P5 lies straight along it,
        with rho extreme or joint 2 at a limit; at a limit of joint 1, and for z, it is a sinusoid of theta2.
        Of a base that leans it is the box about that of the upright arm, and may be too large.
        """
        if not self.arm.base.is_upright:
            return _turned_box(Workspace(replace(self.arm, base=BasePose()), self.limits), self.arm.base)
        base = self.limits.base
        kinematics, yaw = self.arm.kinematics, self.arm.base.yaw
        x, y, _ = np.moveaxis(kinematics.forward(0.0, sampling_angles(2)), -1, 0)
        turns = _stretched(self.limits.second, critical_angles(x**2 + y**2))
        start = kinematics.forward(0.0, turns)
        along = sampling_angles(1)[:, None] - yaw - np.arctan2(start[:, 1], start[:, 0])
        inside = self.arm.forward_kinematics(_within(base, along), turns)

        at_limits = np.array([[base.lower], [base.upper]])
        at_0, at_90, at_180 = np.moveaxis(
            self.arm.forward_kinematics(at_limits, [0.0, 0.5 * np.pi, np.pi]), 1, 0
        )
        crests = np.arctan2(at_90 - 0.5 * (at_0 + at_180), 0.5 * (at_0 - at_180))
        both = np.concatenate([crests, crests + np.pi], axis=1)
        turns = np.stack([_stretched(self.limits.second, row) for row in both])
        edges = self.arm.forward_kinematics(at_limits, turns)
        # Any point of the workspace may be in the list; what counts is that no extreme one is missing.
        points = np.concatenate([inside.reshape(-1, 3), edges.reshape(-1, 3)])
        return frozen([points.min(axis=0), points.max(axis=0)])

    def section(self, count: int = 361) -> FloatArray:
        """Return the section with a half-plane of axis 1, at evenly spaced angles of joint 2.

        Args:
            count: Number of points, from the lower to the upper limit of joint 2.

        Returns:
            Distance rho from axis 1 and height z in the task frame, shape (count, 2), m; where the base leans
            the height is that along axis 1, from P1.
        """
        theta2 = np.linspace(self.limits.second.lower, self.limits.second.upper, count)
        x, y, z = np.moveaxis(self.arm.kinematics.forward(0.0, theta2), -1, 0)
        return np.column_stack([np.hypot(x, y), z + self.arm.base.is_upright * self.arm.base.position[2]])

    def mesh(self, spacing: float = math.radians(5.0), floor: float | None = None) -> SurfaceMesh:
        """Return a mesh of the whole surface, with the part within the limits marked.

        The limits run along edges of the mesh. It is closed: every edge has two faces. Its vertices are on
        the surface, its faces beside it by up to spacing^2 / 8 times R and the largest rho. Where the
        circle meets axis 1, and for coincident axes, faces have no area.

        Args:
            spacing: Largest step of either joint, rad; steps beyond 1 rad are made smaller.
            floor: Height in the base frame, m, that reachable faces stay above; None for no floor.
        """
        theta1, allowed1 = _cells(self.limits.base, spacing)
        theta2, allowed2 = _cells(self.limits.second, spacing)
        points = self.arm.kinematics.forward(theta1[:, None], theta2).reshape(-1, 3)
        faces = _faces_of_torus(len(theta1), len(theta2))
        reachable = np.repeat(np.logical_and.outer(allowed1, allowed2), 2)
        if floor is not None:
            reachable &= np.all(points[faces, 2] >= floor - 1e-9, axis=-1)
        a, b, c = np.moveaxis(points[faces], 1, 0)
        if np.sum(a * np.cross(b, c)) < 0.0:  # six times the enclosed volume
            faces = faces[:, ::-1]
        return SurfaceMesh(self.arm.base.to_task(points), faces, reachable)

    def sample(self, count: int, seed: int = 0) -> FloatArray:
        """Return random points within the limits, uniform by `area`, shape (count, 3), m.

        Args:
            count: Number of points.
            seed: The same points for the same seed.
        """
        rng = np.random.default_rng(seed)
        base, second = self.limits.base, self.limits.second
        peak = float(np.max(self.area_element(self._stretches)))
        theta2 = np.empty(0)
        while len(theta2) < count:
            drawn = rng.uniform(second.lower, second.upper, 2 * count)
            kept = rng.uniform(0.0, peak, 2 * count) <= self.area_element(drawn)
            theta2 = np.concatenate([theta2, drawn[kept]])
        theta1 = rng.uniform(base.lower, base.upper, count)
        return self.arm.forward_kinematics(theta1, theta2[:count])

    @cached_property
    def _stretches(self) -> FloatArray:
        """Limits of joint 2, and between them the extremes and kinks of the area element."""
        return _stretched(self.limits.second, critical_angles(self.area_element(sampling_angles(4)) ** 2))


def _width(interval: Interval) -> float:
    return interval.upper - interval.lower


def _one_turn(interval: Interval) -> Interval:
    return Interval(interval.lower, min(interval.upper, interval.lower + _TURN))


def _within(interval: Interval, angles: FloatArray) -> FloatArray:
    """Return angles, modulo a turn, brought to the nearer end of an interval if they are not in it."""
    return np.clip(into_turn(angles, interval.middle), interval.lower, interval.upper)


def _faces_of_torus(first: int, second: int) -> NDArray[np.int64]:
    """Return the triangles of a grid that closes up both ways, two of each cell: indices, shape (m, 3)."""
    index = np.arange(first * second).reshape(first, second)
    across, along, both = (np.roll(index, shift, axis=(0, 1)) for shift in ((-1, 0), (0, -1), (-1, -1)))
    return np.stack([index, across, both, index, both, along], axis=-1).reshape(-1, 3)


def _cells(interval: Interval, spacing: float) -> tuple[FloatArray, NDArray[np.bool_]]:
    """Return where cells begin that divide a whole turn, and whether each is in the interval."""
    width = _width(interval)
    spacing = min(spacing, _COARSEST)
    # An interval that is a turn to rounding leaves no sliver.
    inside, outside = (math.ceil(stretch / spacing - 1e-9) for stretch in (width, _TURN - width))
    begin = np.concatenate(
        [
            np.linspace(interval.lower, interval.upper, inside, endpoint=False),
            np.linspace(interval.upper, interval.lower + _TURN, outside, endpoint=False),
        ]
    )
    return begin, np.arange(inside + outside) < inside


def _turned_box(upright: Workspace, base: BasePose) -> FloatArray:
    """Return the box in the task frame about that of a workspace in its base frame, shape (2, 3), m."""
    box = upright.bounding_box
    corners = base.to_task(np.stack(np.meshgrid(*box.T, indexing="ij"), axis=-1).reshape(-1, 3))
    return frozen([corners.min(axis=0), corners.max(axis=0)])


def _stretched(second: Interval, theta2: FloatArray) -> FloatArray:
    """Return angles of joint 2 brought within its limits, and the limits, shape (n + 2,)."""
    return np.concatenate([[second.lower, second.upper], _within(second, theta2)])
