"""What `solution.json` holds of a task: the pydantic models. Metres and radians."""

from __future__ import annotations

from typing import Annotated, TypeVar

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, model_validator

from synth.checks import LARGEST
from synth.paths import Interpolation
from synth.task import Objective, Pair, Topology


def _one_at_least(entries: list[_T]) -> list[_T]:
    if not entries:
        raise ValueError("must hold one at least, but is an empty list")
    return entries


_T = TypeVar("_T")
Some = Annotated[list[_T], AfterValidator(_one_at_least), Field(json_schema_extra={"minItems": 1})]
Number = Annotated[float, Field(ge=-LARGEST, le=LARGEST)]
Positive = Annotated[float, Field(gt=0.0, le=LARGEST)]
Length = Annotated[float, Field(ge=0.0, le=LARGEST)]
Point = Annotated[list[Number], Field(min_length=3, max_length=3)]
Joints = Annotated[list[Number], Field(min_length=2, max_length=2)]
Range = Pair[Number]
Rates = Annotated[list[Annotated[float, Field(gt=0.0, le=LARGEST)]], Field(min_length=2, max_length=2)]


class Part(BaseModel):
    """A part of the file; keys that are not named here are for other readers, and passed over."""

    model_config = ConfigDict(frozen=True, extra="ignore", strict=True, allow_inf_nan=False)


class LinkLimits(Part):
    """The malleable link."""

    length: Range = Field(description="least and largest length of its centreline, m")
    min_bend_radius: Positive = Field(description="smallest radius of its centreline, m")
    diameter: Length = Field(default=0.0, description="outer diameter, m")
    max_total_bend: Positive | None = Field(default=None, description="largest total bend, rad; null: any")


class RigidLinkLimits(Part):
    """The rigid link."""

    d35: Range = Field(description="least and largest distance from P3 to P5, m")
    d45: Range = Field(description="least and largest distance from P4 to P5, m")
    diameter: Length = Field(default=0.0, description="outer diameter, m")


class RigidLinksPart(Part):
    """A catalogue of rigid links."""

    names: Some[str] = Field(description="what the rigid links are called")
    links: Some[RigidLinkLimits] = Field(description="the rigid links, each of one length d35 and d45")


class JointRanges(Part):
    """Ranges of the joints."""

    base: Range = Field(description="range of joint 1, rad")
    second: Range = Field(description="range of joint 2, rad")


class JointRatesPart(Part):
    """How fast joints 1 and 2 may turn."""

    speeds: Rates = Field(description="largest speeds of joints 1 and 2, rad/s")
    accelerations: Rates = Field(description="largest accelerations of joints 1 and 2, rad/s^2")


class RobotPart(Part):
    """The hardware."""

    name: str = Field(description="what the robot is called")
    d12: Positive = Field(description="distance from P1 to P2, m")
    link: LinkLimits = Field(description="the malleable link")
    tip_offset: Number = Field(description="where the link ends, from P3 towards P4, m")
    d34: Positive = Field(description="distance from P3 to P4, m")
    rigid_link: RigidLinkLimits = Field(description="the rigid link; of a catalogue the one chosen")
    rigid_links: RigidLinksPart | None = Field(default=None, description="the catalogue; null: there is none")
    joint_limits: JointRanges = Field(description="ranges of the joints")
    joint_rates: JointRatesPart | None = Field(
        default=None, description="how fast the joints may turn; null: as the published prototype"
    )


class BasePart(Part):
    """Where the robot stands in the task frame."""

    position: Point = Field(description="[x, y, z] of P1, m")
    yaw: Number = Field(default=0.0, description="rotation about the vertical, after the others, rad")
    pitch: Number = Field(default=0.0, description="rotation about the y axis, after roll, rad")
    roll: Number = Field(default=0.0, description="rotation about the x axis, rad")


class IntervalPart(Part):
    """What may be chosen of a number."""

    lower: Number = Field(description="the least")
    upper: Number = Field(description="the largest")


class PlacesPart(Part):
    """Where the base could be made to stand: ranges of its numbers, or names and poses of places."""

    x: IntervalPart | None = Field(default=None, description="of P1, m")
    y: IntervalPart | None = Field(default=None, description="of P1, m")
    z: IntervalPart | None = Field(default=None, description="of P1, m")
    roll: IntervalPart | None = Field(default=None, description="rad")
    pitch: IntervalPart | None = Field(default=None, description="rad")
    yaw: IntervalPart | None = Field(default=None, description="rad")
    names: Some[str] | None = Field(default=None, description="what the places are called")
    poses: Some[BasePart] | None = Field(default=None, description="where they are")


class ApproachPart(Part):
    """The direction in which the rigid link points as it arrives."""

    direction: Point = Field(description="unit vector in the task frame")
    tolerance: Positive = Field(description="largest angle between the two, rad")


