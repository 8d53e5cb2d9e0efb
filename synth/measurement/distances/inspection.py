"""What measured distances say about the shape of a robot, and what they leave open."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen, frozen_value
from synth.geometry import CategoryDistances, Invariants, SweptCircle
from synth.measurement.distances.link_fit import PAIRS, LinkFit, fit_link
from synth.measurement.distances.misprint import Misprint, find_misprint
from synth.measurement.distances.nearest import Nearest, nearest_realisable
from synth.measurement.distances.sampling import Samples, Spread, sample_shapes

if TYPE_CHECKING:
    from synth.measurement.distances.measured import MeasuredDistances, Measurement

SAMPLES = 4000


@frozen_value
class Inspection:
    """A measured shape, looked at.

    Attributes:
        measurement: What was measured, as it was given.
        misprint: What is wrong with the numbers themselves, or None.
        believed: The distances that all else is about: those given but, where one was found to be misprinted
            and another reading of it fits, with that reading.
        axes: The points P1, ..., P4 nearest to the believed distances.
        whole: The same with P5 where a pose of the end effector was measured; else `axes`.
        samples: Shapes drawn from all that the measurement allows; None if none was realisable.
        spreads: What their numbers are, named as `Samples.spreads` says; empty without samples.
        link: Whether the malleable link can take the pose.
        seed: Seed of the samples and of the search for the link's shape.
    """

    measurement: Measurement
    misprint: Misprint | None
    believed: MeasuredDistances
    axes: Nearest
    whole: Nearest
    samples: Samples | None
    spreads: dict[str, Spread]
    link: LinkFit
    seed: int

    @property
    def is_realisable(self) -> bool:
        """Whether points in space have the distances as given, within their bounds."""
        return self.misprint is None and self.whole.is_realisable

    @cached_property
    def circle(self) -> SweptCircle:
        """Axis 2 and the circle of P5 in the nearest shape: of `whole` if that fits, else of `axes`."""
        return self._circle(self.whole if self.whole.is_realisable else self.axes)

    @cached_property
    def invariants(self) -> Invariants:
        """The five numbers of the nearest shape."""
        return Invariants.from_circle(self.circle)

    @cached_property
    def category_distances(self) -> CategoryDistances:
        """How far the nearest shape is from each special category."""
        return CategoryDistances.from_invariants(self.invariants, self.measurement.robot.d12)

    @cached_property
    def pose(self) -> FloatArray | None:
        """The end effector as (rho, z) about axis 1, shape (2,), m; None if none was measured or can be."""
        if not self.measurement.has_pose:
            return None
        d12, d15, d25 = (self.believed[name] for name in ("d12", "d15", "d25"))
        z = (d15**2 - d25**2 + d12**2) / (2.0 * d12)
        return frozen([np.sqrt(d15**2 - z**2), z]) if abs(z) <= d15 else None

    @cached_property
    def misfit(self) -> float | None:
        """Distance of the recorded end effector, as printed, from the workspace of `axes`, m."""
        if self.pose is None:
            return None
        rho, z = self.pose
        return float(self._circle(self.axes).distance([rho, 0.0, z]))

    def _circle(self, nearest: Nearest) -> SweptCircle:
        p3, p4 = nearest.points[2:4]
        axis = (p4 - p3) / np.linalg.norm(p4 - p3)
        robot = self.measurement.robot
        offset, radius = robot.end_effector_circle(self.believed["d35"], self.believed["d45"])
        return SweptCircle(p3 + (offset + robot.tip_offset) * axis, axis, float(radius))


def inspect(measurement: Measurement, *, seed: int = 0, samples: int = SAMPLES) -> Inspection:
    """Look at a measured shape: can it be, what may it be, does the link take it?

    Args:
        measurement: What was measured.
        seed: Seed of the samples and of the search for the link's shape.
        samples: How many shapes to draw from what the measurement allows.

    Raises:
        SolverError: If the convex solver gives no answer.
    """
    rng = np.random.default_rng(seed)
    distances = measurement.distances
    misprint = find_misprint(distances)
    believed = distances
    if misprint is not None and misprint.named is not None and misprint.named.reading is not None:
        named = misprint.named
        believed = distances.replaced(named.name, misprint.named.reading, named.reading_bound)
    axes = nearest_realisable(believed.among(4))
    whole = nearest_realisable(believed) if measurement.has_pose else axes
    nearest = whole if whole.is_realisable else axes
    aim = nearest.distances[[nearest.measured.names.index(name) for name in PAIRS]]
    drawn = sample_shapes(replace(measurement, distances=believed), samples, rng)
    return Inspection(
        measurement=measurement,
        misprint=misprint,
        believed=believed,
        axes=axes,
        whole=whole,
        samples=drawn,
        spreads={} if drawn is None else drawn.spreads(),
        link=fit_link(measurement.robot, believed, rng, aim),
        seed=seed,
    )
