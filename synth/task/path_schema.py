"""What a task file may say of a path that shall be followed: the pydantic models."""

from __future__ import annotations

from typing import Annotated

from pydantic import BeforeValidator, Discriminator, Field, Tag, model_validator

from synth.paths import Interpolation
from synth.task.entry_types import MAPPING, RANGE, Name, Position, Positive, Strict, absent, without_case


class PathEntry(Strict):
    """A path that the end effector shall follow in one go."""

    name: Name = Field(default_factory=absent, description="how the result speaks of it")
    waypoints: list[Position] = Field(
        default_factory=absent, description="points that it passes, [x, y, z] each, in the task frame"
    )
    csv: Annotated[str, Field(min_length=1)] = Field(
        default_factory=absent,
        description="in their place the path of a file of them: CSV, XYZ, PLY, OBJ or PCD",
    )
    closed: bool = Field(default=False, description="whether it goes back to its first waypoint")
    interpolation: Annotated[Interpolation, Field(strict=False), BeforeValidator(without_case)] = Field(
        default=Interpolation.STRAIGHT, description="what is between the waypoints"
    )
    tolerance: Positive = Field(
        default_factory=absent, description="how far the end effector may stray from it; 1 mm if absent"
    )
    speed: Positive = Field(
        default_factory=absent, description="speed of the end effector along it, per second"
    )

    @model_validator(mode="after")
    def _one_of_both(self) -> PathEntry:
        """Ask for exactly one description."""
        if (self.waypoints is None) == (self.csv is None):
            raise ValueError("must have either waypoints or csv")
        return self


Paths = Annotated[
    Annotated[PathEntry, Tag(MAPPING)] | Annotated[list[PathEntry], Field(min_length=1), Tag(RANGE)],
    Discriminator(lambda value: {dict: MAPPING, list: RANGE}.get(type(value))),
]
