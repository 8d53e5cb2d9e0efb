"""What `solution.json` holds, all of it: the pydantic models. Metres, radians and seconds.

A key without default is one without which there is no solution. What can be computed from others, such as
`gamma` or `guide`, is there for other programs: the reader computes it again.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal, Self

from pydantic import Field, model_validator

from synth.geometry import Category  # noqa: TC001 - pydantic reads the annotation
from synth.solution_file.task_schema import (
    ApproachPart,
    ArcPart,
    BasePart,
    Joints,
    Length,
    Number,
    Part,
    Point,
    ReleasedTaskPart,
    Some,
    TaskPart,
)
from synth.solution_file.told_schema import (  # noqa: TC001 - as above
    BoundPart,
    CoveringPart,
    FiguresPart,
    FollowedPart,
    GammaPart,
    GuidePart,
    InvariantsPart,
    TimePart,
    WayPart,
)
from synth.synthesis import Status  # noqa: TC001 - as above
from synth.task import json_schema

SCHEMA = "synth.solution/2"


class LinkPart(Part):
    """A shape of the malleable link."""

    arcs: Some[ArcPart] = Field(description="its arcs, from P2 on")
    length: Length | None = Field(default=None, description="length of its centreline, m")
    min_bend_radius: Length | None = Field(default=None, description="its smallest radius, m; null: straight")
    total_bend: Length | None = Field(default=None, description="integral of its curvature, rad")
    centreline: list[Point] | None = Field(default=None, description="points along it in the task frame, m")


class RigidLinkPart(Part):
    """The rigid link as it is chosen."""

    name: str | None = Field(default=None, description="what its catalogue calls it; absent: there is none")
    d35: Number = Field(gt=0.0, description="distance from P3 to P5, m")
    d45: Number = Field(gt=0.0, description="distance from P4 to P5, m")


class TargetResultPart(Part):
    """What becomes of a target, in short."""

    name: str = Field(description="the target's name")
    miss: Length | None = Field(default=None, description="distance of the end effector from it, m")
    within_tolerance: bool | None = Field(default=None, description="whether it is reached")
    joints: Joints | None = Field(default=None, description="[theta1, theta2] there, rad")


class TargetPart(TargetResultPart):
    """What becomes of a target."""

    position: Point | None = Field(default=None, description="where it is, m")
    reached: Point | None = Field(default=None, description="where the end effector gets to, m")
    tolerance: Number | None = Field(default=None, description="largest miss that counts as reached, m")
    approach: ApproachPart | None = Field(default=None, description="direction of arrival asked for, or null")
    astray: Number | None = Field(default=None, description="angle of the rigid link beside that, rad")
    clearance: Number | None = Field(default=None, description="from obstacles, m; null: there are none")
    alternatives: list[Joints] = Field(default=[], description="other joint angles that reach it, rad")


class ShapePart(Part):
    """What describes a shape of the robot, if there is one."""

    link: LinkPart | None = Field(default=None, description="the shape of the link; null: none was found")
    rigid_link: RigidLinkPart | None = Field(default=None, description="the rigid link; absent: by distances")
    base: BasePart | None = Field(default=None, description="where it stands; absent: as the task says")
    distances: dict[str, Number] | None = Field(default=None, description="distances of the points, m")
    category: Category | None = Field(default=None, strict=False, description="the kind of arm")
    ways: list[WayPart] | None = Field(default=None, description="from each target to the next")
    figures: FiguresPart | None = Field(default=None, description="by which shapes are compared")

    @model_validator(mode="after")
    def _rigid_link_is_known(self) -> Self:
        if self.link and not self.rigid_link and not {"35", "45"} <= set(self.distances or ()):
            raise ValueError("must state d35 and d45: under rigid_link, or as the distances 35 and 45")
        return self

    @property
    def d35_d45(self) -> tuple[float, float]:
        """The distances from P3 and P4 to P5, m; those of `distances` are rounded."""
        if self.rigid_link is not None:
            return self.rigid_link.d35, self.rigid_link.d45
        distances = self.distances or {}
        return distances["35"], distances["45"]


class DesignPart(ShapePart):
    """A shape of the robot."""

    link: LinkPart = Field(description="the shape of the link")
    shape: int | None = Field(default=None, ge=1, description="its number, counted from 1, the best")
    targets: list[TargetResultPart] = Field(default=[], description="what becomes of the targets")


class ReleasePart(Part):
    """A limit that blocks the task, and how much less of it would do."""

    limit: str = Field(description="name of the limit")
    amount: Number = Field(description="by how much it has to give way, m or rad")
    share: Number = Field(description="the same as a share of what the limit is")
    sentence: str = Field(description="what would do")
    task: ReleasedTaskPart = Field(description="the task released so far")
    design: DesignPart = Field(description="a shape that meets it")


class SolutionFile(ShapePart):
    """A solution with its task, from which it can be verified again."""

    schema_: Literal["synth.solution/2"] = Field(alias="schema", description="name of this format")
    task: TaskPart = Field(description="what was asked, with the robot")
    status: Annotated[Status, Field(strict=False)] = Field(description="how the search ended")
    message: str = Field(description="the same as a sentence")
    version: str = Field(default="", description="version of synth that found it")
    reasons: list[str] = Field(default=[], description="why no more was found, as far as that is known")
    seed: int = Field(default=0, ge=0, description="seed of the search")
    starts: int = Field(default=0, ge=0, description="how many start points were polished")
    shape: int | None = Field(default=None, ge=1, description="number of the shape told of; null: none")
    time: TimePart | None = Field(default=None, description="where the time went, s")
    squared_distances: dict[str, Number] | None = Field(default=None, description="their squares, m^2")
    gamma: GammaPart | None = Field(default=None, description="the workspace surface")
    invariants: InvariantsPart | None = Field(default=None, description="the numbers that determine it")
    category_distances: dict[str, float | None] | None = Field(
        default=None, description="how far it is from each special category"
    )
    guide: GuidePart | None = Field(default=None, description="where the markers must be")
    targets: list[TargetPart] = Field(default=[], description="what becomes of the targets")
    targets_left_out: int = Field(default=0, ge=0, description="of how many targets nothing is told")
    targets_unseen: int = Field(default=0, ge=0, description="how many targets there was no time to look at")
    surfaces: list[CoveringPart] | None = Field(default=None, description="what is covered of surfaces")
    paths: list[FollowedPart] | None = Field(default=None, description="how paths are followed")
    bound: BoundPart | None = Field(default=None, description="what is proven of all shapes; null: nothing")
    explained: bool = Field(default=False, description="whether releases were looked for")
    releases: list[ReleasePart] = Field(default=[], description="what would release the task")
    notes: list[str] = Field(default=[], description="what else is to be said")
    breakdown: str = Field(default="", description="traceback of what broke off the search")
    alternatives: list[DesignPart] = Field(default=[], description="the other shapes")


def solution_schema() -> dict[str, Any]:
    """Return the JSON Schema (draft 2020-12) of `solution.json`."""
    return json_schema(SolutionFile.model_json_schema())
