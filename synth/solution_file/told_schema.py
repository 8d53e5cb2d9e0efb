"""What `solution.json` tells of a shape and of the search, beside task and link: the pydantic models.

Infinity is null: a margin where there is no limit, a best miss where there is no shape.
"""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from synth.solution_file.task_schema import Joints, Length, Number, Part, Point

Share = Annotated[float, Field(ge=0.0, le=1.0)]


class TimePart(Part):
    """Where the time went, s."""

    total: Length = Field(description="from call to return, s")
    screening: Length = Field(description="finding start points, s")
    solving: Length = Field(description="building and running the nonlinear program, s")
    verifying: Length = Field(description="checking what it found, s")
    proving: Length = Field(default=0.0, description="bounding what any shape can do, s")


class GammaPart(Part):
    """The workspace surface, Gamma(x, y, z) = 0."""

    q: Annotated[list[float], Field(min_length=6, max_length=6)] = Field(description="q0 to q5, in metres")


class InvariantsPart(Part):
    """The numbers that determine the surface."""

    a: Number = Field(description="distance of the axes, m")
    alpha: Number = Field(description="angle between them, rad")
    z0: Number = Field(description="height of the common normal on axis 1, m")
    h: Number = Field(description="from it to the circle's centre along axis 2, m")
    R: Number = Field(description="radius of the circle, m")


class WayPart(Part):
    """How the arm gets from one target to the next."""

    start: str = Field(alias="from", description="name of the target that it leaves")
    end: str = Field(alias="to", description="name of the target that it gets to")
    found: bool = Field(default=True, description="whether there is a way")
    joints: list[Joints] = Field(description="[theta1, theta2] passed, straight in between, rad")


class MarginsPart(Part):
    """Distances from limits; null where there is no limit."""

    joint1: Number | None = Field(description="of joint 1, rad")
    joint2: Number | None = Field(description="of joint 2, rad")
    length: Number | None = Field(description="of the link's length, m")
    bend_radius: Number | None = Field(description="of the smallest bend radius, m")
    total_bend: Number | None = Field(description="of the total bend, rad")
    clearance: Number | None = Field(description="of the arm from obstacles, m")


class ForgivenessPart(Part):
    """What becomes of the task after a hand placed the link."""

    expected_worst_miss: Length | None = Field(description="mean of the largest miss, m")
    chance: Share = Field(description="share of errors with which all targets are reached")


class FiguresPart(Part):
    """What a shape is like to work with."""

    ways_missing: int = Field(ge=0, description="from how many targets no way leads to the next")
    margins: MarginsPart = Field(description="distances from limits")
    shortfall: Length = Field(description="what is missing of the margins, in shares")
    forgiveness: ForgivenessPart = Field(description="what a hand leaves")
    largest_swing: Length = Field(description="the most that a joint turns between two targets, rad")
    travel: Length = Field(description="of the joint that turns more, over all ways, rad")
    bend: Length = Field(description="integral of curvature squared along the link, 1/m")
    change: Length | None = Field(default=None, description="distance from the present shape, m; null: none")


class BoundPart(Part):
    """What is proven of the worst miss over all shapes."""

    lower_bound: Number = Field(description="no shape has a smaller worst weighted miss, m")
    gap: Number | None = Field(default=None, description="how much worse the best shape found may be, m")
    best_found: Length | None = Field(default=None, description="least worst weighted miss found, m")
    tightest_tolerance: Length | None = Field(default=None, description="of all targets, m")
    boxes: int = Field(default=0, ge=0, description="how many boxes of shapes were looked at")
    left_out: list[str] = Field(default=[], description="what the proof does not know of the task")
    weighted: bool = Field(default=False, description="whether the tolerances differ")


class HoldPart(Part):
    """The posture in which the link is bent."""

    joint1: Number = Field(description="angle of joint 1, rad")
    joint2: Number = Field(description="angle of joint 2, rad")
    clear: bool = Field(description="whether the bent arm is clear there of everything")


