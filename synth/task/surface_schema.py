"""What a task file may say of a surface that shall be covered: the pydantic models."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BeforeValidator, Discriminator, Field, Tag, model_validator

from synth.arrays import FloatArray
from synth.surfaces import Profile, Rectangle, Revolved
from synth.task.entry_types import (
    MAPPING,
    RANGE,
    Angle,
    LengthUnit,
    Name,
    Position,
    Positive,
    SolidEntry,
    Strict,
    absent,
    without_case,
)

# A shape in its own frame, where that is, shape (3,), m, and how it is turned, shape (3, 3).
Placed = tuple[Revolved | Rectangle, FloatArray, FloatArray]
_PARALLEL = 1e-6  # sine of an angle
_Path = Annotated[str, Field(min_length=1)]
_TwoLengths = Annotated[list[Positive], Field(min_length=2, max_length=2)]


_Direction = Annotated[Position, Field(description="[x, y, z], of any length")]


class _Turned(Strict):
    """Base of surfaces with a direction."""

    @model_validator(mode="after")
    def _has_direction(self) -> _Turned:
        for key in ("axis", "normal", "along"):
            if not any(getattr(self, key, None) or [1.0]):
                raise ValueError(f"has {key}: [0, 0, 0], which is no direction")
        return self


class SphereSurface(Strict):
    """A sphere."""

    center: Position = Field(description="[x, y, z]")
    radius: Positive = Field(description="its radius")

    def placed(self, per_metre: float) -> Placed:
        """Return the shape, and where it is."""
        shape = Revolved(Profile.SPHERE, self.radius / per_metre)
        return shape, np.array(self.center) / per_metre, np.eye(3)


class CylinderSurface(Strict):
    """The wall of a cylinder, without its ends."""

    from_: Position = Field(alias="from", description="one end of its axis")
    to: Position = Field(description="the other end")
    radius: Positive = Field(description="its radius")

    @model_validator(mode="after")
    def _has_length(self) -> CylinderSurface:
        if self.from_ == self.to:
            raise ValueError("begins and ends at one point")
        return self

    def placed(self, per_metre: float) -> Placed:
        """Return the shape, and where it is."""
        start, end = np.array(self.from_) / per_metre, np.array(self.to) / per_metre
        shape = Revolved(Profile.CYLINDER, self.radius / per_metre, float(np.linalg.norm(end - start)))
        return shape, 0.5 * (start + end), turned_to(end - start)


class TorusSurface(_Turned):
    """A torus."""

    center: Position = Field(description="[x, y, z]")
    axis: _Direction = Field(description="direction of its axis")
    radii: _TwoLengths = Field(description="[R, r]: of the circle in the middle of its tube, of the tube")

    @model_validator(mode="after")
    def _tube(self) -> TorusSurface:
        if self.radii[1] >= self.radii[0]:
            raise ValueError("has radii [R, r] whose r, that of the tube, must be less than R")
        return self

    def placed(self, per_metre: float) -> Placed:
        """Return the shape, and where it is."""
        shape = Revolved(Profile.TORUS, *(radius / per_metre for radius in self.radii))
        return shape, np.array(self.center) / per_metre, turned_to(np.array(self.axis))


class RectangleSurface(_Turned):
    """A flat rectangle."""

    center: Position = Field(description="[x, y, z]")
    normal: _Direction = Field(description="direction across it")
    along: _Direction = Field(description="direction of its first side, as far as that is in it")
    size: _TwoLengths = Field(description="[a, b]: its side along that direction, and the other one")

    @model_validator(mode="after")
    def _sides(self) -> RectangleSurface:
        n, along = (np.array(v) / np.linalg.norm(v) for v in (self.normal, self.along))
        if float(np.linalg.norm(np.cross(n, along))) < _PARALLEL:
            raise ValueError("has along in the direction of normal, so its first side has none")
        return self

    def placed(self, per_metre: float) -> Placed:
        """Return the shape, and where it is."""
        frame = turned_to(np.array(self.normal), np.array(self.along))
        return Rectangle(np.array(self.size) / per_metre), np.array(self.center) / per_metre, frame


class DiscSurface(_Turned):
    """A flat disc."""

    center: Position = Field(description="[x, y, z]")
    normal: _Direction = Field(description="direction across it")
    radius: Positive = Field(description="its radius")

    def placed(self, per_metre: float) -> Placed:
        """Return the shape, and where it is."""
        shape = Revolved(Profile.DISC, self.radius / per_metre)
        return shape, np.array(self.center) / per_metre, turned_to(np.array(self.normal))


class PlaneSurface(_Turned):
    """A plane without end, of which a region counts."""

    point: Position = Field(description="[x, y, z] of a point in it")
    normal: _Direction = Field(description="direction across it")


class PoseEntry(Strict):
    """Where the frame of a surface is."""

    position: Position = Field(default=[0.0, 0.0, 0.0], description="[x, y, z] in the task frame")
    rpy_deg: Annotated[list[Angle], Field(min_length=3, max_length=3)] = Field(
        default=[0.0, 0.0, 0.0], description="[roll, pitch, yaw] about the fixed axes x, y, z"
    )


class SurfaceEntry(Strict):
    """A surface that the workspace shall cover."""

    name: Name = Field(default_factory=absent, description="how the result speaks of it")
    points: _Path = Field(
        default_factory=absent, description="path of a file of points: CSV, XYZ, PLY, OBJ or PCD"
    )
    mesh: _Path = Field(default_factory=absent, description="path of a file of triangles: STL, PLY or OBJ")
    sphere: SphereSurface = Field(default_factory=absent, description="center, radius")
    cylinder: CylinderSurface = Field(default_factory=absent, description="from, to, radius")
    torus: TorusSurface = Field(default_factory=absent, description="center, axis, radii: [R, r]")
    rectangle: RectangleSurface = Field(
        default_factory=absent, description="center, normal, along, size: [a, b]"
    )
    disc: DiscSurface = Field(default_factory=absent, description="center, normal, radius")
    plane: PlaneSurface = Field(default_factory=absent, description="point, normal; needs a region")
    length_unit: LengthUnit = Field(
        default_factory=absent, description="unit of the file of points or triangles; the task's if absent"
    )
    pose: PoseEntry = Field(default_factory=PoseEntry, description="where its frame is: position, rpy_deg")
    region: Annotated[list[SolidEntry], Field(min_length=1)] = Field(
        default_factory=absent, description="solids; only what is within one of them counts"
    )
    margin: Positive = Field(
        default_factory=absent, description="what is nearer to the surface's own boundary does not count"
    )
    side: Annotated[Literal["outer", "inner", "both"], BeforeValidator(without_case)] = Field(
        default="both", description="from which side it is worked on; a point may come from both"
    )
    tolerance: Positive = Field(
        default_factory=absent, description="largest miss of each point; 1 mm if absent"
    )
    coverage: Annotated[float, Field(ge=1e-6, le=1)] = Field(
        default=1.0, description="share of its area that shall be within tolerance"
    )

    @property
    def kind(self) -> str:
        """Which of `KINDS` it is."""
        return next(kind for kind in KINDS if getattr(self, kind) is not None)

    @model_validator(mode="after")
    def _one_kind(self) -> SurfaceEntry:
        given = [kind for kind in KINDS if getattr(self, kind) is not None]
        if len(given) != 1:
            wrong = f"has {' and '.join(given)}" if given else "has no shape"
            raise ValueError(f"{wrong}, but is one of {', '.join(KINDS[:-1])} and {KINDS[-1]}")
        if self.plane is not None and self.region is None:
            raise ValueError("is a plane without end: add a region, the solids within which it counts")
        if self.length_unit is not None and given[0] not in FILES:
            raise ValueError("has a length_unit, which is that of a file, but no file")
        if self.side != "both":
            raise ValueError(
                f"has side: {self.side}, but the end effector is a point here, which touches a surface "
                "from both sides alike; leave it away, or write both"
            )
        return self


KINDS = ("points", "mesh", "sphere", "cylinder", "torus", "rectangle", "disc", "plane")
FILES = ("points", "mesh")
Surfaces = Annotated[
    Annotated[SurfaceEntry, Tag(MAPPING)] | Annotated[list[SurfaceEntry], Field(min_length=1), Tag(RANGE)],
    Discriminator(lambda value: {dict: MAPPING, list: RANGE}.get(type(value))),
]


def turned_to(normal: FloatArray, along: FloatArray | None = None) -> FloatArray:
    """Return a frame as the columns of a rotation: z along `normal`, x along `along` as far as it may."""
    z = normal / np.linalg.norm(normal)
    x: Any = np.eye(3)[np.argmin(np.abs(z))] if along is None else along / np.linalg.norm(along)
    x = x - (x @ z) * z
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(z, x), z])
