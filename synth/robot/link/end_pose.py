"""The pose of the link's end: its position and the direction of axis 2, whatever else is open."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import frozen_value
from synth.robot.hardware import Interval, into_turn, turned

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from synth.arrays import FloatArray
    from synth.robot.link.arc_chains import ArcChains
    from synth.robot.link.shape import LinkShape

ANYWHERE = Interval(-np.inf, np.inf)  # for theta1


@dataclass(frozen=True)
class PoseMiss:
    """How far a shape's end is from a pose.

    Attributes:
        position: Distance from the position, m.
        axis: Angle to the direction of axis 2, rad.
        theta1: Angle of joint 1 at which this is so, rad.
    """

    position: float
    axis: float
    theta1: float


def pose_miss(
    shape: LinkShape, position: ArrayLike, axis: ArrayLike, *, theta1: Interval = ANYWHERE
) -> PoseMiss:
    """Return how far a shape's end is from a pose, by the shape's own forward kinematics.

    Args:
        shape: The shape.
        position: The position asked for, seen from P2, shape (3,), m.
        axis: The direction of axis 2 asked for, shape (3,).
        theta1: Where joint 1 may stand. It turns the shape by the angle that brings the horizontal parts of
            position (in m) and direction together best, or the end of the interval next to that.
    """
    p, u = np.asarray(position, dtype=np.float64), np.asarray(axis, dtype=np.float64)
    u = u / np.linalg.norm(u)
    frame, end = shape.end_frame()
    # sum |Rz(theta1) a - b|^2 is least where theta1 = atan2(sum a x b, sum a . b), horizontally.
    a, b = np.stack([end, frame[:, 0]])[:, :2], np.stack([p, u])[:, :2]
    cross = np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    turn = float(within(theta1, np.arctan2(cross, np.sum(a * b))))
    reached = turned(np.stack([end, frame[:, 0]]), np.asarray(turn))
    angle = float(np.arctan2(np.linalg.norm(np.cross(reached[1], u)), reached[1] @ u))
    return PoseMiss(float(np.linalg.norm(reached[0] - p)), angle, turn)


@frozen_value
class EndPoses:
    """Poses as aims of chains: positions p in units of the bend radius and directions u, shape (n, 3)."""

    p: FloatArray
    u: FloatArray
    theta1: Interval

    def take(self, rows: NDArray[np.intp]) -> EndPoses:
        """Return some of the poses."""
        return EndPoses(self.p[rows], self.u[rows], self.theta1)

    def repeated(self, count: int) -> EndPoses:
        """Return each pose several times in sequence."""
        return self.take(np.repeat(np.arange(len(self.p)), count))

    def off(self, chains: ArcChains, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return what is left of the poses, shape (n, 5), and its derivative, shape (n, 5, unknowns + 1).

        Of the direction that is the angle to it, as a vector across it.
        """
        ends = chains.ends(x[:, :-1])
        p, u = turned(self.p, -x[:, -1]), turned(self.u, -x[:, -1])
        across = np.linalg.svd(u[:, None])[2][:, 1:]
        reached = ends.frame[..., 0]
        sideways = np.einsum("nij,nj->ni", across, reached)
        angle = np.arctan2(np.linalg.norm(sideways, axis=1), np.sum(reached * u, axis=1))
        scale = 1.0 / np.sinc(np.minimum(angle, 3.0) / np.pi)[:, None]
        # The pose turns by -theta1: seen from it, the end turns by theta1.
        up = np.array([0.0, 0.0, 1.0])
        by_turn = np.cross(up, p)[..., None], np.cross(up, u)[..., None]
        by_unknowns = np.cross(ends.rotation, reached[..., None], axis=1)
        d_position = np.concatenate([ends.d_position, by_turn[0]], axis=-1)
        d_axis = across @ np.concatenate([by_unknowns, by_turn[1]], axis=-1)
        return (
            np.concatenate([ends.position - p, scale * sideways], axis=1),
            np.concatenate([d_position, scale[..., None] * d_axis], axis=1),
        )


def within(theta1: Interval, angle: ArrayLike) -> FloatArray:
    """Return angles, modulo a turn, brought to the nearer end of an interval if they are not in it."""
    if np.isinf(theta1.upper - theta1.lower):
        return np.asarray(angle, dtype=np.float64)
    return np.clip(into_turn(np.asarray(angle), theta1.middle), theta1.lower, theta1.upper)
