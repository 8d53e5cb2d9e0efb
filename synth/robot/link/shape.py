"""The malleable link in one shape: a chain of torsion-free arcs of constant curvature."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, GivenArray, frozen_value
from synth.checks import Checks
from synth.rounding import rounded_down

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import ArrayLike

_STRAIGHT = 100.0  # m, a bend radius that no eye and no hand can tell from none


def arc_motion(curvatures: ArrayLike, lengths: ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Return how an arc moves the frame that runs along it, seen from the arc's start.

    The frame has z along the link and turns by the rotation vector l (-ky, kx, 0): no torsion, and
    kx > 0 bends the link towards +x. Exact for a straight arc too, because sin(k l)/k and
    (1 - cos(k l))/k^2 are written with sinc.

    Args:
        curvatures: Curvature (kx, ky), shape (..., 2), 1/m.
        lengths: Length l of the arc, shape (...), m.

    Returns:
        The rotation matrix, shape (..., 3, 3), and the displacement, shape (..., 3), m.
    """
    k = np.asarray(curvatures, dtype=np.float64)
    length = np.asarray(lengths, dtype=np.float64)
    kx, ky = k[..., 0], k[..., 1]
    turn = np.hypot(kx, ky) * length
    sine = length * np.sinc(turn / np.pi)  # sin(k l) / k
    versine = 0.5 * (length * np.sinc(0.5 * turn / np.pi)) ** 2  # (1 - cos(k l)) / k^2
    rotation = np.empty((*turn.shape, 3, 3))
    rotation[..., 0, 0] = 1.0 - kx**2 * versine
    rotation[..., 1, 1] = 1.0 - ky**2 * versine
    rotation[..., 2, 2] = np.cos(turn)
    rotation[..., 0, 1] = rotation[..., 1, 0] = -kx * ky * versine
    rotation[..., 0, 2] = kx * sine
    rotation[..., 1, 2] = ky * sine
    rotation[..., 2, 0] = -kx * sine
    rotation[..., 2, 1] = -ky * sine
    displacement = np.stack([kx * versine, ky * versine, sine], axis=-1)
    return rotation, displacement


