"""Postures of many shapes at many targets: P5 beside each target, joint 1 always at its best.

Only joint 2 is chosen; joint 1 then turns P5 into the half-plane of the target, or up to its limit. So a
posture is described where joint 1 stands at zero, the target turned back, and vectors have their components
along P5's own directions (outward from axis 1, around it, up), on the first axis of the arrays: those are
long, and their components are needed one by one.
"""

from __future__ import annotations

from dataclasses import fields
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen_value
from synth.robot import into_turn

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.robot import Kinematics
    from synth.synthesis.shapes.targets_seen import TargetsSeen

_NEWTON_STEPS = 2
_FARTHEST_STEP = 0.3  # rad
_TINY = 1e-12
# Where a target is nearer to axis 1 than this, m, joint 1 counts as held in derivatives: turning helps
# little there, and the distance from the axis has a kink on it.
_NEAR_AXIS = 0.02


@frozen_value
class Postures:
    """P5 of N shapes beside n targets each.

    Attributes:
        theta2: Angles of joint 2, shape (N, n), rad.
        theta1: Angles of joint 1, shape (N, n), rad.
        beyond: How much farther joint 1 would have to turn than its limits allow, shape (N, n), rad.
        outward: Direction from axis 1 to P5, where joint 1 stands at zero: its x and y, shape (2, N, n).
        point: P5 where joint 1 stands at zero, shape (3, N, n), m.
        miss: P5 - target, outward, around and up, shape (3, N, n), m.
        tangent: dP5/dtheta2, outward, around and up, shape (3, N, n), m.
        astray: How far, at P5's radius, the rigid link points beside the cone asked for, shape (N, n), m: 0
            within it, and where there is none.
        turns: Whether joint 1 follows where P5 moves around axis 1, shape (N, n): not at its limits, and
            not to speak of for a target on the axis.
    """

    theta2: FloatArray
    theta1: FloatArray
    beyond: FloatArray
    outward: FloatArray
    point: FloatArray
    miss: FloatArray
    tangent: FloatArray
    astray: FloatArray
    turns: NDArray[np.bool_]

    @classmethod
    def at(cls, aims: TargetsSeen, kinematics: Kinematics, theta2: FloatArray) -> Postures:
        """Return the postures at angles of joint 2, shape (N, n), rad.

        Args:
            aims: The targets.
            kinematics: The joints of the shapes, of shape (N,).
            theta2: The angles.
        """
        centre = kinematics.centre.T[..., None]
        v, t = kinematics.frame[..., 1].T[..., None], kinematics.frame[..., 2].T[..., None]
        sin, cos = (kinematics.radius[:, None] * of(theta2) for of in (np.sin, np.cos))
        point = centre + sin * v - cos * t
        along = cos * v + sin * t
        radial = np.hypot(point[0], point[1]) + _TINY
        outward = point[:2] / radial
        wanted = into_turn(aims.azimuth - np.arctan2(point[1], point[0]), aims.limits.base.middle)
        theta1 = np.clip(wanted, aims.limits.base.lower, aims.limits.base.upper)
        beyond = wanted - theta1
        x, y = outward
        miss = np.stack(
            [
                radial - aims.radial * np.cos(beyond),
                -aims.radial * np.sin(beyond),
                point[2] - aims.positions[..., 2],
            ]
        )
        tangent = np.stack([x * along[0] + y * along[1], x * along[1] - y * along[0], along[2]])
        turns = (beyond == 0.0) & (aims.radial > _NEAR_AXIS)
        astray = np.zeros_like(theta1)
        if aims.approaches is not None:
            off, allowed = pointing_off(aims.approaches, point - centre, theta1)
            length = np.sqrt(dot(off, off))
            astray = np.where(length > allowed, kinematics.radius[:, None] * (length - allowed), 0.0)
        return cls(theta2, theta1, beyond, outward, point, miss, tangent, astray, turns)

    @classmethod
    def nearest(cls, aims: TargetsSeen, kinematics: Kinematics, *, never_away: bool = False) -> Postures:
        """Return the postures nearest to the targets within the limits of the joints.

        Off the workspace the branches of the inverse kinematics are near its closest points; a few steps
        lead there, and the nearer of both is taken.

        Args:
            aims: The targets.
            kinematics: The joints of the shapes, of shape (N,).
            never_away: As for `led_from`.
        """
        branches = kinematics.each_target().branches(aims.positions)[..., 1]
        theta2 = np.concatenate([branches[..., 0], branches[..., 1]], axis=-1)
        theta2 = into_turn(theta2, aims.limits.second.middle)
        both = cls.led_from(aims.twice, kinematics, theta2, never_away=never_away)
        count = branches.shape[-2]
        one, other = both.at_some(slice(count)), both.at_some(slice(count, None))
        return one.where(one.squared <= other.squared, other)

    @classmethod
    def led_from(
        cls, aims: TargetsSeen, kinematics: Kinematics, theta2: FloatArray, *, never_away: bool = False
    ) -> Postures:
        """Return postures after a few Gauss-Newton steps of joint 2 from angles, joint 1 always at its best.

        Args:
            aims: The targets.
            kinematics: The joints of the shapes, of shape (N,).
            theta2: Angles of joint 2 to start from, shape (N, n), rad.
            never_away: Whether a step that leads away from its target is taken back. On the rim of the
                workspace P5 hardly moves, and a step leads anywhere: that would be untrue where a person is
                told of it, and does no harm in a search, which has been measured without.
        """
        second = aims.limits.second
        here = cls.at(aims, kinematics, np.clip(theta2, second.lower, second.upper))
        best = here
        for _ in range(_NEWTON_STEPS):
            along, speed = here.free_tangent
            step = -dot(along, here.miss) / np.maximum(speed, _TINY)
            theta2 = here.theta2 + np.clip(step, -_FARTHEST_STEP, _FARTHEST_STEP)
            here = cls.at(aims, kinematics, np.clip(theta2, second.lower, second.upper))
            best = here.where(here.squared <= best.squared, best) if never_away else here
        return best

    @cached_property
    def squared(self) -> FloatArray:
        """Squared misses, those of the directions asked for with them, shape (N, n), m^2."""
        return np.asarray(dot(self.miss, self.miss) + self.astray**2)

    @property
    def misses(self) -> FloatArray:
        """Distances of P5 from the targets, shape (N, n), m."""
        return np.asarray(np.sqrt(dot(self.miss, self.miss)))

    @cached_property
    def free_tangent(self) -> tuple[FloatArray, FloatArray]:
        """The direction in which joint 2 moves P5, joint 1 following if it may, and how fast, m / rad."""
        around = np.where(self.turns, 0.0, self.tangent[1])
        tangent = np.stack([self.tangent[0], around, self.tangent[2]])
        speed = np.sqrt(dot(tangent, tangent))
        return tangent / np.maximum(speed, _TINY), speed

    @property
    def joints(self) -> FloatArray:
        """Angles (theta1, theta2), shape (N, n, 2), rad."""
        return np.stack([self.theta1, self.theta2], axis=-1)

    def at_some(self, targets: slice) -> Postures:
        """Return the postures at some of the targets."""
        return Postures(*(getattr(self, f.name)[..., targets] for f in fields(self)))

    def where(self, mine: NDArray[np.bool_], other: Postures) -> Postures:
        """Return these postures where a mask says so and others elsewhere; shape (N, n) or (N, 1)."""
        arrays = ((getattr(self, f.name), getattr(other, f.name)) for f in fields(self))
        return Postures(*(np.where(mine, one, two) for one, two in arrays))


def dot(one: FloatArray, two: FloatArray) -> FloatArray:
    """Return scalar products of vectors with their components on the first axis."""
    return np.asarray(one[0] * two[0] + one[1] * two[1] + one[2] * two[2])


def pointing_off(
    approaches: FloatArray, rigid_link: FloatArray, theta1: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return how the rigid link's direction differs from that asked for, and by how much it may.

    Args:
        approaches: As of `TargetsSeen`.
        rigid_link: From axis 2 to P5 where joint 1 stands at zero, shape (3, N, n), m.
        theta1: Angles of joint 1, shape (N, n), rad.

    Returns:
        The direction less the one asked for, turned back by joint 1, shape (3, N, n), NaN where none is; and
        the length of that which the tolerance allows, shape (n,) or (N, n).
    """
    x, y, z = np.moveaxis(approaches[..., :3], -1, 0)
    cos, sin = np.cos(theta1), np.sin(theta1)
    wanted = np.stack([cos * x + sin * y, cos * y - sin * x, np.broadcast_to(z, theta1.shape)])
    length = np.maximum(np.sqrt(dot(rigid_link, rigid_link)), _TINY)
    return rigid_link / length - wanted, 2.0 * np.sin(0.5 * approaches[..., 3])
