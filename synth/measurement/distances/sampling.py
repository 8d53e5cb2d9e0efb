"""What a measurement leaves open: shapes drawn from all that it allows, and the spread of their numbers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen, frozen_value
from synth.geometry import squared_distances

if TYPE_CHECKING:
    from synth.measurement.distances.measured import Measurement

_BATCH = 4000
_MOST_BATCHES = 100  # gives up where less than one set of distances in some thousand is realisable
_AROUND = np.linspace(0.0, 2.0 * np.pi, 361)
_CHUNK = 500  # shapes whose sections are in memory at once
_TINY = 1e-300


@dataclass(frozen=True)
class Spread:
    """The distribution of a number over the sampled shapes, in SI units.

    Attributes:
        least: Least value among the samples; that over all allowed shapes may be a little less.
        low: The 5th percentile.
        median: The median.
        high: The 95th percentile.
        most: Largest value among the samples.
    """

    least: float
    low: float
    median: float
    high: float
    most: float

    @classmethod
    def of(cls, values: FloatArray) -> Spread:
        """Return the spread of values, shape (n,)."""
        return cls(*(float(value) for value in np.percentile(values, [0.0, 5.0, 50.0, 95.0, 100.0])))


@frozen_value
class Samples:
    """Shapes that a measurement allows, in the base frame: P1 the origin, P3 in the half-plane x > 0, y = 0.

    Attributes:
        d12: Distance of P1 and P2, shape (n,), m.
        p3: Shape (n, 3), m.
        p4: Shape (n, 3), m; the mirror image with y >= 0.
        centre_offset: From P3 to the centre of the circle of P5 along axis 2, shape (n,), m.
        radius: Radius of that circle, shape (n,), m.
        pose: Distance from axis 1 and height (rho, z) of the recorded end effector, shape (n, 2), m, or
            None if no pose was measured.
        drawn: How many sets of distances were drawn to find these n realisable ones.
    """

    d12: FloatArray
    p3: FloatArray
    p4: FloatArray
    centre_offset: FloatArray
    radius: FloatArray
    pose: FloatArray | None
    drawn: int

    def __len__(self) -> int:
        return len(self.d12)

    @property
    def axis(self) -> FloatArray:
        """Direction of axis 2, from P3 to P4, shape (n, 3)."""
        span = self.p4 - self.p3
        return np.asarray(span / np.linalg.norm(span, axis=1, keepdims=True))

    def spreads(self) -> dict[str, Spread]:
        """Return the spread of each number: names as in `Invariants` and `CategoryDistances`.

        `alpha` (rad), `a` (m), `spherical` and `puma` (distance of P1 and P2 from axis 2, m), `scara` (angle
        of the axes as lines, rad), and `misfit` (m) if there is a pose: see `misfits`.
        """
        u = self.axis
        sine = np.hypot(u[:, 0], u[:, 1])
        alpha = np.arctan2(sine, u[:, 2])
        # Of parallel axes the moment is 0 too; their distance is that of P3 from axis 1.
        moment = np.abs(self.p3[:, 0] * u[:, 1] - self.p3[:, 1] * u[:, 0])
        parallel = sine < 1e-8
        a = np.where(parallel, np.hypot(self.p3[:, 0], self.p3[:, 1]), moment / np.where(parallel, 1.0, sine))
        p2 = self.d12[:, None] * np.array([0.0, 0.0, 1.0])
        values = {
            "alpha": alpha,
            "a": a,
            "puma": np.linalg.norm(np.cross(self.p3 - p2, u), axis=1),
            "scara": np.minimum(alpha, np.pi - alpha),
            "spherical": np.linalg.norm(np.cross(self.p3, u), axis=1),
        }
        if self.pose is not None:
            values["misfit"] = self.misfits()
        return {name: Spread.of(value) for name, value in values.items()}

    def sections(self) -> FloatArray:
        """Return the workspace of each shape as a closed curve (rho, z), shape (n, k, 2), m."""
        u = self.axis
        across = np.eye(3)[np.argmin(np.abs(u), axis=1)]
        v = np.cross(u, across)
        v /= np.linalg.norm(v, axis=1, keepdims=True)
        w = np.cross(u, v)
        circle = np.cos(_AROUND)[:, None] * v[:, None] + np.sin(_AROUND)[:, None] * w[:, None]
        centre = self.p3 + self.centre_offset[:, None] * u
        points = centre[:, None] + self.radius[:, None, None] * circle
        return np.stack([np.hypot(points[..., 0], points[..., 1]), points[..., 2]], axis=-1)

    def misfits(self) -> FloatArray:
        """Return the distance of the recorded end effector from each shape's workspace, shape (n,), m.

        Joint limits aside, so that it is a lower bound. The curve is taken for a polygon of 360 sides, which
        is right to 0.02 mm for a radius of half a metre.
        """
        assert self.pose is not None, "a pose was measured"  # noqa: S101 - for the type checker
        parts = range(0, len(self), _CHUNK)
        return np.concatenate(
            [
                _distance_to_curve(
                    self.pose[start : start + _CHUNK], self.part(start, start + _CHUNK).sections()
                )
                for start in parts
            ]
        )

    def part(self, start: int, stop: int) -> Samples:
        """Return the shapes from `start` on, before `stop`."""
        part = slice(start, stop)
        pose = None if self.pose is None else self.pose[part]
        p3, p4, radius = self.p3[part], self.p4[part], self.radius[part]
        return Samples(self.d12[part], p3, p4, self.centre_offset[part], radius, pose, self.drawn)


def sample_shapes(measurement: Measurement, count: int, rng: np.random.Generator) -> Samples | None:
    """Draw shapes uniformly from what a measurement allows.

    Rounded distances are uniform within their box, those with a sigma are normal within three; markers
    are drawn as points. Sets of distances that no points in space have are dropped.

    Args:
        measurement: What was measured.
        count: How many shapes.
        rng: Source of randomness.

    Returns:
        At most `count` shapes, fewer if hardly any set is realisable; None if none was.
    """
    found: list[dict[str, FloatArray]] = []
    kept = drawn = 0
    for _ in range(_MOST_BATCHES):
        drawn += _BATCH
        batch = _placed(_draw(measurement, rng), measurement.has_pose)
        found.append(batch)
        kept += len(batch["d12"])
        if kept >= count:
            break
    if kept == 0:
        return None
    merged = {key: np.concatenate([batch[key] for batch in found])[:count] for key in found[0]}
    pose = merged.pop("pose") if measurement.has_pose else None
    return Samples(**{key: frozen(value) for key, value in merged.items()}, pose=pose, drawn=drawn)


def _draw(measurement: Measurement, rng: np.random.Generator) -> dict[str, FloatArray]:
    """Return drawn distances by their names, shape (_BATCH,) each, m."""
    distances, precision = measurement.distances, measurement.precision
    if measurement.markers is not None:
        shape = (_BATCH, *measurement.markers.shape)
        noise = (
            rng.uniform(-precision.bound, precision.bound, shape)
            if precision.is_rounding
            else rng.normal(0.0, precision.sigma, shape)
        )
        s = squared_distances(measurement.markers + noise)
        drawn = {
            f"d{i + 1}{j + 1}": np.sqrt(s[:, i, j])
            for i, j in zip(*np.triu_indices(s.shape[1], k=1), strict=True)
        }
        given = zip(distances.names, distances.values, strict=True)
        return {name: np.full(_BATCH, value) for name, value in given} | drawn
    if precision.is_rounding:
        values = rng.uniform(distances.lower, distances.upper, (_BATCH, len(distances.values)))
    else:
        values = rng.normal(distances.values, distances.sigma, (_BATCH, len(distances.values)))
        inside = (values >= distances.lower) & (values <= distances.upper)
        values = values[inside.all(axis=1)]
    return dict(zip(distances.names, values.T, strict=True))


def _placed(d: dict[str, FloatArray], has_pose: bool) -> dict[str, FloatArray]:
    """Return those sets of distances that points in space have, as points in the base frame."""
    z3 = (d["d13"] ** 2 - d["d23"] ** 2 + d["d12"] ** 2) / (2.0 * d["d12"])
    z4 = (d["d14"] ** 2 - d["d24"] ** 2 + d["d12"] ** 2) / (2.0 * d["d12"])
    rho3, rho4 = d["d13"] ** 2 - z3**2, d["d14"] ** 2 - z4**2  # squared
    inner = 0.5 * (d["d13"] ** 2 + d["d14"] ** 2 - d["d34"] ** 2) - z3 * z4
    x3 = np.sqrt(np.maximum(rho3, 0.0))
    # With P3 on axis 1 any half-plane does, and P4 is put into the same.
    on_axis = x3 < 1e-9
    x4 = np.where(on_axis, np.sqrt(np.maximum(rho4, 0.0)), inner / np.where(on_axis, 1.0, x3))
    y4 = rho4 - x4**2  # squared
    offset = (d["d35"] ** 2 - d["d45"] ** 2 + d["d34"] ** 2) / (2.0 * d["d34"])
    radius = d["d35"] ** 2 - offset**2  # squared
    rounding = -1e-15
    good = (rho3 >= rounding) & (y4 >= rounding) & (radius >= rounding)
    pose = {}
    if has_pose:
        z5 = (d["d15"] ** 2 - d["d25"] ** 2 + d["d12"] ** 2) / (2.0 * d["d12"])
        rho5 = d["d15"] ** 2 - z5**2  # squared
        good &= rho5 >= rounding
        pose = {"pose": np.stack([np.sqrt(np.maximum(rho5, 0.0)), z5], axis=-1)}
    placed = {
        "d12": d["d12"],
        "p3": np.stack([x3, np.zeros_like(x3), z3], axis=-1),
        "p4": np.stack([x4, np.sqrt(np.maximum(y4, 0.0)), z4], axis=-1),
        "centre_offset": offset,
        "radius": np.sqrt(np.maximum(radius, 0.0)),
        **pose,
    }
    return {key: value[good] for key, value in placed.items()}


def _distance_to_curve(points: FloatArray, curves: FloatArray) -> FloatArray:
    """Return the distance of each point, shape (n, 2), from its closed polygon, shape (n, k, 2)."""
    start, side = curves[:, :-1], np.diff(curves, axis=1)
    to_point = points[:, None] - start
    along = np.sum(to_point * side, axis=-1) / np.maximum(np.sum(side**2, axis=-1), _TINY)
    off = to_point - np.clip(along, 0.0, 1.0)[..., None] * side
    return np.asarray(np.sqrt(np.min(np.sum(off**2, axis=-1), axis=1)))
