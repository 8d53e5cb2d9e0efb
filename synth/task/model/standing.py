"""Where the robot of a task stands, and what it keeps clear of, seen from there."""

from __future__ import annotations

import math
from dataclasses import replace
from enum import Enum
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import frozen_value
from synth.checks import Checks
from synth.geometry import Box, Capsule, Solid, Sphere

if TYPE_CHECKING:
    from typing import Self

    from synth.arrays import FloatArray
    from synth.robot import BasePlaces, BasePose

_SLAB = 100.0  # m: the edge of the block that stands for a floor


class Floor(Enum):
    """A floor that is not told as a height."""

    AT_BASE = "at base"


@frozen_value
class Obstacle:
    """A solid that link, rigid link and end effector keep clear of.

    Attributes:
        name: How the result speaks of it.
        solid: Where it is, in the task frame, m.
    """

    name: str
    solid: Solid

    def __post_init__(self) -> None:
        checks = Checks(self)
        checks.name("name")
        checks.is_a("solid", (Sphere, Box, Capsule))
        checks.refuse()


class Standing:
    """What of a task tells where its robot stands, and what that keeps clear of there; see `Task`."""

    base: BasePose
    floor: float | Floor | None
    obstacles: tuple[Obstacle, ...]
    places: BasePlaces | None

    def standing_at(self, base: BasePose) -> Self:
        """Return the same task with the base at one of its places, and no choice of it left."""
        return replace(self, base=base, places=None)  # type: ignore[type-var]

    def lowest_from(self, base: BasePose) -> float:
        """Return the height in the frame of an upright base that the arm stays above, m; -inf for none.

        Where the base leans the floor is a solid to keep clear of, see `solids_from`.
        """
        if self.floor is None or not base.is_upright:
            return -math.inf
        return 0.0 if isinstance(self.floor, Floor) else self.floor - float(base.position[2])

    def solids_from(self, base: BasePose) -> tuple[Solid, ...]:
        """Return what the arm keeps clear of in the frame of a base."""
        return tuple(
            obstacle.solid.seen_from(base.position, base.rotation) for obstacle in self.obstacles_from(base)
        )

    def obstacles_from(self, base: BasePose) -> tuple[Obstacle, ...]:
        """Return the obstacles, for a base that leans with a slab for the floor."""
        if base.is_upright or not isinstance(self.floor, float):
            return self.obstacles
        return (*self.obstacles, _slab(self.floor, base.position))

    @property
    def floor_height(self) -> float | None:
        """Height of the floor in the task frame, m; None where there is none."""
        if isinstance(self.floor, Floor):
            return float(self.base.position[2]) if self.base.is_upright else None
        return self.floor

    @cached_property
    def floor_in_base(self) -> float | None:
        """Height of the floor in the base frame, m; None where there is none or the base leans."""
        lowest = self.lowest_from(self.base)
        return None if lowest == -math.inf else lowest

    @property
    def solids_in_task(self) -> tuple[Solid, ...]:
        """What the arm keeps clear of in the task frame, a floor of a given height with it."""
        floor = [_slab(self.floor, self.base.position)] if isinstance(self.floor, float) else []
        return tuple(obstacle.solid for obstacle in (*self.obstacles, *floor))

    @cached_property
    def solids(self) -> tuple[Solid, ...]:
        """What the arm keeps clear of in the base frame."""
        return self.solids_from(self.base)


def _slab(height: float, position: FloatArray) -> Obstacle:
    """Return a block that stands for a floor about a position."""
    middle = np.array([position[0], position[1], height - 0.5 * _SLAB])
    return Obstacle("the floor", Box(middle, np.full(3, _SLAB)))
