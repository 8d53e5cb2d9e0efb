"""What single entries of task and robot files may be: numbers in ranges, names, pairs."""

from __future__ import annotations

from typing import Annotated, Any, Literal, TypeVar

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Discriminator,
    Field,
    Tag,
    model_validator,
)

from synth.checks import wrong_name
from synth.rounding import written_apart

# Tags of unions, never keys.
ONE = "<one>"
RANGE = "<range>"
TEXT = "<text>"
MAPPING = "<mapping>"
ONE_OF = "<one of>"
SMALLEST = 1e-9
LARGEST = 1e6


def _in_order(limits: list[float]) -> list[float]:
    if limits[0] > limits[1]:
        raise ValueError(f"must run from low to high, but is [{', '.join(written_apart(*limits))}]")
    return limits


def _within_a_turn(limits: list[float]) -> list[float]:
    if limits[1] - limits[0] > 360:
        wide, _ = written_apart(limits[1] - limits[0], 360.0)
        raise ValueError(f"must be at most 360 degrees wide, but is {wide}")
    return limits


def _one_line(text: str) -> str:
    if wrong := wrong_name(text):
        raise ValueError(wrong)
    return text


def without_case(word: Any) -> Any:
    """Return a fixed word in small letters, as the format has it."""
    return word.lower() if isinstance(word, str) else word


def absent() -> Any:
    """Return the value of a key that was not written; to write null is a mistake all the same."""
    return None


_T = TypeVar("_T")
Pair = Annotated[list[_T], Field(min_length=2, max_length=2), AfterValidator(_in_order)]
Name = Annotated[str, AfterValidator(_one_line)]
LengthUnit = Annotated[Literal["mm", "cm", "m"], BeforeValidator(without_case)]
Coordinate = Annotated[float, Field(ge=-LARGEST, le=LARGEST)]
Position = Annotated[list[Coordinate], Field(min_length=3, max_length=3)]
Positive = Annotated[float, Field(ge=SMALLEST, le=LARGEST)]
Angle = Annotated[float, Field(ge=-720, le=720)]
AngleRange = Annotated[Pair[Angle], AfterValidator(_within_a_turn)]
PositiveOrRange = Annotated[
    Annotated[Positive, Tag(ONE)] | Annotated[Pair[Positive], Tag(RANGE)],
    Discriminator(lambda value: RANGE if isinstance(value, list) else ONE),
]


def default_name(kind: str, index: int) -> str:
    """Return what the entry at an index is called if it states no name."""
    return f"{kind} {index + 1}"


def ends(value: float | list[float]) -> tuple[float, float]:
    """Return the ends of a `PositiveOrRange`; one number is both."""
    return (value[0], value[1]) if isinstance(value, list) else (value, value)


class Strict(BaseModel):
    """Base of all entries: no unknown key, no silent conversion, no NaN."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False)


class SphereEntry(Strict):
    """A ball."""

    center: Position = Field(description="[x, y, z] in the task frame")
    radius: Positive = Field(description="its radius")


class BoxEntry(Strict):
    """A box with vertical edges."""

    center: Position = Field(description="[x, y, z] in the task frame")
    size: Annotated[list[Positive], Field(min_length=3, max_length=3)] = Field(
        description="its extent along its own x, y and z axes"
    )
    yaw_deg: Angle = Field(default=0.0, description="rotation of these axes about the vertical")


class CapsuleEntry(Strict):
    """All points within a radius of a segment."""

    from_: Position = Field(alias="from", description="one end of the segment")
    to: Position = Field(description="the other end")
    radius: Positive = Field(description="its radius")


class SolidEntry(Strict):
    """One of sphere, box and capsule."""

    sphere: SphereEntry = Field(default_factory=absent, description="a ball: center, radius")
    box: BoxEntry = Field(default_factory=absent, description="a box: center, size, yaw_deg")
    capsule: CapsuleEntry = Field(default_factory=absent, description="a thick segment: from, to, radius")

    @property
    def solid(self) -> SphereEntry | BoxEntry | CapsuleEntry:
        """The one that is given."""
        return next(solid for solid in (self.sphere, self.box, self.capsule) if solid is not None)

    @model_validator(mode="after")
    def _one_solid(self) -> SolidEntry:
        """Ask for exactly one solid."""
        given = [kind for kind in ("sphere", "box", "capsule") if getattr(self, kind) is not None]
        if len(given) != 1:
            wrong = f"has {' and '.join(given)}" if given else "has no solid"
            raise ValueError(f"{wrong}, but is one of sphere, box and capsule")
        return self
