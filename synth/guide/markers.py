"""The guide: where the marked points of the robot stand once its link has the wanted shape."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen, frozen_value
from synth.checks import refuse_unless
from synth.guide.base_place import BasePlace, base_place
from synth.guide.posture import HoldPosture, hold_posture
from synth.guide.sensitivity import ShapeTolerance, shape_tolerance
from synth.robot import BasePose
from synth.synthesis import Design, ways_and_forgiveness, what_counts
from synth.task import Task

if TYPE_CHECKING:
    from synth.robot import Arm, LinkShape
    from synth.synthesis import Forgiveness, Motion

MARKERS = ("P1", "P2", "P3", "P4")
LINK_END = "END"
SPACING = 0.050  # m, of the points on the centreline; of a very long link a multiple of it
_MOST_STATIONS = 100  # more than that nobody holds a link to
_VERTICAL = 1e-9  # of a direction's horizontal part: no heading below
_LEAST_GAP = 0.010  # m; a point nearer to the link's end than this would only be mistaken for it


@frozen_value
class Placement:
    """Where everything stands while joint 1 is held at one angle. Task frame, m.

    Attributes:
        joint1: The angle theta1 of joint 1, rad.
        markers: P1, P2 on axis 1 and P3, P4 on axis 2, shape (4, 3).
        axis_point: The point of axis 2 where the link ends, shape (3,).
        axis_direction: Direction u of axis 2, from P3 towards P4, shape (3,), of length 1.
        centreline: Points of the link's centreline at `Guide.stations`, shape (k, 3).
    """

    joint1: float
    markers: FloatArray
    axis_point: FloatArray
    axis_direction: FloatArray
    centreline: FloatArray

    @property
    def elevation(self) -> float:
        """Angle of axis 2 over the horizontal, from P3 towards P4, in [-pi/2, pi/2], rad."""
        x, y, z = self.axis_direction
        return math.atan2(z, math.hypot(x, y))

    @property
    def heading(self) -> float:
        """Direction of axis 2 seen from above, from x towards y, in (-pi, pi], rad; NaN if it is vertical."""
        x, y, _ = self.axis_direction
        return math.nan if math.hypot(x, y) < _VERTICAL else math.atan2(y, x)

    def __post_init__(self) -> None:
        for name in ("markers", "axis_point", "axis_direction", "centreline"):
            object.__setattr__(self, name, frozen(getattr(self, name)))


@frozen_value
class Guide:
    """What a person needs to bend the link into its shape, and to tell whether it is right.

    Attributes:
        posture: The joint angles to hold while bending.
        hold: Where everything stands there. This is what the operator measures against.
        stations: Arc lengths s from P2 of the points on the centreline, shape (k,), m: multiples of
            50 mm, 100 at most, and the link's end.
        arm: The robot in the shape.
        cut: Distances (d35, d45) of the rigid link, m, where the synthesis chose it; else None.
        rigid_link: What that is called in the catalogue it was chosen from; empty if it is to be cut.
        met: Whether the shape meets the task. If not, nobody is to bend the link to it: what is said of it is
            no instruction.
        tolerance: How precisely axis 2 must stand; NaN for a task that is not met.
        forgiveness: What becomes of the task when a hand as published bends the link; None if it is not met.
        ways: How the arm gets from each target to the next; empty if it is not met, or of many targets.
        place: Where the base was chosen to stand, and how precisely; None if the task says it or is missed.
    """

    posture: HoldPosture
    hold: Placement
    stations: FloatArray
    arm: Arm
    cut: tuple[float, float] | None
    rigid_link: str
    met: bool
    tolerance: ShapeTolerance
    forgiveness: Forgiveness | None
    ways: tuple[Motion, ...]
    place: BasePlace | None

    def __post_init__(self) -> None:
        object.__setattr__(self, "stations", frozen(self.stations))

    @property
    def link(self) -> LinkShape:
        """The shape of the link, with its length, smallest bend radius and total bend."""
        return self.arm.shape

    @property
    def marker_distances(self) -> dict[str, float]:
        """The distances that a tape measures: "d13", "d14", "d23" and "d24", m."""
        markers = self.hold.markers
        return {
            f"d{i + 1}{j + 1}": float(np.linalg.norm(markers[i] - markers[j])) for i in (0, 1) for j in (2, 3)
        }

    @property
    def station_names(self) -> tuple[str, ...]:
        """Names of the points on the centreline: "L050" at s = 50 mm, ..., and "END"."""
        return (*(f"L{1e3 * s:03.0f}" for s in self.stations[:-1]), LINK_END)

    def points(self, placement: Placement) -> dict[str, FloatArray]:
        """Return all points of one placement by name, P1 to P4 first; each of shape (3,), m."""
        names = (*MARKERS, *self.station_names)
        return dict(zip(names, (*placement.markers, *placement.centreline), strict=True))


def make_guide(task: Task, design: Design) -> Guide:
    """Return the guide to one shape of a task's robot.

    Args:
        task: What is asked: its targets decide how precisely the shape must be held.
        design: The shape, and what the independent check says of it.
    """
    refuse_unless("task", task, Task)
    refuse_unless("design", design, Design)
    return _guide(task, design)


@lru_cache(maxsize=8)
def _guide(task: Task, design: Design) -> Guide:
    """Return the guide: text, JSON and sheet of a run ask for the same one."""
    arm = design.arm
    ways, forgiveness = ways_and_forgiveness(task, design)
    task, check = what_counts(task, arm, design.verification)
    design = replace(design, verification=check)
    stations, posture = _stations(arm.shape.length), hold_posture(task, arm)
    name = arm.robot.name_of_rigid_link(arm.d35, arm.d45)
    return Guide(
        place=base_place(task, design),
        posture=posture,
        hold=place(arm, stations, posture.joint1),
        stations=stations,
        arm=arm,
        cut=(arm.d35, arm.d45) if name or not task.robot.rigid_link.is_fixed else None,
        rigid_link=name,
        met=check.found,
        tolerance=shape_tolerance(task, design),
        forgiveness=forgiveness,
        ways=ways,
    )


def place(arm: Arm, stations: FloatArray, joint1: float) -> Placement:
    """Return where an arm's points stand with joint 1 at an angle.

    Args:
        arm: The robot in its shape.
        stations: Arc lengths of points on the centreline, shape (k,), m.
        joint1: The angle theta1, rad.
    """
    turn = BasePose(yaw=joint1)  # joint 1 turns about z, as a yaw does
    rotation, end = arm.end_frame
    points = np.vstack([arm.axis_points, end, arm.shape.point_at(stations) + arm.axis_points[1]])
    # P1 and P2 are on axis 1 and stay where they are.
    placed = arm.base.to_task(turn.to_task(points))
    direction = arm.base.rotation @ turn.rotation @ rotation[:, 0]
    return Placement(joint1, placed[:4], placed[4], direction, placed[5:])


def _stations(length: float) -> FloatArray:
    """Return the arc lengths of the points on a centreline of a length, m; the last one is its end."""
    spacing = SPACING * max(1, math.ceil(length / (SPACING * _MOST_STATIONS)))
    count = int(np.floor((length - _LEAST_GAP) / spacing))
    return np.append(spacing * np.arange(1, count + 1), length)
