r"""Proofs that no link takes an end pose: short, certain, and not complete.

A pose is the link's end p seen from P2 and the direction u of axis 2. The end's tangent t is across u, which
leaves one angle beta open; a pose is impossible if every t is. In units of the bend radius, let L be the
length, B the largest total bend and W = min(B, L). For one t, three things are necessary:

1. angle(z, t) <= W: a curve that turns from z to t turns at least by the angle between them.
2. Run backwards, the link starts at p along -t and ends at P2: -p is in the reach (`LinkReach`) about -t.
3. For every unit vector n, with a and b the angles of n to z and to t,

       p . n <= sin a + sin b - 2 sin x + (L - (a + b - 2 x)) cos x,   x = max(0, (a + b - W) / 2).

   The tangent at s along the link is turned from z by at most s, from t by at most L - s, and by at most W
   from both together: its angle to n is at least max(a - s, b - (L - s), x), which is never more than pi. The
   right-hand side is the integral of the cosine of that, as a + b - 2 x <= W <= L and, by 1, x <= a and
   x <= b. Its derivative by L is cos x, both for W = L and for W = B, and that does not fall with L: it is
   convex, and the ends of the interval of lengths decide. Where p . n exceeds it, the end is short of p by at
   least the excess. Without n this is a lower bound on the length of the shortest curve of bounded curvature
   between two directed points, whose exact form is Sussmann's (Proc. 34th IEEE CDC, 1995).

Each is Lipschitz in beta: the angle by 1, the backward position by |p|, and the integral by
2 + max(0, L - B) / 2, because its derivative by b is cos b - cos x - (L - W) sin(x) / 2; by 1 more where the
turn decides how short the link can be. So finitely many beta prove it for all.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import frozen_value
from synth.robot.hardware import Interval
from synth.robot.link.reach import LinkReach
from synth.rounding import Unit, at_least, told_apart

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike

    from synth.arrays import FloatArray
    from synth.robot.hardware import MalleableLink

_ROUNDING = 1e-7  # m and rad; a smaller excess proves nothing
_INTERVALS = 32  # of the angle about axis 2, to begin with
_HALVINGS = 16
_DIRECTIONS = 600  # n, evenly on the sphere, the best of which is then improved
_RINGS = (0.08, 0.03, 0.01, 0.003, 0.001)  # steps of that improvement, rad
_AROUND = 24
_BISECTIONS = 8
_LONGEST = 3.0  # times as long: how far it is looked for a link that is long enough


def why_no_link(link: MalleableLink, position: ArrayLike, axis: ArrayLike) -> str:
    """Return the reason for which no shape of the link has an end pose; empty if none is known.

    It holds also for the pose turned about the base axis, and for the axis reversed. That there is none does
    not mean that a shape has the pose: `links_to_poses` looks for one.

    Args:
        link: The link and its limits.
        position: The end p of the link seen from P2, shape (3,), m.
        axis: Direction u of axis 2, shape (3,); its length does not count.

    Returns:
        A sentence with lengths in mm and angles in deg.
    """
    p, u = np.asarray(position, dtype=np.float64), np.asarray(axis, dtype=np.float64)
    u = u / np.linalg.norm(u)
    short = -float(LinkReach(link).margin(p))
    if short > _ROUNDING:
        return f"{_the_link(link)} ends {at_least(short)} away, whatever its direction there"
    # The nearest tangent across u is as far from z as u is from the horizontal plane.
    least, most = math.asin(min(abs(u[2]), 1.0)), _largest_turn(link)
    if least > most + _ROUNDING:
        return _too_little("turn", least, most, Unit.DEG)
    short = _Tangents(link, p, u).shortfall(share=0.8)
    if short <= _ROUNDING:
        return ""

    def bending(bend: float) -> MalleableLink:
        return replace(link, max_total_bend=bend)

    def as_long_as(length: float) -> MalleableLink:
        return replace(link, length=Interval(link.length.lower, length))

    bend, unlimited = link.max_total_bend, link.length.upper / link.min_bend_radius
    if bend < unlimited:
        needed = _needed(bending, bend, unlimited, p, u)
        if needed is not None:
            return _too_little("turn", needed, bend, Unit.DEG)
    longest = link.length.upper
    needed = _needed(as_long_as, longest, _LONGEST * longest, p, u)
    if needed is not None:
        return _too_little("be", needed, longest, Unit.MM, " long")
    return f"{_the_link(link)} ends {at_least(short)} away with axis 2 in this direction"


@frozen_value
class _Tangents:
    """The circle of tangents across axis 2, covered by intervals of the angle beta."""

    link: MalleableLink
    p: FloatArray
    u: FloatArray

    @cached_property
    def reach(self) -> LinkReach:
        """Where the link's end can be, its direction free."""
        return LinkReach(self.link)

    def shortfall(self, share: float = 0.0) -> float:
        """Return the least by which every link surely misses the position, m; 0 if that is not proven.

        Infinite where no link has the direction.

        Args:
            share: What is certain is worked up to this share of what is met at the middles of intervals.
        """
        beta = np.asarray((np.arange(_INTERVALS) + 0.5) * (2.0 * np.pi / _INTERVALS))
        half, certain, least = np.pi / _INTERVALS, np.inf, np.inf
        for _ in range(_HALVINGS):
            excess, rate = self.excesses(beta)
            if np.any(excess.max(axis=0) <= _ROUNDING):
                return 0.0  # this tangent passes every test
            sure = excess - rate[:, None] * half
            sure[0] = np.where(sure[0] > _ROUNDING, np.inf, -np.inf)
            surest = sure.max(axis=0)
            least = min(least, float(excess[1:].max(axis=0).min()))
            open_ = surest <= max(share * least, _ROUNDING)
            certain = min(certain, float(surest[~open_].min(initial=np.inf)))
            if not open_.any():
                return certain
            remaining = float(surest[open_].min())
            half *= 0.5
            beta = np.concatenate([beta[open_] - half, beta[open_] + half])
        return max(min(certain, remaining), 0.0)

    def excesses(self, beta: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return how far each condition is exceeded, (3, n), m, and how fast that may fall, (3,), m/rad.

        The first, an angle, is told in bend radii; the second is 0 where the condition holds.
        """
        across = np.linalg.svd(self.u[None])[2][1:]
        t = np.cos(beta)[:, None] * across[0] + np.sin(beta)[:, None] * across[1]
        radius, longest = self.link.min_bend_radius, self.link.length.upper
        turn = _angle(t[:, 2])
        along = t @ self.p
        aside = np.sqrt(np.maximum(self.p @ self.p - along**2, 0.0))
        start, backward = np.column_stack([aside, np.zeros_like(aside), along]), np.zeros_like(along)
        outside = ~self.reach.contains(start)
        backward[outside] = -self.reach.margin(start[outside])
        spare = max(max(longest, np.pi * radius) - radius * self.link.max_total_bend, 0.0)
        rates = np.array([radius, float(np.linalg.norm(self.p)), 3.0 * radius + 0.5 * spare])
        return np.stack([radius * (turn - _largest_turn(self.link)), backward, self.beyond(t, turn)]), rates

    def beyond(self, t: FloatArray, turn: FloatArray) -> FloatArray:
        """Return the largest excess over condition 3 for tangents, shape (n, 3), among the n tried; m."""
        n = np.broadcast_to(_spread(_DIRECTIONS), (len(t), _DIRECTIONS, 3))
        for ring in (*_RINGS, 0.0):
            excess = self.over(n, t, turn)
            best = np.argmax(excess, axis=1)[:, None]
            chosen = np.take_along_axis(n, best[..., None], axis=1)
            n = np.concatenate([chosen, chosen + ring * _spread(_AROUND)], axis=1)
            n = n / np.linalg.norm(n, axis=-1, keepdims=True)
        return np.asarray(np.take_along_axis(excess, best, axis=1)[:, 0])

    def over(self, n: FloatArray, t: FloatArray, turn: FloatArray) -> FloatArray:
        """Return p . n less its bound, shape (tangents, directions), m."""
        radius = self.link.min_bend_radius
        a, b = _angle(n[..., 2]), _angle(np.einsum("nki,ni->nk", n, t))
        bound = np.full(b.shape, -np.inf)
        for end in (self.link.length.lower, self.link.length.upper):
            length = np.maximum(end / radius, turn)[:, None]  # shorter links do not turn that far
            x = np.maximum(0.5 * (a + b - np.minimum(self.link.max_total_bend, length)), 0.0)
            cosine = np.cos(x)
            integral = np.sin(a) + np.sin(b) - 2.0 * np.sin(x) + (length - (a + b - 2.0 * x)) * cosine
            bound = np.maximum(bound, integral)
        return np.asarray(n @ self.p - radius * bound)


def _needed(
    changed: Callable[[float], MalleableLink], limit: float, beyond: float, p: FloatArray, u: FloatArray
) -> float | None:
    """Return the largest value of a limit with which a pose is proven impossible; None if it always is."""

    def proven(value: float) -> bool:
        return _Tangents(changed(value), p, u).shortfall() > _ROUNDING

    if proven(beyond):
        return None
    for _ in range(_BISECTIONS):
        middle = 0.5 * (limit + beyond)
        limit, beyond = (middle, beyond) if proven(middle) else (limit, middle)
    return limit


def _largest_turn(link: MalleableLink) -> float:
    return min(link.max_total_bend, link.length.upper / link.min_bend_radius)


def _angle(cosine: FloatArray) -> FloatArray:
    return np.asarray(np.arccos(np.clip(cosine, -1.0, 1.0)))


def _spread(count: int) -> FloatArray:
    """Return unit vectors spread evenly, shape (count, 3): a Fibonacci spiral."""
    index = np.arange(count) + 0.5
    z, turn = 1.0 - 2.0 * index / count, np.pi * (1.0 + math.sqrt(5.0)) * index
    rho = np.sqrt(1.0 - z**2)
    return np.column_stack([rho * np.cos(turn), rho * np.sin(turn), z])


def _too_little(verb: str, needed: float, limit: float, unit: Unit, what: str = "") -> str:
    """Return the amount by which a limit is too little, with as many digits as tell the two numbers apart."""
    more, most = told_apart(needed, limit, unit)
    symbol = unit.symbol
    return f"the link would have to {verb} more than {more} {symbol}{what}; {most} {symbol} is its limit"


def _the_link(link: MalleableLink) -> str:
    length, lower = link.length, f"{1e3 * link.length.lower:.1f}"
    lengths = lower if length.is_fixed else f"{lower} to {1e3 * length.upper:.1f}"
    return f"a link of {lengths} mm, bent to no less than {1e3 * link.min_bend_radius:.1f} mm,"
