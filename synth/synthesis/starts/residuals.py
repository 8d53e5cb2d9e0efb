"""What of the misses no joint can take up, and how it changes with the shape: for many shapes at once."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from synth.synthesis.shapes import dot, pointing_off

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.synthesis.shapes import Postures, Shapes, TargetsSeen

_FARTHEST_STEP = 0.5  # of joint 2, rad
_AT_LIMIT = 1e-9  # rad
_TINY = 1e-12
_SLOWEST = 1e-6  # m / rad, of P5 by joint 2

# Of shapes and targets.
_Pairs = tuple["NDArray[np.intp]", "NDArray[np.intp]"]


class Residuals:
    """What is left of the misses across the directions in which the joints are free, and its derivatives.

    Directions have their components outward, around and up, on the first axis. One, the normal of the
    half-plane's curve, is always left; where a joint is held by its limit another one is.

    Args:
        shapes: N shapes.
        postures: Their postures at n targets.
        aims: The targets as the shapes see them.
    """

    def __init__(self, shapes: Shapes, postures: Postures, aims: TargetsSeen) -> None:
        self._postures, self._kinematics, self._approaches = postures, shapes.kinematics, aims.approaches
        limits = aims.limits.second
        self._base_is_free = shapes.places is not None
        frame, position = shapes.end
        self._lever = postures.point - position.T[..., None]
        self._circle = None
        if not shapes.robot.rigid_link.is_fixed:
            kinematics = shapes.kinematics
            from_centre = postures.point - kinematics.centre.T[..., None]
            from_centre = from_centre / np.maximum(kinematics.radius, _TINY)[:, None]
            self._circle = np.broadcast_to(frame[..., 0].T[..., None], from_centre.shape), from_centre
        self._along, self._speed = postures.free_tangent
        uphill = dot(self._along, postures.miss)
        self._free = np.where(
            ((postures.theta2 <= limits.lower + _AT_LIMIT) & (uphill > 0.0))
            | ((postures.theta2 >= limits.upper - _AT_LIMIT) & (uphill < 0.0)),
            0.0,
            1.0,
        )

    def following(self, moved: FloatArray) -> FloatArray:
        """Return how far joint 2 follows the link's ends, to first order, shape (N, n), rad.

        Args:
            moved: How the ends, circles and bases move, as the rows of `Shapes.motion`, shape (N, k).
        """
        slopes = self._slopes(self._along)
        along = dot(self._along, self._postures.miss) + np.einsum("nti,ni->nt", slopes, moved)
        step = -along / np.maximum(self._speed, _SLOWEST) * self._free
        return np.asarray(np.clip(step, -_FARTHEST_STEP, _FARTHEST_STEP))

    def normal_equations(self, weights: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return J^T W J, shape (N, k, k), and J^T W r, shape (N, k), by the rows of `Shapes.motion`.

        Args:
            weights: Of the squared misses, shape (N, n).
        """
        root = np.sqrt(weights)
        outward, _, up = self._postures.tangent
        steep = np.hypot(outward, up) + _TINY
        normal = np.stack([-up / steep, np.zeros_like(up), outward / steep])
        slopes = self._slopes(normal) * root[..., None]
        residual = dot(normal, self._postures.miss) * root
        by_motion = slopes.transpose(0, 2, 1)
        curvature, slope = by_motion @ slopes, (by_motion @ residual[..., None])[..., 0]
        for direction, (owner, target) in self._held_directions(normal, steep):
            first = np.flatnonzero(np.diff(owner, prepend=-1))  # they come in order
            owners = owner[first]
            some = self._slopes(direction, (owner, target)) * root[owner, target, None]
            left = dot(direction, self._postures.miss[:, owner, target]) * root[owner, target]
            curvature[owners] += np.add.reduceat(some[:, :, None] * some[:, None, :], first)
            slope[owners] += np.add.reduceat(some * left[:, None], first)
        if self._approaches is not None and self._postures.astray.any():
            rows = self._direction_slopes(self._approaches) * root[..., None]
            curvature += rows.transpose(0, 2, 1) @ rows
            slope += np.einsum("nti,nt->ni", rows, self._postures.astray * root)
        return curvature, slope

    def _direction_slopes(self, approaches: FloatArray) -> FloatArray:
        """Return how the rigid link's direction leaves the cone asked for, by the rows of `Shapes.motion`.

        The joints follow P5, as far as they are free. Shape (N, n, k), m; 0 within the cone.
        """
        postures, kinematics = self._postures, self._kinematics
        rigid_link = postures.point - kinematics.centre.T[..., None]
        off, _ = pointing_off(approaches, rigid_link, postures.theta1)
        out = np.where(postures.astray > 0.0, off, 0.0)
        out = out / np.maximum(np.sqrt(dot(out, out)), _TINY)
        pointing = rigid_link / np.maximum(kinematics.radius, _TINY)[:, None]
        wanted = np.where(postures.astray > 0.0, pointing - off, 0.0)
        by_motion = np.zeros((*postures.theta2.shape, self._slopes(self._along).shape[-1]))
        by_motion[..., 3:6] = np.moveaxis(np.cross(pointing, out, axis=0), 0, -1)
        if self._base_is_free:
            x, y, z = np.cross(wanted, out, axis=0)
            c, s = np.cos(postures.theta1), np.sin(postures.theta1)
            by_motion[..., -3:] = np.stack([c * x - s * y, s * x + c * y, z], axis=-1)
        second = -self._slopes(self._along) * (self._free / np.maximum(self._speed, _SLOWEST))[..., None]
        zero = np.zeros_like(postures.theta2)
        around = self._slopes(np.stack([zero, zero + 1.0, zero])) + postures.tangent[1][..., None] * second
        radial = np.hypot(postures.point[0], postures.point[1])
        first = -around * (postures.turns / np.maximum(radial, _TINY))[..., None]
        frame, (sin, cos) = kinematics.frame, (np.sin(postures.theta2), np.cos(postures.theta2))
        circling = cos * frame[..., 1].T[..., None] + sin * frame[..., 2].T[..., None]
        by_motion += dot(out, circling)[..., None] * second
        by_motion += (out[1] * wanted[0] - out[0] * wanted[1])[..., None] * first
        return np.asarray(kinematics.radius[:, None, None] * by_motion)

    def _held_directions(self, normal: FloatArray, steep: FloatArray) -> Iterator[tuple[FloatArray, _Pairs]]:
        """Yield directions that held joints leave beside the normal, and for which shapes and targets."""
        turns, bends = self._postures.turns, self._free == 1.0
        outward, _, up = self._postures.tangent
        owner, target = np.nonzero(~bends)  # along the curve in the half-plane
        if len(owner):
            along = np.stack([outward, np.zeros_like(up), up]) / steep
            yield along[:, owner, target], (owner, target)
        owner, target = np.nonzero(~turns & bends)  # across the way on which joint 2 alone leads
        if len(owner):
            across = np.cross(normal[:, owner, target], self._along[:, owner, target], axis=0)
            yield across, (owner, target)
        owner, target = np.nonzero(~turns & ~bends)  # around axis 1
        if len(owner):
            yield np.tile([[0.0], [1.0], [0.0]], len(owner)), (owner, target)

    def _slopes(self, direction: FloatArray, some: _Pairs | None = None) -> FloatArray:
        """Return how P5 moves along directions, by the rows of `Shapes.motion`, shape (..., k)."""

        def of(array: FloatArray) -> FloatArray:
            return array if some is None else array[:, some[0], some[1]]

        cos, sin = of(self._postures.outward)
        x, y = direction[0] * cos - direction[1] * sin, direction[0] * sin + direction[1] * cos
        z = direction[2]
        ax, ay, az = of(self._lever)
        columns = [x, y, z, ay * z - az * y, az * x - ax * z, ax * y - ay * x]
        if self._circle is not None:
            columns += [dot(np.stack([x, y, z]), of(by)) for by in self._circle]
        if self._base_is_free:
            columns += self._by_base(np.stack([x, y, z]), of)
        return np.stack(columns, axis=-1)

    def _by_base(self, direction: FloatArray, of: Callable[[FloatArray], FloatArray]) -> list[FloatArray]:
        """Return how P5 leaves its target along directions as the base shifts and turns, in its own frame."""
        cos, sin = of(self._postures.outward)
        outward, around, up = of(self._postures.miss)
        off = np.stack([outward * cos - around * sin, outward * sin + around * cos, up])
        target = of(self._postures.point) - off
        turned = np.cross(target, direction, axis=0)  # as if joint 1 stood at zero
        (theta1,) = of(self._postures.theta1[None])
        c, s = np.cos(theta1), np.sin(theta1)
        columns = []
        for x, y, z in (direction, turned):
            columns += [c * x - s * y, s * x + c * y, z]
        return columns
