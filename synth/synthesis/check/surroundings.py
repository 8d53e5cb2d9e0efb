"""What an arm may bump into as its joints move: whether straight ways of the joints are clear."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from synth.robot import ArmBody, clear_of_obstacles, clear_of_tube
from synth.synthesis.check.clearances import seen_by

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.geometry import Solid
    from synth.robot import Arm
    from synth.task import Task

_ANGLE_SLACK = 1e-6  # what rounding may do, rad


class Surroundings:
    """What an arm may bump into as its joints move.

    Args:
        task: The task, for its obstacles and floor.
        arm: The robot in a shape.

    Attributes:
        body: The room that the arm takes up.
        limits: The joint limits.
        solids: The obstacles in the base frame.
        floor: Height that the rod stays above, m. Joint 1 keeps all heights, so the tube stays where it is
            over the floor.
    """

    def __init__(self, task: Task, arm: Arm) -> None:
        self.body = ArmBody(arm)
        self.limits = task.robot.joint_limits
        self.solids: list[Solid] = list(seen_by(task, arm))
        self.floor = task.lowest_from(arm.base)

    def clear(self, start: FloatArray, end: FloatArray) -> NDArray[np.bool_]:
        """Return whether straight ways, shape (n, 2), are certainly clear."""
        clear = self._clear_of_itself(start[:, 1], end[:, 1])
        some = np.flatnonzero(clear)
        if self.solids and len(some):
            least = clear_of_obstacles(self.body, start[some], self.solids, end=end[some], enough=0.0)
            clear[some] = least.min(axis=(1, 2)) >= self.body.clear
        return clear

    def _clear_of_itself(self, start: FloatArray, end: FloatArray) -> NDArray[np.bool_]:
        """Return whether the rod is clear of tube and floor as theta2 goes from start to end, shape (n,)."""
        # Mostly all is clear between the least and the largest angle: one question in place of n.
        whole = np.array([min(start.min(), end.min())]), np.array([max(start.max(), end.max())])
        for ways in (whole, (start, end)):
            least = np.minimum(clear_of_tube(self.body, *ways, enough=0.0), self._over_floor(*ways))
            if (least >= self.body.clear).all():
                return np.ones(len(start), dtype=np.bool_)
        return np.asarray(least >= self.body.clear)

    def _over_floor(self, start: FloatArray, end: FloatArray) -> FloatArray:
        """Return how far the rod stays over the floor as theta2 goes from start to end, shape (n,), m.

        The height of P5 is z = c_z + R (sin(theta2) v_z - cos(theta2) t_z), least at atan2(-v_z, t_z).
        """
        body, kinematics = self.body, self.body.arm.kinematics
        lower, upper = np.minimum(start, end), np.maximum(start, end)
        lowest = np.arctan2(-kinematics.frame[2, 1], kinematics.frame[2, 2])
        lowest = lowest + 2.0 * np.pi * np.ceil((lower - lowest) / (2.0 * np.pi))
        angles = np.stack([start, end, np.where(lowest <= upper, lowest, start)])
        heights = kinematics.forward(0.0, angles)[..., 2].min(axis=0)
        return np.asarray(np.minimum(heights, body.arm.end_frame[1][2]) - body.rod_radius - self.floor)


def way_is_clear(task: Task, arm: Arm, way: FloatArray) -> bool:
    """Return whether a way is within the joint limits, and certainly clear of everything.

    Args:
        task: The task, for its obstacles and floor.
        arm: The robot in a shape.
        way: Joint angles (theta1, theta2), shape (k, 2), rad, straight in between.
    """
    around = Surroundings(task, arm)
    within = around.limits.contain(way, _ANGLE_SLACK)
    return bool(within.all() and around.clear(way[:-1], way[1:]).all())