class TargetPart(Part):
    """A point to be reached."""

    name: str = Field(description="how the result speaks of it")
    position: Point = Field(description="[x, y, z] in the task frame, m")
    tolerance: Positive = Field(description="largest miss that counts as reached, m")
    weight: Positive = Field(default=1.0, description="factor of its squared miss")
    approach: ApproachPart | None = Field(default=None, description="direction of arrival, or null")


class SpherePart(Part):
    """A ball."""

    center: Point = Field(description="[x, y, z] in the task frame, m")
    radius: Positive = Field(description="its radius, m")


class CapsulePart(Part):
    """All points within a radius of a segment."""

    start: Point = Field(alias="from", description="one end of the segment, m")
    end: Point = Field(alias="to", description="the other end, m")
    radius: Positive = Field(description="its radius, m")


class BoxPart(Part):
    """A box."""

    center: Point = Field(description="[x, y, z] in the task frame, m")
    size: Annotated[list[Positive], Field(min_length=3, max_length=3)] = Field(
        description="extent along its own axes, m"
    )
    yaw: Number = Field(default=0.0, description="rotation of these axes about the vertical, rad")
    pitch: Number = Field(default=0.0, description="rotation about the y axis, before it, rad")
    roll: Number = Field(default=0.0, description="rotation about the x axis, before both, rad")


class ObstaclePart(Part):
    """A solid to keep clear of: one of sphere, box and capsule."""

    name: str = Field(description="how the result speaks of it")
    sphere: SpherePart | None = Field(default=None, description="a ball")
    box: BoxPart | None = Field(default=None, description="a box")
    capsule: CapsulePart | None = Field(default=None, description="a thick segment")

    @property
    def solid(self) -> SpherePart | BoxPart | CapsulePart:
        """The one that is given."""
        return next(solid for solid in (self.sphere, self.box, self.capsule) if solid is not None)

    @model_validator(mode="after")
    def _one_solid(self) -> ObstaclePart:
        if sum(solid is not None for solid in (self.sphere, self.box, self.capsule)) != 1:
            raise ValueError("must be one of sphere, box and capsule")
        return self


class ArcPart(Part):
    """An arc of the link, in the frame that the link carries along without torsion."""

    curvature: Annotated[list[Number], Field(min_length=2, max_length=2)] = Field(
        description="[kx, ky], 1/m; kx > 0 bends towards +x"
    )
    length: Length = Field(description="its length, m")


class CurrentPart(Part):
    """The present shape of the link."""

    arcs: Some[ArcPart] = Field(description="its arcs, from P2 on")


class SurfacePart(Part):
    """A surface of which targets are the samples, whose weights are in proportion to their areas."""

    name: str = Field(description="what the surface is called")
    coverage: Annotated[float, Field(gt=0.0, le=1.0)] = Field(description="share of it to be covered")
    tolerance: Positive = Field(description="largest miss, m")
    first: int = Field(ge=0, description="the first target that is a sample of it, counted from 0")
    samples: int = Field(ge=1, description="how many of them there are")


class PathPart(Part):
    """A path to be followed; its samples are among the targets, after those of the surfaces."""

    name: str = Field(description="what the path is called")
    waypoints: Annotated[list[Point], Field(min_length=2)] = Field(description="points that it passes, m")
    closed: bool = Field(default=False, description="whether it goes back to its first waypoint")
    interpolation: Annotated[Interpolation, Field(strict=False)] = Field(
        default=Interpolation.STRAIGHT, description="what is between the waypoints"
    )
    tolerance: Positive = Field(description="how far the end effector may stray from it, m")
    speed: Positive | None = Field(default=None, description="speed along it, m/s; null: all one")


class ReleasedTaskPart(Part):
    """A task; one that was released may leave out its targets, which are then those of the task."""

    name: str = Field(description="what the task is called")
    robot: RobotPart = Field(description="the hardware")
    base: BasePart = Field(description="where the robot stands")
    places: PlacesPart | None = Field(default=None, description="where the base could stand; null: given")
    floor: Number | None = Field(default=None, description="height in the task frame, m; null: no floor")
    floor_at_base: bool = Field(default=False, description="whether that is where an upright base stands")
    topology: Annotated[Topology, Field(strict=False)] = Field(
        default=Topology.ANY, description="kind of shape asked for"
    )
    objective: Annotated[Objective, Field(strict=False)] = Field(
        default=Objective.LEAST_SQUARES, description="norm of miss over tolerance that is made small"
    )
    targets: Some[TargetPart] | None = Field(default=None, description="the points to reach")
    surfaces: list[SurfacePart] = Field(default=[], description="surfaces of which targets are samples")
    paths: list[PathPart] = Field(default=[], description="paths to be followed")
    obstacles: list[ObstaclePart] = Field(default=[], description="solids to keep clear of")
    current: CurrentPart | None = Field(default=None, description="the present shape of the link, or null")


class TaskPart(ReleasedTaskPart):
    """What was asked, whole."""

    targets: Some[TargetPart] = Field(description="the points to reach")
