"""The kinematics of `oracle`: a second implementation, from the conventions of the file format alone.

Nothing of `synth` is imported: a task and its robot are read as plain values. Everything is in plain numpy,
by samples where the package uses closed forms: the circle of P5 at a quarter of a degree, refined about the
best sample. Metres and radians; shapes of arrays in brackets.

    theta1, theta2   joint angles
    u, t, n          end frame at theta1 = 0: u along axis 2, t along the link, n = t x u
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Self

import numpy as np

SLACK = 1e-6  # m and rad: what rounding may do
_GOLDEN = 0.5 * (np.sqrt(5.0) - 1.0)


def turned(points, angle):
    """Return points [..., 3] turned about z by angles [...]."""
    x, y, z = np.moveaxis(np.asarray(points, dtype=float), -1, 0)
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.stack([cosine * x - sine * y, sine * x + cosine * y, z + 0.0 * cosine], axis=-1)


def rotation(vector):
    """Return the matrix of a rotation vector, by Rodrigues' formula."""
    angle = np.linalg.norm(vector)
    if angle == 0.0:
        return np.eye(3)
    x, y, z = vector / angle
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross


def along_arc(curvature, lengths):
    """Return points [n, 3] of an arc, so far along it [n], in the frame at its beginning."""
    bend = np.hypot(*curvature)
    # (1 - cos kl) / k^2 and sin kl / k, without a division by a curvature of nothing.
    aside = 0.5 * lengths**2 * np.sinc(0.5 * bend * lengths / np.pi) ** 2
    ahead = lengths * np.sinc(bend * lengths / np.pi)
    return np.stack([curvature[0] * aside, curvature[1] * aside, ahead], axis=-1)


