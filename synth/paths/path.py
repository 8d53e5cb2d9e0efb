"""A path that shall be followed: a curve through waypoints, straight between them or smooth."""

from __future__ import annotations

import math
from enum import Enum
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from synth.arrays import FloatArray, Given, GivenArray, frozen, frozen_value, given
from synth.checks import SMALLEST, Checks

if TYPE_CHECKING:
    from numpy.typing import NDArray

SAMPLES = 120  # points that stand for a path in a search, at least
_APART = 1e-9  # m: waypoints that are nearer are one and the same
_GAUSS = np.polynomial.legendre.leggauss(5)


class Interpolation(Enum):
    """What is between the waypoints of a path."""

    STRAIGHT = "straight"
    SPLINE = "spline"


@frozen_value
class Path:
    """A path that the end effector shall follow from its first waypoint to its last.

    It is a curve p(u) of cubic pieces between waypoints, u the length of the chords so far, m. A spline is
    the natural one; of a closed path, the periodic one.

    Attributes:
        name: How the result speaks of it.
        waypoints: Points that it passes, in the task frame, shape (n, 3), m. The first of a closed path may
            stand at its end again.
        closed: Whether it goes back to its first waypoint, where the joints then are as at the start.
        interpolation: Whether it is straight between waypoints, or a spline through them.
        tolerance: Largest distance of P5 from where it should be that counts as followed, m.
        speed: Speed of P5 along it, m/s; None if that is all one.
    """

    name: str
    waypoints: GivenArray
    closed: bool = False
    interpolation: Given[Interpolation | str, Interpolation] = given(default=Interpolation.STRAIGHT)
    tolerance: float = 1e-3
    speed: float | None = None

    def __post_init__(self) -> None:
        checks = Checks(self)
        checks.name("name")
        checks.is_a("closed", bool)
        checks.word("interpolation", Interpolation)
        checks.number("tolerance", least=SMALLEST)
        if self.speed is not None:
            checks.number("speed", least=SMALLEST)
        if checks.array("waypoints", (None, 3)):
            points = self.waypoints
            if self.closed is True and len(points) > 1 and np.linalg.norm(points[-1] - points[0]) < _APART:
                points = frozen(points[:-1])
                checks.put("waypoints", points)
            least = 3 if self.closed is True else 2
            if len(points) < least:
                checks.report("waypoints", f"must be {least} at least, but there are {len(points)}")
            for index in np.flatnonzero(np.linalg.norm(np.diff(points, axis=0), axis=1) < _APART)[:10]:
                checks.report(f"waypoints[{index + 1}]", f"is where waypoints[{index}] is")
        checks.refuse()

    @cached_property
    def ends(self) -> FloatArray:
        """The parameters u of the waypoints, of a closed path that of its end, too, shape (k,), m."""
        return frozen(np.append(0.0, np.cumsum(np.linalg.norm(np.diff(self._passed, axis=0), axis=1))))

    @cached_property
    def _passed(self) -> FloatArray:
        """The waypoints in their order, the first of a closed path at its end again, shape (k, 3), m."""
        return np.vstack([self.waypoints, self.waypoints[:1]]) if self.closed else self.waypoints

    @cached_property
    def _curve(self) -> Any:
        """The cubic pieces, as scipy has them."""
        from scipy.interpolate import CubicSpline, PPoly  # type: ignore[import-untyped]  # noqa: PLC0415

        if self.interpolation is Interpolation.SPLINE:
            return CubicSpline(self.ends, self._passed, bc_type="periodic" if self.closed else "natural")
        slopes = np.diff(self._passed, axis=0) / np.diff(self.ends)[:, None]
        return PPoly(np.stack([slopes, self._passed[:-1]]), self.ends)

    def parameters(self, count: int) -> FloatArray:
        """Return parameters of about so many points, evenly along its pieces, the waypoints among them."""
        lengths = np.diff(self.ends)
        parts = np.ceil(lengths / lengths.sum() * count - 1e-9).astype(int)
        return np.append(
            np.concatenate(
                [
                    np.linspace(start, end, part, endpoint=False)
                    for start, end, part in zip(self.ends, self.ends[1:], parts, strict=False)
                ]
            ),
            self.ends[-1],
        )

    def at(self, u: FloatArray) -> FloatArray:
        """Return the points at parameters, shape (n,), m; of shape (n, 3), m."""
        return np.asarray(self._curve(u))

    def second_derivatives(self, u: FloatArray) -> FloatArray:
        """Return the second derivatives by u at both ends of the intervals between parameters.

        Within an interval they lie between these two, as each lies within one cubic piece.

        Args:
            u: Rising parameters, the waypoints' among them, shape (n + 1,), m.

        Returns:
            Second derivatives, 1/m, shape (n, 2, 3).
        """
        piece = np.clip(
            np.searchsorted(self.ends, 0.5 * (u[:-1] + u[1:]), side="right") - 1, 0, len(self.ends) - 2
        )
        coefficients = self._curve.c
        if len(coefficients) < 4:
            return np.zeros((len(u) - 1, 2, 3))
        since = np.stack([u[:-1], u[1:]], axis=-1) - self.ends[piece, None]
        second = 6.0 * coefficients[0][piece, None] * since[..., None] + 2.0 * coefficients[1][piece, None]
        return np.asarray(second)

    def lengths(self, u: FloatArray) -> FloatArray:
        """Return how long it is from the first parameter to each of some, the waypoints' among them, m."""
        nodes, weights = _GAUSS
        half = 0.5 * np.diff(u)
        inside = 0.5 * (u[:-1] + u[1:])[:, None] + half[:, None] * nodes
        rates = np.linalg.norm(self._curve.derivative()(inside), axis=-1)
        return np.append(0.0, np.cumsum(half * (rates @ weights)))

    @cached_property
    def length(self) -> float:
        """How long it is, m."""
        return float(self.lengths(self.parameters(SAMPLES))[-1])

    @cached_property
    def samples(self) -> FloatArray:
        """Points that stand for it in a search, the waypoints among them, shape (n, 3), m."""
        points = self.at(self.parameters(SAMPLES))
        return frozen(points[:-1] if self.closed else points)

    @cached_property
    def shares(self) -> NDArray[np.float64]:
        """What each sample stands for: half of the way to its neighbours, in the mean 1, shape (n,)."""
        steps = np.diff(self.lengths(self.parameters(SAMPLES)))
        share = 0.5 * (np.append(steps, 0.0) + np.append(0.0, steps))
        if self.closed:
            share = np.append(share[0] + share[-1], share[1:-1])
        return np.asarray(share / math.fsum(share) * len(share))
