"""What a file of measured shapes may hold, in the units of the file: the pydantic models."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from synth.geometry import Category  # noqa: TC001 - pydantic reads the annotation
from synth.task import (
    LARGEST,
    FileOfARobot,
    Name,
    Position,
    Positive,
    Strict,
    absent,
)

_Distance = Annotated[float, Field(ge=0.0, le=LARGEST)]


class DistancesEntry(Strict):
    """Distances as measured."""

    d13: _Distance = Field(description="distance from P1 to P3")
    d14: _Distance = Field(description="distance from P1 to P4")
    d23: _Distance = Field(description="distance from P2 to P3")
    d24: _Distance = Field(description="distance from P2 to P4")
    d15: _Distance = Field(default_factory=absent, description="distance from P1 to the end effector P5")
    d25: _Distance = Field(default_factory=absent, description="distance from P2 to the end effector P5")
    d12: Positive = Field(default_factory=absent, description="that of the robot if absent")
    d34: Positive = Field(default_factory=absent, description="that of the robot if absent")
    d35: Positive = Field(default_factory=absent, description="that of the robot if absent")
    d45: Positive = Field(default_factory=absent, description="that of the robot if absent")


class MarkersEntry(Strict):
    """Marker positions as measured, in any one frame."""

    P1: Position = Field(description="[x, y, z] of P1 on axis 1")
    P2: Position = Field(description="[x, y, z] of P2 on axis 1")
    P3: Position = Field(description="[x, y, z] of P3 on axis 2")
    P4: Position = Field(description="[x, y, z] of P4 on axis 2")
    P5: Position = Field(default_factory=absent, description="[x, y, z] of the end effector")


class ConfigurationEntry(Strict):
    """One measured shape."""

    intended: Annotated[Category, Field(strict=False)] = Field(
        default_factory=absent, description="kind of shape that was meant"
    )
    rounding: Positive = Field(default_factory=absent, description="step to which the numbers are rounded")
    sigma: Positive = Field(default_factory=absent, description="standard deviation of the numbers")
    distances: DistancesEntry = Field(default_factory=absent, description="the distances measured")
    markers: MarkersEntry = Field(default_factory=absent, description="the marker positions measured")


class MeasuredFile(ConfigurationEntry, FileOfARobot):
    """A file with one measured shape, or with several under `configurations`."""

    name: Name = Field(default_factory=absent, description="what the shape is called")
    configurations: dict[Name, ConfigurationEntry] = Field(
        default_factory=absent, description="several measured shapes by their names"
    )
