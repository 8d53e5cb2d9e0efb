"""How far an arm keeps clear of obstacles and of itself: along its continuous curve, not at samples.

The arm is a tube about the centreline of the malleable link, with the base's column P1P2 as its first
straight piece, and a rod from the link's end to P5. Every clearance here is a lower bound: along a curve
the distance to anything changes no faster than the arc length, so values at points bound it between them
(`least_values`).

What is in contact by construction is left out. The link's first half diameter sits in its mount. Pieces
of the tube less than pi r apart along it (r the least bend radius) only touch where they are neighbours:
a curve of curvature at most 1/r that is s <= pi r long has a chord of at least 2 r sin(s / 2r) (Schur).
And within a diameter of the second joint link and rod are the joint.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from synth.geometry import least_values
from synth.robot.body import ROUNDING
from synth.robot.hardware import turned

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.geometry import Solid
    from synth.robot.body import ArmBody

MOST_CLEARANCE = 0.1  # m; a clearance beyond is stated as this much
_SELF_CEILING = 0.02  # m, likewise for what the arm keeps from itself


# From where to where along it, and how fast a distance can change along it.
_Side = tuple[float, float, "float | FloatArray"]


def clear_of_obstacles(
    body: ArmBody,
    start: FloatArray,
    solids: Sequence[Solid],
    *,
    end: FloatArray | None = None,
    enough: float = MOST_CLEARANCE,
) -> FloatArray:
    """Return how far tube and rod keep from solids at joint angles, or on straight ways between them.

    On the way a point moves by no more than |d theta1| times its distance from axis 1, plus, on the
    rod, |d theta2| times its distance from axis 2.

    Args:
        body: The arm.
        start: Angles (theta1, theta2), shape (n, 2), rad.
        solids: Solids in the base frame.
        end: Angles at which the ways end, both joints moving evenly, shape (n, 2), rad.
        enough: Clearance, m, beyond which nobody asks how much it is: the less, the faster.

    Returns:
        Lower bounds of the distance between the surfaces, at most `enough`, negative inside; shape
        (n, len(solids), 2), the tube first. On a way that is not clear, minus infinity.
    """
    ways, count = _Ways(start, end), len(solids)
    if count == 0:
        return np.empty((len(start), 0, 2))
    way, solid = np.repeat(np.arange(len(start)), count), np.tile(np.arange(count), len(start))
    link, rod = body.arm.shape.length, body.rod_length
    turn, second = ways.travel.T[:, way]

    def distance(which: NDArray[np.intp], points: FloatArray, joints: FloatArray) -> FloatArray:
        there, values = turned(points, joints[:, 0]), np.empty(len(which))
        for index, each in enumerate(solids):
            mine = solid[which] == index
            values[mine] = each.distance(there[mine])
        return values

    def from_tube(which: NDArray[np.intp], at: FloatArray) -> FloatArray:
        return distance(which, body.tube(at[:, 0]), ways.joints(way[which], at[:, 1]))

    def from_rod(which: NDArray[np.intp], at: FloatArray) -> FloatArray:
        joints = ways.joints(way[which], at[:, 1])
        return distance(which, body.rod(at[:, 0], joints[:, 1]), joints)

    bounds = []
    for values, first, last, radius, rate in (
        (from_tube, min(body.tube_radius, link), link, body.tube_radius, turn * link),
        (from_rod, 0.0, rod, body.rod_radius, turn * (link + rod) + second * rod),
    ):
        sides: list[_Side] = [(first, last, 1.0), (0.0, ways.share, rate)]
        bounds.append(_least(body.tolerance, values, sides, radius, enough, ways.floor))
    return np.stack(bounds, axis=-1).reshape(len(start), count, 2)


def clear_of_tube(
    body: ArmBody, start: FloatArray, end: FloatArray | None = None, *, enough: float = _SELF_CEILING
) -> FloatArray:
    """Return how far the rod keeps from the tube at angles of joint 2, or on ways between them.

    Args:
        body: The arm.
        start: The angles, shape (n,), rad.
        end: Angles at which the ways end, shape (n,), rad.
        enough: As for `clear_of_obstacles`.

    Returns:
        Lower bounds of the distance between the surfaces, at most `enough`, negative where they
        overlap; shape (n,). On a way that is not clear, minus infinity.
    """
    joint = body.arm.robot.link.diameter
    last = body.arm.shape.length - joint
    if joint == 0.0 or last <= 0.0 or body.rod_length <= joint:
        return np.full(len(start), enough)
    ways = _Ways(start[:, None], None if end is None else end[:, None])

    def distance(which: NDArray[np.intp], at: FloatArray) -> FloatArray:
        return body.from_rod(body.tube(at[:, 0]), ways.joints(which, at[:, 1])[:, 0], beyond=joint)

    sides: list[_Side] = [
        (-body.arm.robot.d12, last, 1.0),
        (0.0, ways.share, ways.travel[:, 0] * body.rod_length),
    ]
    return _least(body.tolerance, distance, sides, body.tube_radius + body.rod_radius, enough, ways.floor)


def tube_clear_of_itself(body: ArmBody) -> float:
    """Return how far the tube keeps from itself: a lower bound, at most 0.02 m, negative inside."""
    column, link = body.arm.robot.d12, body.arm.shape.length
    apart = math.pi * body.arm.robot.link.min_bend_radius
    room = column + link - apart
    if room <= 0.0 or body.tube_radius == 0.0:
        return _SELF_CEILING

    def distance(_: NDArray[np.intp], at: FloatArray) -> FloatArray:
        # The second coordinate counts from the nearest piece that is not a neighbour.
        other = np.minimum(at[:, 0] + apart + at[:, 1], link)
        return np.asarray(np.linalg.norm(body.tube(at[:, 0]) - body.tube(other), axis=1))

    sides: list[_Side] = [(-column, room - column, np.full(1, 2.0)), (0.0, room, 1.0)]
    return float(_least(body.tolerance, distance, sides, 2.0 * body.tube_radius, _SELF_CEILING, -math.inf)[0])


def _least(
    tolerance: float,
    distance: Callable[[NDArray[np.intp], FloatArray], FloatArray],
    sides: Sequence[_Side],
    radii: float,
    ceiling: float,
    floor: float,
) -> FloatArray:
    """Return lower bounds of distances less radii, for sides that each go from, to, and at a rate."""
    count = np.broadcast_shapes(*(np.shape(rate) for *_, rate in sides))[0]
    lower, upper, rates = (
        np.stack([np.broadcast_to(side[k], count) for side in sides], axis=-1) for k in range(3)
    )
    least, _ = least_values(distance, lower, upper, rates, tolerance, radii + ceiling, radii + floor)
    return least - radii


class _Ways:
    """Straight ways of the joints, shape (n, k), or standing still where there is no end."""

    def __init__(self, start: FloatArray, end: FloatArray | None) -> None:
        self._start, self._change = start, np.zeros_like(start) if end is None else end - start
        self.travel = np.abs(self._change)
        self.share = 0.0 if end is None else 1.0  # of the way that there is
        self.floor = -math.inf if end is None else -ROUNDING  # how deep in something need not be known

    def joints(self, way: NDArray[np.intp], share: FloatArray) -> FloatArray:
        """Return the angles at a share of ways, both of shape (K,); shape (K, k), rad."""
        return np.asarray(self._start[way] + share[:, None] * self._change[way])
