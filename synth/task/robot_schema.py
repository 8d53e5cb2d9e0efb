"""What a robot file may hold, in the units of the file: the pydantic models."""

from __future__ import annotations

from typing import Annotated

from pydantic import Discriminator, Field, Tag, ValidationInfo, field_validator

from synth.robot import no_triangle
from synth.task.entry_types import (
    MAPPING,
    ONE,
    ONE_OF,
    RANGE,
    TEXT,
    AngleRange,
    Coordinate,
    LengthUnit,
    Name,
    Pair,
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


class LengthsEntry(Strict):
    """Lengths of which one is chosen."""

    one_of: Annotated[list[Positive], Field(min_length=1)] = Field(
        description="lengths of a catalogue; the first d35 goes with the first d45, and so on"
    )


def _of_length(value: object) -> str:
    return RANGE if isinstance(value, list) else ONE_OF if isinstance(value, dict) else ONE


Length = Annotated[
    Annotated[Positive, Tag(ONE)]
    | Annotated[Pair[Positive], Tag(RANGE)]
    | Annotated[LengthsEntry, Tag(ONE_OF)],
    Discriminator(_of_length),
]


class RigidLinkEntry(Strict):
    """The rigid link; [low, high] is to be chosen by the synthesis, and so is one of a catalogue."""

    d35: Length = Field(description="distance from P3 to the end effector P5")
    d45: Length = Field(description="distance from P4 to the end effector P5")
    diameter: Positive = Field(default_factory=absent, description="outer diameter; 0 if absent")


class CatalogueItemEntry(Strict):
    """A rigid link of a catalogue."""

    name: Name = Field(default_factory=absent, description="how the result speaks of it")
    d35: Positive = Field(description="its distance from P3 to the end effector P5")
    d45: Positive = Field(description="its distance from P4 to the end effector P5")
    diameter: Positive = Field(
        default_factory=absent, description="its outer diameter; that of the catalogue if absent"
    )


class CatalogueEntry(Strict):
    """A catalogue of rigid links, of which the synthesis chooses one."""

    one_of: Annotated[list[CatalogueItemEntry], Field(min_length=1)] = Field(
        description="rigid links of which one is chosen, in place of d35 and d45"
    )
    diameter: Positive = Field(default_factory=absent, description="outer diameter; 0 if absent")


class JointLimitsEntry(Strict):
    """Ranges of the joints in degrees."""

    base: AngleRange = Field(default_factory=absent, description="range of joint 1; a full turn if absent")
    second: AngleRange = Field(default_factory=absent, description="range of joint 2; a full turn if absent")


class JointRateEntry(Strict):
    """How fast a joint may turn."""

    max_speed_deg_s: Positive = Field(
        default_factory=absent, description="largest speed; 150, the prototype's 25 rpm, if absent"
    )
    max_acceleration_deg_s2: Positive = Field(
        default_factory=absent, description="largest acceleration; 10 rad/s^2 if absent"
    )


class JointRatesEntry(Strict):
    """How fast the joints may turn."""

    base: JointRateEntry = Field(default_factory=JointRateEntry, description="of joint 1")
    second: JointRateEntry = Field(default_factory=JointRateEntry, description="of joint 2")


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
    rigid_link: Annotated[
        Annotated[RigidLinkEntry, Tag(MAPPING)] | Annotated[CatalogueEntry, Tag(ONE_OF)],
        Discriminator(lambda value: ONE_OF if isinstance(value, dict) and "one_of" in value else MAPPING),
    ] = Field(description="the distances d35 and d45 to the end effector, or a catalogue of them")
    joint_limits_deg: JointLimitsEntry = Field(
        default_factory=JointLimitsEntry, description="ranges of the joints, in degrees"
    )
    joint_rates: JointRatesEntry = Field(
        default_factory=JointRatesEntry, description="how fast the joints may turn: for trajectories"
    )

    @field_validator("rigid_link")
    @classmethod
    def _triangle(
        cls, rigid_link: RigidLinkEntry | CatalogueEntry, info: ValidationInfo
    ) -> RigidLinkEntry | CatalogueEntry:
        """Ask for one choice at least with |d35 - d45| <= d34 <= d35 + d45."""
        if (d34 := info.data.get("d34")) is None or isinstance(rigid_link, CatalogueEntry):
            return rigid_link
        d35, d45 = rigid_link.d35, rigid_link.d45
        if isinstance(d35, LengthsEntry) or isinstance(d45, LengthsEntry):
            return rigid_link
        if wrong := no_triangle(d34, ends(d35), ends(d45)):
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
