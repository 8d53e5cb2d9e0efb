"""What a robot file may hold, in the units of the file: the pydantic models."""

from __future__ import annotations

from typing import Annotated

from pydantic import Discriminator, Field, Tag, ValidationInfo, field_validator

from synth.robot import no_triangle
from synth.task.entry_types import (
    MAPPING,
    TEXT,
    AngleRange,
    Coordinate,
    LengthUnit,
    Name,
    Positive,
    PositiveOrRange,
    Strict,
    absent,
    ends,
)


class LinkEntry(Strict):
    """The malleable link."""

    length: PositiveOrRange = Field(description="length of its centreline, or [low, high] if it stretches")
    min_bend_radius: Positive = Field(description="smallest radius of its centreline")
    diameter: Positive = Field(default_factory=absent, description="outer diameter; 0 if absent")
    max_total_bend_deg: Positive = Field(default_factory=absent, description="no limit if absent")


class RigidLinkEntry(Strict):
    """The rigid link; [low, high] is to be chosen by the synthesis."""

    d35: PositiveOrRange = Field(description="distance from P3 to the end effector P5")
    d45: PositiveOrRange = Field(description="distance from P4 to the end effector P5")
    diameter: Positive = Field(default_factory=absent, description="outer diameter; 0 if absent")


class JointLimitsEntry(Strict):
    """Ranges of the joints in degrees."""

    base: AngleRange = Field(default_factory=absent, description="range of joint 1; a full turn if absent")
    second: AngleRange = Field(default_factory=absent, description="range of joint 2; a full turn if absent")


class RobotEntry(Strict):
    """A robot inside a task; its unit is that of the task unless it states its own."""

    name: Name = Field(default_factory=absent, description="what the robot is called")
    length_unit: LengthUnit = Field(default_factory=absent, description="unit of all lengths: mm, cm or m")
    d12: Positive = Field(description="distance from P1 to P2, where the malleable link starts")
    link: LinkEntry = Field(description="the malleable link: length, min_bend_radius, diameter")
    d34: Positive = Field(description="distance of the points P3 and P4 on the second axis")
    tip_offset: Coordinate = Field(
        default_factory=absent, description="where the link ends, from P3 towards P4; d34 / 2 if absent"
    )
    rigid_link: RigidLinkEntry = Field(description="the distances d35 and d45 to the end effector")
    joint_limits_deg: JointLimitsEntry = Field(
        default_factory=JointLimitsEntry, description="ranges of the joints, in degrees"
    )

    @field_validator("rigid_link")
    @classmethod
    def _triangle(cls, rigid_link: RigidLinkEntry, info: ValidationInfo) -> RigidLinkEntry:
        """Ask for one choice at least with |d35 - d45| <= d34 <= d35 + d45."""
        if (d34 := info.data.get("d34")) is None:
            return rigid_link
        if wrong := no_triangle(d34, ends(rigid_link.d35), ends(rigid_link.d45)):
            raise ValueError(wrong)
        return rigid_link


class RobotFile(RobotEntry):
    """A robot file."""

    length_unit: LengthUnit = Field(description="unit of all lengths in this file: mm, cm or m")


class FileOfARobot(Strict):
    """What every file begins with that tells of a robot."""

    synth: Annotated[int, Field(ge=1, le=1)] = Field(description="version of this format: 1")
    name: Name = Field(default_factory=absent, description="what it is called")
    length_unit: LengthUnit = Field(description="unit of all lengths in this file: mm, cm or m")
    robot: Annotated[
        Annotated[str, Tag(TEXT)] | Annotated[RobotEntry, Tag(MAPPING)],
        Discriminator(lambda value: {str: TEXT, dict: MAPPING}.get(type(value))),
    ] = Field(description="a preset's name, the path of a robot file, or a mapping")
