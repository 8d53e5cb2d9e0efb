"""The guide: where the marked points of the robot stand once its link has the wanted shape."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen
from synth.checks import refuse_unless
from synth.guide.sensitivity import ShapeTolerance, shape_tolerance
from synth.robot import BasePose
from synth.synthesis import Design
from synth.task import Task

if TYPE_CHECKING:
    from synth.robot import Arm, Interval, LinkShape

MARKERS = ("P1", "P2", "P3", "P4")
LINK_END = "END"
SPACING = 0.050  # m, of the points on the centreline
_LEAST_GAP = 0.010  # m; a point nearer to the link's end than this would only be mistaken for it


@dataclass(frozen=True)
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

    def __post_init__(self) -> None:
        for name in ("markers", "axis_point", "axis_direction", "centreline"):
            object.__setattr__(self, name, frozen(getattr(self, name)))


@dataclass(frozen=True)
class Guide:
    """What a person needs to bend the link into its shape, and to tell whether it is right.

    Attributes:
        at_zero: Where everything stands at joint 1 = 0, a posture that the joint may not have.
        hold: The same with joint 1 at an angle that it can hold: 0 within its limits, or else the
            middle of its range. This is what the operator measures against.
        stations: Arc lengths s from P2 of the points on the centreline, shape (k,), m: multiples of
            50 mm, and the link's end.
        link: The shape of the link, with its length, smallest bend radius and total bend.
        tolerance: How precisely axis 2 must stand.
    """

    at_zero: Placement
    hold: Placement
    stations: FloatArray
    link: LinkShape
    tolerance: ShapeTolerance

    def __post_init__(self) -> None:
        object.__setattr__(self, "stations", frozen(self.stations))

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
    arm = design.arm
    stations = _stations(arm.shape.length)
    return Guide(
        at_zero=place(arm, stations, 0.0),
        hold=place(arm, stations, hold_angle(arm.robot.joint_limits.base)),
        stations=stations,
        link=arm.shape,
        tolerance=shape_tolerance(task, design),
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


def hold_angle(limits: Interval) -> float:
    """Return an angle, rad, that joint 1 can hold: 0 within its limits, or the middle of its range."""
    return 0.0 if limits.contains(0.0) else limits.middle


def _stations(length: float) -> FloatArray:
    """Return the arc lengths of the points on a centreline of a length, m; the last one is its end."""
    count = int(np.floor((length - _LEAST_GAP) / SPACING))
    return np.append(SPACING * np.arange(1, count + 1), length)
