"""The synthesis in quadratic equations, as a global solver takes it: the lifted program.

Seen in the half-plane of axis 1, a target (r, h) is missed by (rho - r, z - h), (rho, z) the nearest point of
the workspace. That point P lies on the circle that P5 describes about axis 2. With u the direction of axis 2,
c the circle's centre, R its radius, t the direction of the link's end, across u, and w how far joint 2 may be
from straight on:

    u.P = u.c,   |P - c| = R,   rho^2 = Px^2 + Py^2,   t.(P - c) >= R cos(w),
    (rho - r)^2 + (z - h)^2 <= W^2.

The frame is turned about axis 1 and reflected until u = (sin, 0, cos), sin >= 0, c_y >= 0. Of the link is
left that its end is no farther from P2 than it is long; the limits of joint 1 and the floor are left out. So
every shape is a point of the program, and no shape has a worst miss below the least W.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import starmap
from operator import mul
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable

    from synth.robot import Robot
    from synth.task import Task

PER_METRE = 10.0  # the program is in decimetres: a solver's tolerance of 1e-6 is then 0.01 mm^2
_TANGENTS = 16  # to the circle of a miss: redundant, but linear, so they narrow the boxes at once

Unknown = Any  # of a solver: it can be added to and multiplied with others, and compared


@dataclass(frozen=True)
class _Circle:
    """The circle of P5: centre c, |c|^2, the height u.c of its plane, u without its y, and t with t.c."""

    centre: tuple[Unknown, Unknown, Unknown]
    centre_squared: Unknown
    height: Unknown
    axis: tuple[Unknown, Unknown]
    ahead: tuple[Unknown, Unknown, Unknown]
    ahead_at_centre: Unknown


@dataclass(frozen=True)
class LiftedProgram:
    """States the lifted program to a solver.

    Attributes:
        unknown: Adds an unknown of this name, within a lower and an upper limit, and returns it.
        require: Adds a constraint.
        task: The task.
        worst_known: A worst miss that is known to be possible, m: no target needs to be missed by more.
    """

    unknown: Callable[[str, float, float], Unknown]
    require: Callable[[Unknown], object]
    task: Task
    worst_known: float

    def state(self) -> Unknown:
        """State the program; return the unknown W to be minimised, the worst miss, dm."""
        circle = self._circle()
        worst = self.unknown("W", 0.0, self.worst_known * PER_METRE)
        for number, target in enumerate(PER_METRE * self.task.positions_in_base):
            self._target(number, target, circle, worst)
        return worst

    def _circle(self) -> _Circle:
        robot = self.task.robot
        length, d12, (offset, _) = PER_METRE * robot.link.length.upper, PER_METRE * robot.d12, _sizes(robot)
        far = length + abs(offset)  # from P2, dm
        c = (
            self.unknown("cx", -far, far),
            self.unknown("cy", 0.0, far),
            self.unknown("cz", d12 - far, d12 + far),
        )
        u = self.unknown("sin", 0.0, 1.0), self.unknown("cos", -1.0, 1.0)
        t = tuple(self.unknown(name, -1.0, 1.0) for name in ("tx", "ty", "tz"))
        squared = self.unknown("c.c", 0.0, (far + d12) ** 2)
        height, ahead = (self.unknown(name, -far - d12, far + d12) for name in ("u.c", "t.c"))
        for a, b, product in (
            (u, u, 1.0), (t, t, 1.0), (u, (t[0], t[2]), 0.0),
            (c, c, squared), (u, (c[0], c[2]), height), (t, c, ahead),
        ):  # fmt: skip
            self.require(_dot(a, b) == product)
        # The link's end is c - offset u, and P2 is (0, 0, d12).
        along = offset * (height - d12 * u[1])
        self.require(squared - 2.0 * d12 * c[2] - 2.0 * along + d12**2 + offset**2 <= length**2)
        return _Circle(c, squared, height, u, t, ahead)

    def _target(
        self, number: int, target: tuple[float, float, float], circle: _Circle, worst: Unknown
    ) -> None:
        """State where the point of the circle lies that is nearest to a target, and how far off."""
        near, radius = PER_METRE * self.worst_known, _sizes(self.task.robot)[1]
        r, h = math.hypot(target[0], target[1]), target[2]
        rho = self.unknown(f"rho{number}", max(r - near, 0.0), r + near)
        x, y = (self.unknown(f"{name}{number}", -r - near, r + near) for name in "xy")
        z = self.unknown(f"z{number}", h - near, h + near)
        squared = self.unknown(f"N{number}", 0.0, (r + near) ** 2 + (abs(h) + near) ** 2)
        self.require(rho * rho + z * z == squared)
        self.require(x * x + y * y == rho * rho)
        self.require(_dot(circle.axis, (x, z)) == circle.height)
        self.require(squared - 2.0 * _dot(circle.centre, (x, y, z)) + circle.centre_squared == radius**2)
        straight = radius * math.cos(_widest(self.task.robot))
        self.require(_dot(circle.ahead, (x, y, z)) - circle.ahead_at_centre >= straight)
        out, up = (self.unknown(f"{name}{number}", -near, near) for name in ("out", "up"))
        self.require(out == rho - r)
        self.require(up == z - h)
        self.require(out * out + up * up <= worst * worst)
        for turn in range(_TANGENTS):
            angle = 2.0 * math.pi * turn / _TANGENTS
            self.require(math.cos(angle) * out + math.sin(angle) * up <= worst)


def _dot(a: tuple, b: tuple) -> Unknown:
    return sum(starmap(mul, zip(a, b, strict=True)))


def _sizes(robot: Robot) -> tuple[float, float]:
    """Return how far the circle's centre is from the link's end, along axis 2, and its radius, dm."""
    rigid = robot.rigid_link
    offset, radius = robot.end_effector_circle(rigid.d35.lower, rigid.d45.lower)
    return PER_METRE * float(offset), PER_METRE * float(radius)


def _widest(robot: Robot) -> float:
    """Return how far joint 2 may be from straight on, one way or the other, rad."""
    second = robot.joint_limits.second
    return max(math.pi - second.lower, second.upper - math.pi)