class AxisPart(Part):
    """Axis 2 at the hold posture, in the task frame."""

    point: Point = Field(description="the link's end, m")
    direction: Point = Field(description="unit vector from P3 to P4")
    elevation: Number = Field(description="of the direction over the horizontal, rad")
    heading: Number | None = Field(description="of the direction about the vertical, rad; null: vertical")


class StationPart(Part):
    """A point of the link at the hold posture."""

    name: str = Field(description="how the guide calls it")
    arc_length: Number = Field(description="distance from P2 along the link, m")
    position: Point = Field(description="[x, y, z] in the task frame, m")


class TolerancePart(Part):
    """How far axis 2 may be off; null where there is no such number."""

    position: Length | None = Field(description="shift of axis 2, m")
    position_target: str = Field(description="the target that is lost first")
    direction: Length | None = Field(description="tilt of axis 2, rad")
    direction_target: str = Field(description="the target that is lost first")


class PlacePart(Part):
    """The place that was chosen for the base, and how precisely."""

    name: str = Field(description="what it is called, if it has a name")
    position: Length = Field(description="how far the base may be off if nothing else is, m")
    turn: Length = Field(description="how far it may be turned, rad")


class BetweenPart(Part):
    """What is proven of a surface between its samples."""

    share: float = Field(ge=0.0, le=1.0 + 1e-9, description="share of its area within tolerance for certain")
    largest: Length | None = Field(description="no point is missed by more, m; null: nothing is certain")
    cells: int = Field(ge=0, description="how many pieces of it were looked at")
    width: Length = Field(description="how far at most a point of one is from its middle, m")


class CoveringPart(Part):
    """What is covered of a surface."""

    name: str = Field(description="what it is called")
    coverage: float = Field(gt=0.0, le=1.0, description="share of its area that is asked for")
    share: float = Field(ge=0.0, le=1.0 + 1e-9, description="share within tolerance, at the samples")
    covered: bool = Field(description="whether as much is covered as is asked for")
    largest: Length = Field(description="largest miss of what is covered best, m")
    rms: Length = Field(description="root mean square of the misses there, m")
    percentile_95: Length = Field(description="miss that 95 % there do not exceed, m")
    uncovered: list[Point] = Field(description="middles of the pieces that are not covered, m")
    uncovered_points: int = Field(ge=0, description="how many these are in all")
    between: BetweenPart | None = Field(default=None, description="between the samples; null: not known")


class FollowedPart(Part):
    """How a path is followed."""

    name: str = Field(description="what it is called")
    followed: bool = Field(description="whether all of it is, within the tolerance and without a jump")
    tolerance: Length = Field(description="how far the end effector may stray from it, m")
    largest: Length | None = Field(description="it strays by no more, m; null: it is not followed")
    seen: Length = Field(description="it strays by so much somewhere, m")
    lengths: list[Length] = Field(description="how long the path is up to each of the joint angles, m")
    times: list[Length] | None = Field(description="when each is passed at the speed asked for, s; or null")
    points: list[Point] = Field(description="where the end effector should be at each, m")
    joints: list[Joints] = Field(description="[theta1, theta2] along it, straight in between, rad")
    joint_speeds: Joints | None = Field(description="largest speeds of the joints then, rad/s; or null")
    breaks: list[Point] = Field(description="between which two points it is not followed, m; empty if it is")
    jump: list[Joints] = Field(description="joint angles there, between which they would have to jump, rad")


class GuidePart(Part):
    """Where everything is while the link is bent."""

    hold: HoldPart = Field(description="joint angles to hold")
    markers: dict[str, Point] = Field(description="P1 to P4 in the task frame, m")
    axis2: AxisPart = Field(description="axis 2")
    centreline: list[StationPart] = Field(description="points along the link")
    tolerance: TolerancePart | None = Field(default=None, description="how precisely; null: not met")
    forgiveness: ForgivenessPart | None = Field(default=None, description="what a hand leaves")
    base: PlacePart | None = Field(default=None, description="the place chosen for the base; null: given")