def chain_end(curvatures: ArrayLike, lengths: ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Return the end frame of many chains of arcs at once, seen from their start.

    Args:
        curvatures: Curvatures of the m arcs of each chain, shape (..., m, 2), 1/m.
        lengths: Lengths of the arcs, shape (..., m), m.

    Returns:
        The rotation matrix, shape (..., 3, 3), and the end's position, shape (..., 3), m.
    """
    *_, (rotation, position) = _along(curvatures, lengths)
    return rotation, position


def chain_points(curvatures: ArrayLike, lengths: ArrayLike) -> FloatArray:
    """Return the ends of all arcs of many chains, seen from their start, shape (..., m, 3), m.

    Args:
        curvatures: Curvatures of the m arcs of each chain, shape (..., m, 2), 1/m.
        lengths: Lengths of the arcs, shape (..., m), m.
    """
    return np.stack([position for _, position in _along(curvatures, lengths)], axis=-2)


def _along(curvatures: ArrayLike, lengths: ArrayLike) -> Iterator[tuple[FloatArray, FloatArray]]:
    """Yield rotation (..., 3, 3) and position (..., 3) after each arc of many chains."""
    rotations, displacements = arc_motion(curvatures, lengths)
    rotation, position = rotations[..., 0, :, :], displacements[..., 0, :]
    yield rotation, position
    for arc in range(1, rotations.shape[-3]):
        position = position + np.einsum("...ij,...j->...i", rotation, displacements[..., arc, :])
        rotation = rotation @ rotations[..., arc, :, :]
        yield rotation, position


@frozen_value
class LinkShape:
    """One shape of the malleable link; it starts at P2 along +z of the base frame.

    Attributes:
        curvatures: Curvature (kx, ky) of each arc in its own frame, shape (m, 2), 1/m.
        lengths: Length of each arc, shape (m,), m.
    """

    curvatures: GivenArray
    lengths: GivenArray

    def __post_init__(self) -> None:
        checks = Checks(self)
        is_bent = checks.array("curvatures", (None, 2))
        if checks.array("lengths", (None,), least=0.0) and is_bent:
            if len(self.lengths) != len(self.curvatures):
                missing = (
                    f"must be one for each of the {len(self.curvatures)} arcs, but are {len(self.lengths)}"
                )
                checks.report("lengths", missing)
            elif not self.lengths.any():
                checks.report("lengths", "must be greater than 0 together")
        checks.refuse()

    @property
    def length(self) -> float:
        """Length L of the centreline, m."""
        return float(self.lengths.sum())

    @property
    def bends(self) -> FloatArray:
        """Curvature of each arc, |k|, shape (m,), 1/m."""
        return np.hypot(self.curvatures[:, 0], self.curvatures[:, 1])

    @property
    def min_bend_radius(self) -> float:
        """Smallest radius along the centreline, m; infinite for a straight link."""
        tightest = float(self.bends.max())
        return 1.0 / tightest if tightest > 0.0 else np.inf

    @property
    def total_bend(self) -> float:
        """Integral of |curvature| along the centreline, rad."""
        return float(self.bends @ self.lengths)

    @property
    def bending_energy(self) -> float:
        """Integral of curvature squared along the centreline, 1/m: small is gentle."""
        return float(self.bends**2 @ self.lengths)

    def end_frame(self) -> tuple[FloatArray, FloatArray]:
        """Return the link's end seen from its start: rotation (3, 3) and position (3,), m."""
        return chain_end(self.curvatures, self.lengths)

    def point_at(self, arc_length: ArrayLike) -> FloatArray:
        """Return points of the centreline, seen from the link's start.

        Args:
            arc_length: Distance from the start along the centreline, shape (...), m.

        Returns:
            The points, shape (..., 3), m. Beyond the ends the centreline is continued by its first
            and its last arc.
        """
        s = np.asarray(arc_length, dtype=np.float64)
        starts, bends, origins, tangents, normals = self._arcs_from_start
        arc = np.maximum(np.searchsorted(starts, s, side="right") - 1, 0)
        # As in `arc_motion`, with half the turn: the chord is 2 sin(k l / 2) / k long.
        within = s - starts[arc]
        half = 0.5 * bends[arc] * within
        chord = within * np.sinc(half / np.pi)
        along, aside = (chord * np.cos(half))[..., None], (0.5 * chord**2)[..., None]
        return np.asarray(origins[arc] + along * tangents[arc] + aside * normals[arc])

    def centreline(self, spacing: float = 0.01) -> FloatArray:
        """Return points along the whole centreline, at most `spacing` m apart, ends included."""
        count = max(2, int(np.ceil(self.length / spacing)) + 1)
        return self.point_at(np.linspace(0.0, self.length, count))

    def lowest(self, beyond: float = 0.0) -> float:
        """Return the height of the lowest point of the centreline over its start, m.

        On an arc z is a sinusoid of the arc length: its extremes are at the ends of the arc or
        where the tangent is horizontal, so the minimum is exact.

        Args:
            beyond: Arc length from which on points count, m.
        """
        rotations, origins = self._arc_frames
        starts = np.concatenate([[0.0], np.cumsum(self.lengths)[:-1]])
        heights = [
            *origins[starts >= beyond, 2],
            *self.point_at([min(beyond, self.length), self.length])[:, 2],
        ]
        for rotation, origin, k, start, length in zip(
            rotations, origins, self.curvatures, starts, self.lengths, strict=True
        ):
            # The tangent's height along the arc: rotation[2] . (k/|k| sin(|k| s), cos(|k| s)).
            bend = float(np.hypot(k[0], k[1]))
            if bend == 0.0:
                continue
            sideways = float(rotation[2, :2] @ k) / bend
            # Downhill turns uphill where sideways sin + up cos = 0 with a growing left-hand side.
            turn = float(np.arctan2(-rotation[2, 2], sideways)) % (2.0 * np.pi)
            if beyond <= start + turn / bend < start + length:
                heights.append(origin[2] + float(rotation[2] @ arc_motion(k, turn / bend)[1]))
        return float(min(heights))

    def describe(self) -> str:
        """Return the numbers of the shape for the user, without a full stop: mm and deg."""
        length = f"link {1e3 * self.length:.1f} mm long"
        if self.min_bend_radius >= _STRAIGHT:
            return f"{length}, as good as straight"
        radius, bend = rounded_down(self.min_bend_radius), math.degrees(self.total_bend)
        return f"{length}, smallest bend radius {radius} mm, {bend:.1f} deg of bend in all"

    @cached_property
    def _arcs_from_start(self) -> tuple[FloatArray, ...]:
        """Return where arcs start, their bends, (m,), and there: origin, tangent and its slope, (m, 3)."""
        rotations, origins = self._arc_frames
        starts = np.concatenate([[0.0], np.cumsum(self.lengths)[:-1]])
        normals = np.einsum("mij,mj->mi", rotations[..., :2], self.curvatures)
        return starts, self.bends, origins, rotations[..., 2], normals

    @cached_property
    def _arc_frames(self) -> tuple[FloatArray, FloatArray]:
        """Return the frame at the start of each arc: rotations (m, 3, 3) and origins (m, 3)."""
        rotations, displacements = arc_motion(self.curvatures, self.lengths)
        starts, origins = [np.eye(3)], [np.zeros(3)]
        for rotation, displacement in zip(rotations[:-1], displacements[:-1], strict=True):
            origins.append(origins[-1] + starts[-1] @ displacement)
            starts.append(starts[-1] @ rotation)
        return np.array(starts), np.array(origins)
