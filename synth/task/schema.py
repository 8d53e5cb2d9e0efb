"""What task and robot files may hold, in the units of the file: the pydantic models.

Ranges are wide: they keep out slips (a unit mistaken, a digit too many) and what would overflow.
"""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import (
    AfterValidator,
    BeforeValidator,
    Field,
    model_validator,
)

from synth.task.base_schema import BaseEntry
from synth.task.entry_types import (
    Angle,
    Coordinate,
    Name,
    Position,
    Positive,
    SolidEntry,
    Strict,
    absent,
    without_case,
)
from synth.task.model import Floor, Objective, Topology
from synth.task.path_schema import Paths  # noqa: TC001 - pydantic reads the annotation
from synth.task.robot_schema import FileOfARobot, RobotFile
from synth.task.surface_schema import Surfaces  # noqa: TC001 - pydantic reads the annotation


def _at_base() -> Any:
    """Return what the floor is where the key is absent, which null does not mean."""
    return Floor.AT_BASE


def _somewhere(direction: list[float]) -> list[float]:
    if not any(direction):
        raise ValueError("must point somewhere, but is zero")
    return direction


class ApproachEntry(Strict):
    """The direction in which the rigid link points as it arrives, from axis 2 to the end effector."""

    direction: Annotated[Position, AfterValidator(_somewhere)] = Field(
        description="[x, y, z] in the task frame, of any length"
    )
    tolerance_deg: Annotated[float, Field(gt=0, le=180)] = Field(
        default=5.0, description="largest angle between the two, deg"
    )


class TargetEntry(Strict):
    """A point to be reached."""

    name: Name = Field(default_factory=absent, description="how the result speaks of it")
    position: Position = Field(description="[x, y, z] in the task frame")
    tolerance: Positive = Field(default_factory=absent, description="largest miss; 1 mm if absent")
    weight: Positive = Field(default=1.0, description="factor of its squared miss")
    approach: ApproachEntry = Field(
        default_factory=absent, description="direction in which the rigid link points there"
    )


class ObstacleEntry(SolidEntry):
    """A solid to keep clear of: one of sphere, box and capsule."""

    name: Name = Field(default_factory=absent, description="how the result speaks of it")


class ArcEntry(Strict):
    """An arc of the link, in the frame that the link carries along without torsion."""

    curvature: Annotated[list[Coordinate], Field(min_length=2, max_length=2)] = Field(
        description="[kx, ky], per unit of length; kx > 0 bends towards +x"
    )
    length: Positive = Field(description="its length")


class MarkersEntry(Strict):
    """Where the axis points of joint 2 were measured."""

    P3: Position = Field(description="[x, y, z] in the task frame")
    P4: Position = Field(description="[x, y, z] in the task frame")
    joint1_deg: Angle = Field(default=0.0, description="where joint 1 stood")


class CurrentEntry(Strict):
    """The present shape of the link: its arcs from P2 on, or markers."""

    arcs: Annotated[list[ArcEntry], Field(min_length=1)] = Field(
        default_factory=absent, description="the arcs of the link, as a solution states them"
    )
    markers: MarkersEntry = Field(default_factory=absent, description="P3 and P4 as measured")

    @model_validator(mode="after")
    def _one_of_both(self) -> CurrentEntry:
        """Ask for exactly one description."""
        if (self.arcs is None) == (self.markers is None):
            raise ValueError("must have either arcs or markers")
        return self


class TaskFile(FileOfARobot):
    """A task file."""

    name: Name = Field(default_factory=absent, description="what the task is called")
    base: BaseEntry = Field(default_factory=BaseEntry, description="where the robot stands in the task frame")
    floor: Coordinate | None = Field(
        default_factory=_at_base,
        description="height in the task frame; null: no floor; absent: that of an upright base",
    )
    topology: Annotated[Topology, Field(strict=False), BeforeValidator(without_case)] = Field(
        default=Topology.ANY, description="kind of shape"
    )
    objective: Annotated[Objective, Field(strict=False), BeforeValidator(without_case)] = Field(
        default=Objective.LEAST_SQUARES, description="norm of miss over tolerance"
    )
    targets: Annotated[list[TargetEntry], Field(min_length=1)] = Field(description="the points to reach")
    surface: Surfaces = Field(
        default_factory=absent, description="a surface to be covered, or a list of them"
    )
    path: Paths = Field(default_factory=absent, description="a path to be followed, or a list of them")
    obstacles: list[ObstacleEntry] = Field(default=[], description="solids to keep clear of")
    current: CurrentEntry = Field(
        default_factory=absent, description="the present shape of the link, which is to change little"
    )


class SampledTaskFile(TaskFile):
    """A task file with a surface or a path: it may do without targets."""

    targets: Annotated[list[TargetEntry], Field(min_length=1)] = Field(
        default_factory=absent, description="the points to reach"
    )


def robot_schema() -> dict[str, Any]:
    """Return the JSON Schema of robot files."""
    return json_schema(RobotFile.model_json_schema())


def task_schema() -> dict[str, Any]:
    """Return the JSON Schema of task files, for editors that complete and check YAML."""
    schema = TaskFile.model_json_schema()
    schema["required"] = [key for key in schema["required"] if key != "targets"]
    schema["anyOf"] = [{"required": [key]} for key in ("targets", "surface", "path")]
    return json_schema(schema)


def json_schema(schema: dict[str, Any]) -> dict[str, Any]:
    """Return a schema with the name of its draft, so that it can stand alone."""
    return {"$schema": "https://json-schema.org/draft/2020-12/schema"} | schema
