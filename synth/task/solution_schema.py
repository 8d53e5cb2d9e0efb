"""What is read of a solution file: the pydantic models."""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, model_validator

from synth.task.model import Objective, Topology

_Number = Annotated[float, Field(ge=-1e9, le=1e9)]
_Positive = Annotated[float, Field(gt=0.0, le=1e9)]
_Point = Annotated[list[_Number], Field(min_length=3, max_length=3)]
_Range = Annotated[list[_Number], Field(min_length=2, max_length=2)]


class _Part(BaseModel):
    """A part of the file; what it holds beside the fields named is for other readers."""

    model_config = ConfigDict(frozen=True, extra="ignore", strict=False, allow_inf_nan=False)


class _LinkLimits(_Part):
    length: _Range
    min_bend_radius: _Positive
    diameter: _Number = 0.0
    max_total_bend: _Positive | None = None


class _RigidLink(_Part):
    d35: _Range
    d45: _Range
    diameter: _Number = 0.0


class _Limits(_Part):
    base: _Range
    second: _Range


class _Robot(_Part):
    name: str
    d12: _Positive
    link: _LinkLimits
    tip_offset: _Number
    d34: _Positive
    rigid_link: _RigidLink
    joint_limits: _Limits


class _Base(_Part):
    position: _Point
    yaw: _Number = 0.0


class _Target(_Part):
    name: str
    position: _Point
    tolerance: _Positive
    weight: _Positive = 1.0


class _Ball(_Part):
    center: _Point
    radius: _Positive


class _Capsule(_Part):
    start: _Point = Field(alias="from")
    end: _Point = Field(alias="to")
    radius: _Positive


class _Box(_Part):
    center: _Point
    size: _Point
    yaw: _Number = 0.0


class SolidEntry(_Part):
    """A solid to keep clear of."""

    name: str
    sphere: _Ball | None = None
    box: _Box | None = None
    capsule: _Capsule | None = None

    @model_validator(mode="after")
    def _one_solid(self) -> SolidEntry:
        if sum(solid is not None for solid in (self.sphere, self.box, self.capsule)) != 1:
            raise ValueError("must be one of sphere, box and capsule")
        return self


class TaskEntry(_Part):
    """What was asked."""

    name: str
    robot: _Robot
    targets: Annotated[list[_Target], Field(min_length=1)]
    base: _Base
    floor: _Number | None = None
    topology: Topology = Topology.ANY
    objective: Objective = Objective.LEAST_SQUARES
    obstacles: list[SolidEntry] = []


class _Arc(_Part):
    curvature: Annotated[list[_Number], Field(min_length=2, max_length=2)]
    length: _Positive


class _Link(_Part):
    arcs: Annotated[list[_Arc], Field(min_length=1)]


class ShapeEntry(_Part):
    """A shape of the link, with the rigid link that was chosen for it."""

    link: _Link
    distances: dict[str, _Number]

    @model_validator(mode="after")
    def _rigid_link(self) -> ShapeEntry:
        if not {"35", "45"} <= set(self.distances):
            raise ValueError("must hold the distances 35 and 45")
        return self


class SolutionFile(_Part):
    """A solution file, of which only task and shapes are read."""

    task: TaskEntry
    link: _Link | None = None
    distances: dict[str, _Number] | None = None
    alternatives: list[ShapeEntry] = []
