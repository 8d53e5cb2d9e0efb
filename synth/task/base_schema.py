"""What a task file may say of where the robot stands: the pydantic models."""

from __future__ import annotations

from typing import Annotated

from pydantic import Discriminator, Field, Tag, model_validator

from synth.task.entry_types import (
    ONE,
    RANGE,
    Angle,
    AngleRange,
    Coordinate,
    Name,
    Pair,
    Position,
    Strict,
    absent,
)


def _kind(value: object) -> str:
    return RANGE if isinstance(value, list) else ONE


CoordinateOrRange = Annotated[
    Annotated[Coordinate, Tag(ONE)] | Annotated[Pair[Coordinate], Tag(RANGE)], Discriminator(_kind)
]
AngleOrRange = Annotated[Annotated[Angle, Tag(ONE)] | Annotated[AngleRange, Tag(RANGE)], Discriminator(_kind)]
_Angles = Annotated[list[Angle], Field(min_length=3, max_length=3)]


class ChoiceEntry(Strict):
    """One of the places where the robot may be made to stand."""

    name: Name = Field(default_factory=absent, description="how the result speaks of it")
    position: Position = Field(default=[0.0, 0.0, 0.0], description="[x, y, z] of P1")
    rpy_deg: _Angles = Field(
        default_factory=absent, description="[roll, pitch, yaw] about the fixed axes x, y, z"
    )
    yaw_deg: Angle = Field(
        default_factory=absent, description="rotation about the vertical; y is rpy_deg: [0, 0, y]"
    )

    @model_validator(mode="after")
    def _turned_once(self) -> ChoiceEntry:
        _refuse_both(self.rpy_deg, self.yaw_deg)
        return self


class BaseEntry(Strict):
    """Where the robot stands in the task frame, each number fixed or [lo, hi]; or a choice of places."""

    position: Annotated[list[CoordinateOrRange], Field(min_length=3, max_length=3)] = Field(
        default=[0.0, 0.0, 0.0], description="[x, y, z] of P1; each a number or [lo, hi]"
    )
    rpy_deg: Annotated[list[AngleOrRange], Field(min_length=3, max_length=3)] = Field(
        default_factory=absent,
        description="[roll, pitch, yaw] about the fixed axes x, y, z; each a number or [lo, hi]",
    )
    yaw_deg: AngleOrRange = Field(
        default_factory=absent, description="rotation about the vertical; y is rpy_deg: [0, 0, y]"
    )
    choices: Annotated[list[ChoiceEntry], Field(min_length=1)] = Field(
        default_factory=absent,
        description="places of which one is chosen: name, position, rpy_deg or yaw_deg",
    )

    @model_validator(mode="after")
    def _said_once(self) -> BaseEntry:
        _refuse_both(self.rpy_deg, self.yaw_deg)
        if self.choices is not None and self.model_fields_set - {"choices"}:
            raise ValueError(
                "has choices, so each of these says where the robot stands, and nothing beside them"
            )
        return self


def _refuse_both(rpy: object, yaw: object) -> None:
    if rpy is not None and yaw is not None:
        raise ValueError("has both rpy_deg and yaw_deg, but is turned by one of them")