@dataclass(frozen=True, eq=False)
class OracleKinematics:
    """A robot in one shape. Points are in the base frame unless said otherwise.

    Attributes:
        robot: The hardware: any object with the fields of `synth.Robot`.
        curvatures: Of the arcs, [k, 2], 1/m.
        lengths: Of the arcs, [k], m.
        d35: Distance from P3 to P5, m.
        d45: Distance from P4 to P5, m.
        position: P1 in the task frame, [3], m.
        yaw: Of the base frame in the task frame, rad.
        pitch: Before that about its y axis, rad.
        roll: Before both about its x axis, rad.
    """

    robot: object
    curvatures: np.ndarray
    lengths: np.ndarray
    d35: float
    d45: float
    position: np.ndarray
    yaw: float
    pitch: float = 0.0
    roll: float = 0.0

    @classmethod
    def of(cls, arm) -> Self:
        """Return the same arm from the numbers of a `synth.Arm`."""
        shape, base = arm.shape, arm.base
        return cls(
            arm.robot,
            np.array(shape.curvatures),
            np.array(shape.lengths),
            arm.d35,
            arm.d45,
            np.array(base.position),
            base.yaw,
            base.pitch,
            base.roll,
        )

    @classmethod
    def stated(cls, task, content) -> Self:
        """Return the arm that a solution's JSON states, for a task."""
        arcs = content["link"]["arcs"]
        return cls(
            task.robot,
            np.array([arc["curvature"] for arc in arcs]),
            np.array([arc["length"] for arc in arcs]),
            content["distances"]["35"],
            content["distances"]["45"],
            np.array(task.base.position),
            task.base.yaw,
            task.base.pitch,
            task.base.roll,
        )

    @property
    def length(self):
        return float(self.lengths.sum())

    @property
    def bends(self):
        return np.linalg.norm(self.curvatures, axis=1)

    @property
    def total_bend(self):
        return float(self.bends @ self.lengths)

    @cached_property
    def joints_of_arcs(self):
        """The frames [k + 1, 3, 3] and points [k + 1, 3] where the arcs begin, and the end's."""
        frames, points = [np.eye(3)], [np.array([0.0, 0.0, self.robot.d12])]
        for curvature, length in zip(self.curvatures, self.lengths, strict=True):
            points.append(points[-1] + frames[-1] @ along_arc(curvature, np.array([length]))[0])
            kx, ky = curvature
            frames.append(frames[-1] @ rotation(length * np.array([-ky, kx, 0.0])))
        return np.array(frames), np.array(points)

    def centreline(self, along):
        """Return points [n, 3] of the link, so far along it [n] from P2; negative is down the column."""
        frames, points = self.joints_of_arcs
        begins = np.concatenate([[0.0], np.cumsum(self.lengths)])
        which = np.clip(np.searchsorted(begins, along, side="right") - 1, 0, len(self.lengths) - 1)
        placed = np.empty((len(along), 3))
        for index, curvature in enumerate(self.curvatures):
            mine = which == index
            local = along_arc(curvature, np.clip(along[mine], 0.0, self.length) - begins[index])
            placed[mine] = points[index] + local @ frames[index].T
        placed[:, 2] += np.minimum(along, 0.0)
        return placed

    @cached_property
    def end(self):
        """The end frame [3, 3] with columns u, n, t, and its origin [3], at theta1 = 0."""
        frames, points = self.joints_of_arcs
        return frames[-1], points[-1]

    @cached_property
    def axis_points(self):
        """P1, P2, P3, P4 at theta1 = 0, [4, 3]."""
        frame, origin = self.end
        p3 = origin - self.robot.tip_offset * frame[:, 0]
        return np.array([[0.0, 0.0, 0.0], [0.0, 0.0, self.robot.d12], p3, p3 + self.robot.d34 * frame[:, 0]])

    @cached_property
    def circle(self):
        """Centre [3] and radius of the circle of P5 at theta1 = 0."""
        along, s35 = self.robot.d34, self.d35**2
        a = (s35 - self.d45**2 + along**2) / (2.0 * along)
        return self.axis_points[2] + a * self.end[0][:, 0], np.sqrt(max(s35 - a**2, 0.0))

    @cached_property
    def _turning(self):
        """The circle's centre, and where P5 is from there at theta2 = 0 and a quarter of a turn."""
        (u, _, t), (centre, radius) = self.end[0].T, self.circle
        return centre, -radius * t, -radius * np.cross(u, t)

    def at_joint_2(self, theta2):
        """Return P5 [..., 3] at theta1 = 0."""
        centre, folded, aside = self._turning
        theta2 = np.asarray(theta2, dtype=float)[..., None]
        return centre + np.cos(theta2) * folded + np.sin(theta2) * aside

    def end_effector(self, joints):
        """Return P5 [..., 3] for joint angles [..., 2]."""
        theta1, theta2 = np.moveaxis(np.asarray(joints, dtype=float), -1, 0)
        return turned(self.at_joint_2(theta2), theta1)

    def to_task(self, points):
        return np.asarray(points) @ self._leaning.T + self.position

    def to_base(self, points):
        return (np.asarray(points) - self.position) @ self._leaning

    @cached_property
    def _leaning(self):
        """The axes of the base frame in the task frame, as columns [3, 3]."""
        z, y, x = np.diag([self.yaw, self.pitch, self.roll])[:, ::-1]
        return rotation(z) @ rotation(y) @ rotation(x)

    def reached(self, joints):
        """Return P5 [..., 3] in the task frame."""
        return self.to_task(self.end_effector(joints))

    # What the end effector can reach.

    def closest(self, targets, samples=1441, valleys=6, halvings=45):
        """Return joint angles [n, 2] within the limits that come nearest to points [n, 3] of the task frame.

        For each angle of joint 2 the best of joint 1 turns P5 into the target's half plane, or is the nearer
        end of its range. The best valleys among samples of joint 2 are narrowed by golden section.
        """
        second = self.robot.joint_limits.second
        points = self.to_base(np.atleast_2d(targets))[:, None]
        grid = np.linspace(second.lower, second.upper, samples)
        misses = self._best_turn(points, grid[None, :])[1]
        padded = np.pad(misses, ((0, 0), (1, 1)), constant_values=np.inf)
        bottom = (misses <= padded[:, :-2]) & (misses <= padded[:, 2:])
        starts = grid[np.argsort(np.where(bottom, misses, np.inf), axis=1)[:, :valleys]]
        low = np.maximum(starts - (grid[1] - grid[0]), second.lower)
        high = np.minimum(starts + (grid[1] - grid[0]), second.upper)
        for _ in range(halvings):
            width = _GOLDEN * (high - low)
            left, right = high - width, low + width
            nearer = self._best_turn(points, left)[1] < self._best_turn(points, right)[1]
            low, high = np.where(nearer, low, left), np.where(nearer, right, high)
        theta2 = np.concatenate([0.5 * (low + high), low, high, starts], axis=1)
        theta1, misses = self._best_turn(points, theta2)
        best = np.arange(len(points)), np.argmin(misses, axis=1)
        return np.column_stack([theta1[best], theta2[best]])

    def misses(self, joints, targets):
        """Return the distances of P5 at joint angles [n, 2] from targets of the task frame [n, 3], m."""
        return np.linalg.norm(self.reached(joints) - targets, axis=-1)

    def _best_turn(self, points, theta2):
        """Return the best theta1 for points [..., 3] and angles of joint 2, and the misses."""
        at_zero, limits = self.at_joint_2(theta2), self.robot.joint_limits.base
        wanted = np.arctan2(points[..., 1], points[..., 0]) - np.arctan2(at_zero[..., 1], at_zero[..., 0])
        # Beyond the range, which is at most a turn wide, the nearer end of it is the best.
        middle, half = 0.5 * (limits.lower + limits.upper), 0.5 * (limits.upper - limits.lower)
        off = np.remainder(wanted - middle + np.pi, 2.0 * np.pi) - np.pi
        theta1 = middle + np.clip(off, -half, half)
        return theta1, np.linalg.norm(turned(at_zero, theta1) - points, axis=-1)


def longest_rod(robot):
    """Return the largest distance from the link's end to P5, m, by samples of the ranges of d35 and d45."""
    choices = [robot.rigid_link] if robot.rigid_links is None else robot.rigid_links.links
    return max(_longest(robot, rigid) for rigid in choices)


def _longest(robot, rigid):
    d35, d45 = np.meshgrid(*(np.linspace(i.lower, i.upper, 41) for i in (rigid.d35, rigid.d45)))
    a = (d35**2 - d45**2 + robot.d34**2) / (2.0 * robot.d34)
    squared = d35**2 - a**2
    reach = np.sqrt(np.maximum(squared, 0.0) + (a - robot.tip_offset) ** 2)
    return float(reach[squared >= -1e-9 * robot.d34**2].max(initial=0.0))
