"""An arm as robot descriptions see it: bodies and joints, with what every format has to know of them.

    world -(fixed)- base_link -joint1- malleable_link -joint2- rigid_link -(fixed)- tool0

`world` is the task frame and base_link the base frame; malleable_link is the base frame turned by joint 1.
rigid_link stands at the link's end, x along axis 2 from P3 to P4 and z along the link; joint 2 turns it about
x, and at joint 2 = 0 its z axis points away from P5. tool0 is at P5, x along axis 2, z out of the rigid link.
"""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen_value
from synth.export.planners.inertia import Inertia, inertia_of
from synth.export.planners.pieces import Chain, column_pieces, rod_pieces, tube_pieces
from synth.robot import ACCELERATION, SPEED, ArmBody

if TYPE_CHECKING:
    from collections.abc import Mapping

    from synth.synthesis import Solution
    from synth.task import Task

# What nobody measured of the prototype and every format asks for.
JERK = 100.0  # rad/s^3
EFFORT = 20.0  # N m
DENSITY = 1000.0  # kg/m^3
MOST_TARGETS = 1000  # that a description names
_TOOL = Inertia(1e-3, np.zeros(3), 1e-7 * np.eye(3))


@dataclass(frozen=True)
class Body:
    """A rigid body of the arm.

    Attributes:
        name: Its name in all formats.
        pieces: What may collide; None if nothing may.
        inertia: Its inertia.
    """

    name: str
    pieces: Chain | None
    inertia: Inertia


@frozen_value
class Description:
    """The best shape of a solution, ready to be written in any format.

    Attributes:
        solution: The solution; it holds a shape.
    """

    solution: Solution

    @property
    def task(self) -> Task:
        """What was asked."""
        return self.solution.task

    @property
    def robot_name(self) -> str:
        """The robot's name in letters, digits and underscores."""
        return word(self.task.robot.name)

    @property
    def origin(self) -> tuple[str, ...]:
        """Lines that say which solution a file came from, and in which units it is."""
        found = self.solution
        which = f"shape {found.shape}, {found.status.value}, seed {found.seed}, synth {found.version}"
        return f"task {found.task.name}: {which}", "metres, radians, kilograms, seconds"

    @property
    def nominal(self) -> str:
        """What of it is nominal, not measured."""
        rates = self.task.robot.joint_rates
        is_assumed = (rates.accelerations == ACCELERATION).all()
        more = f", acceleration {ACCELERATION:g} rad/s^2" if is_assumed else ""
        prototype = f"; speed {SPEED:.4g} rad/s is the prototype's 25 rpm"
        return (
            f"nominal, not measured: density {DENSITY:g} kg/m^3, effort {EFFORT:g} N m, jerk {JERK:g} rad/s^3"
            f"{more}{prototype if (rates.speeds == SPEED).all() else ''}"
        )

    @cached_property
    def body(self) -> ArmBody:
        """The room that the arm takes up."""
        return ArmBody(self.solution.robot)

    @cached_property
    def link_end(self) -> tuple[FloatArray, FloatArray]:
        """The frame of rigid_link at joint 2 = 0 in malleable_link: rotation (3, 3) and position (3,), m."""
        return self.solution.robot.end_frame

    @cached_property
    def tool(self) -> FloatArray:
        """P5 in the frame of rigid_link, shape (3,), m."""
        arm = self.solution.robot
        offset, radius = arm.robot.end_effector_circle(arm.d35, arm.d45)
        return np.array([float(offset), 0.0, -float(radius)])

    @cached_property
    def tool_rotation(self) -> FloatArray:
        """The frame of tool0 in rigid_link, shape (3, 3): x along axis 2, z across it towards P5."""
        return np.diag([1.0, -1.0, -1.0])

    @cached_property
    def bodies(self) -> tuple[Body, Body, Body, Body]:
        """base_link, malleable_link, rigid_link and tool0."""
        arm, body = self.solution.robot, self.body
        p2 = arm.base_joint[1]
        column = column_pieces(arm.robot.d12, body.tube_radius)
        tube = tube_pieces(arm.shape, p2, body.tube_radius)
        rod = rod_pieces(self.tool, body.rod_radius)
        return (
            Body("base_link", column, inertia_of(column, DENSITY)),
            Body("malleable_link", tube, inertia_of(tube, DENSITY)),
            Body("rigid_link", rod, inertia_of(rod, DENSITY)),
            Body("tool0", None, _TOOL),
        )

    @cached_property
    def postures(self) -> Mapping[str, FloatArray]:
        """Joint angles, shape (2,), rad, at the targets, by names in letters and digits; of many some."""
        named: dict[str, FloatArray] = {}
        seen: Counter[str] = Counter()
        check = self.solution.best.verification
        for name, joints in zip(self.task.table.names[:MOST_TARGETS], check.joints, strict=False):
            plain = unique = word(name)
            while unique in named:
                seen[plain] += 1
                unique = f"{plain}__{seen[plain] + 1}"
            named[unique] = joints
        return named


def word(name: str) -> str:
    """Return a name in letters, digits and underscores, which every format takes."""
    plain = re.sub(r"[^A-Za-z0-9]+", "_", name).strip("_") or "unnamed"
    return plain if plain[0].isalpha() else f"_{plain}"


def numbers(values: object) -> str:
    """Return numbers as they are, so that the file loses nothing."""
    return " ".join(repr(float(value)) for value in np.ravel(np.asarray(values, dtype=np.float64)))
