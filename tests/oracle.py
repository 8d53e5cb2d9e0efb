"""A second implementation of the arm, from the conventions of the file format alone, to judge `synth` by.

Nothing of `synth` is imported: a task and its robot are read as plain values. Everything is in plain numpy,
by samples where the package uses bounds or closed forms: the centreline at points half a millimetre apart,
the circle of P5 at a quarter of a degree, each refined about its best sample. Metres and radians; shapes of
arrays in brackets. A clearance by samples is never less than the true one, and hardly more.

    theta1, theta2   joint angles
    u, t, n          end frame at theta1 = 0: u along axis 2, t along the link, n = t x u
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

SPACING = 0.5e-3  # m, between points of the centreline
SLACK = 1e-6  # m and rad: what rounding may do
_GOLDEN = 0.5 * (np.sqrt(5.0) - 1.0)


class Breach(NamedTuple):
    """A limit that is broken, and by how much, m or rad."""

    limit: str
    amount: float


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


def distance_from_solid(solid, points):
    """Return the signed distance of points [..., 3] from a capsule or a box."""
    if hasattr(solid, "ends"):
        return distance_from_segment(points, *solid.ends) - solid.radius
    beyond = np.abs(turned(points - solid.centre, -solid.yaw)) - 0.5 * solid.size
    outside = np.sqrt(np.sum(np.clip(beyond, 0.0, None) ** 2, axis=-1))
    return np.where(outside > 0.0, outside, beyond.max(axis=-1))


def distance_from_segment(points, start, end):
    """Return the distance of points [..., 3] from a segment."""
    along = end - start
    share = np.clip((points - start) @ along / max(along @ along, 1e-30), 0.0, 1.0)
    return np.linalg.norm(points - (start + share[..., None] * along), axis=-1)


def least_along(function, samples):
    """Return the least value of a function over samples [n], refined about the best one."""
    values = function(samples)
    best = int(np.argmin(values))
    least = float(values[best])
    low, high = samples[max(best - 1, 0)], samples[min(best + 1, len(samples) - 1)]
    for _ in range(3):
        nearer = np.linspace(low, high, 41)
        values = function(nearer)
        best = int(np.argmin(values))
        least = min(least, float(values[best]))
        low, high = nearer[max(best - 1, 0)], nearer[min(best + 1, 40)]
    return least


@dataclass(frozen=True, eq=False)
class OracleArm:
    """A robot in one shape. Points are in the base frame unless said otherwise.

    Attributes:
        robot: The hardware: any object with the fields of `synth.Robot`.
        curvatures: Of the arcs, [k, 2], 1/m.
        lengths: Of the arcs, [k], m.
        d35: Distance from P3 to P5, m.
        d45: Distance from P4 to P5, m.
        position: P1 in the task frame, [3], m.
        yaw: Of the base frame in the task frame, rad.
    """

    robot: object
    curvatures: np.ndarray
    lengths: np.ndarray
    d35: float
    d45: float
    position: np.ndarray
    yaw: float

    @classmethod
    def of(cls, arm) -> OracleArm:
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
        )

    @classmethod
    def stated(cls, task, content) -> OracleArm:
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

    @property
    def tube_radius(self):
        return 0.5 * self.robot.link.diameter

    @property
    def rod_radius(self):
        return 0.5 * self.robot.rigid_link.diameter

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

    def samples(self, first=0.0, last=None, spacing=SPACING):
        """Return lengths along the link, no farther apart than the spacing, both ends included."""
        last = self.length if last is None else last
        return np.linspace(first, last, max(int(np.ceil((last - first) / spacing)), 1) + 1)

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
        return turned(points, self.yaw) + self.position

    def to_base(self, points):
        return turned(np.asarray(points) - self.position, -self.yaw)

    def reached(self, joints):
        """Return P5 [..., 3] in the task frame."""
        return self.to_task(self.end_effector(joints))

    # Limits of the hardware, and the floor.

    def breaches_of_shape(self, floor=None, spacing=SPACING):
        """Return the limits that the shape breaks whatever the joints do."""
        link, rigid = self.robot.link, self.robot.rigid_link
        breaches = [
            Breach(name, max(interval.lower - value, value - interval.upper))
            for name, interval, value in (
                ("link length", link.length, self.length),
                ("d35", rigid.d35, self.d35),
                ("d45", rigid.d45, self.d45),
            )
        ]
        gap, longest = abs(self.d35 - self.d45) - self.robot.d34, self.robot.d34 - self.d35 - self.d45
        tightest = 1.0 / max(float(self.bends.max()), 1e-12)
        breaches += [
            Breach("triangle P3 P4 P5", max(gap, longest)),
            Breach("bend radius", link.min_bend_radius - tightest),
            Breach("total bend", self.total_bend - link.max_total_bend),
            Breach("itself", -self.tube_from_itself(spacing=4 * spacing)),
        ]
        if floor is not None:
            breaches += [
                Breach("floor: link", floor - self.lowest(spacing)),
                Breach("floor: second joint", floor - float(self.axis_points[2:, 2].min())),
            ]
        return [breach for breach in breaches if not breach.amount <= SLACK]

    def breaches_at(self, joints, floor=None, solids=()):
        """Return the limits that the arm breaks at joint angles [2]: ranges, floor, solids, itself."""
        limits = self.robot.joint_limits
        breaches = [
            Breach(f"joint {i}", max(interval.lower - angle, angle - interval.upper))
            for i, (interval, angle) in enumerate(
                zip((limits.base, limits.second), joints, strict=True), start=1
            )
        ]
        if floor is not None:
            height = float(self.end_effector(joints)[2]) - self.rod_radius
            breaches.append(Breach("floor: end effector", floor - height))
            breaches.append(Breach("floor: rigid link", floor - self.lowest_of_rod(joints)))
        breaches.append(Breach("rod in tube", -self.rod_from_tube(joints)))
        breaches += [
            Breach(f"solid {i}", -clearance)
            for i, clearance in enumerate(self.clearances(joints, solids).min(axis=1), start=1)
        ]
        return [breach for breach in breaches if not breach.amount <= 2.0 * SLACK]

    def lowest(self, spacing=SPACING):
        """Return the height of the lowest point of the tube beyond its mount, half a diameter long, m."""
        samples = self.samples(min(self.tube_radius, self.length), spacing=spacing)
        return least_along(lambda s: self.centreline(s)[:, 2], samples) - self.tube_radius

    def lowest_of_rod(self, joints):
        """Return the height of the lowest point of the rod a diameter of the tube or more from joint 2, m."""
        origin, tip = self.end[1], self.end_effector(joints)
        length = np.linalg.norm(tip - origin)
        share = min(self.robot.link.diameter / max(length, 1e-12), 1.0)
        return float(min(tip[2], origin[2] + share * (tip[2] - origin[2]))) - self.rod_radius

    # Room.

    def clearances(self, joints, solids, spacing=SPACING):
        """Return how far tube and rod keep from solids of the task frame at joint angles [2], [m, 2]."""
        origin, tip = self.to_task(turned(self.end[1], joints[0])), self.reached(joints)

        def tube(along):
            return self.to_task(turned(self.centreline(along), joints[0]))

        def rod(share):
            return origin + share[:, None] * (tip - origin)

        along = self.samples(min(self.tube_radius, self.length), spacing=spacing)
        shares = np.linspace(0.0, 1.0, max(int(np.linalg.norm(tip - origin) / spacing), 2))
        return np.array(
            [
                [
                    least_along(lambda s, solid=solid: distance_from_solid(solid, tube(s)), along)
                    - self.tube_radius,
                    least_along(lambda s, solid=solid: distance_from_solid(solid, rod(s)), shares)
                    - self.rod_radius,
                ]
                for solid in solids
            ]
        ).reshape(-1, 2)

    def clearance(self, joints, solids):
        """Return the least distance between the arm at several joint angles [n, 2] and solids, m."""
        return min((float(self.clearances(each, solids).min()) for each in joints), default=np.inf)

    def rod_from_tube(self, joints, spacing=SPACING):
        """Return how far the rod keeps from tube and column, but for the room of joint 2, m."""
        joint, origin = self.robot.link.diameter, self.end[1]
        tip = self.at_joint_2(joints[1])
        length = float(np.linalg.norm(tip - origin))
        if joint == 0.0 or self.length <= joint or length <= joint:
            return np.inf
        start = origin + joint / length * (tip - origin)
        along = self.samples(-self.robot.d12, self.length - joint, spacing)
        least = least_along(lambda s: distance_from_segment(self.centreline(s), start, tip), along)
        return least - self.tube_radius - self.rod_radius

    def tube_from_itself(self, spacing=4 * SPACING):
        """Return how far pieces of tube and column, half a turn or more apart, keep from each other, m."""
        apart = np.pi * self.robot.link.min_bend_radius
        if self.tube_radius == 0.0 or self.length + self.robot.d12 <= apart:
            return np.inf
        along = self.samples(-self.robot.d12, spacing=spacing)
        points = self.centreline(along)
        squared = np.sum(points**2, axis=1)
        between = squared[:, None] + squared - 2.0 * points @ points.T
        between[along[None, :] - along[:, None] < apart] = np.inf
        return float(np.sqrt(max(between.min(), 0.0))) - 2.0 * self.tube_radius

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

    # How axis 2 lies to axis 1.

    def distance_from_axis_2(self, point):
        """Return the distance of a point of the base frame from axis 2, m."""
        u, away = self.end[0][:, 0], np.asarray(point) - self.end[1]
        return float(np.linalg.norm(away - (away @ u) * u))

    @cached_property
    def off_topology(self):
        """How far the shape is from each special topology: m, but rad for SCARA."""
        p1, p2 = self.axis_points[:2]
        u = self.end[0][:, 0]
        return {
            "spherical": self.distance_from_axis_2(p1),
            "puma": self.distance_from_axis_2(p2),
            "scara": float(np.arctan2(np.hypot(u[0], u[1]), abs(u[2]))),
        }

    def is_topology(self, topology):
        """Whether the shape is of a topology by its name: axes that meet to a micrometre, a microradian."""
        if topology == "any":
            return True
        off = self.off_topology
        if topology == "general":
            lengths = min(off["spherical"], off["puma"])
            return lengths > 1e-3 - SLACK and off["scara"] > np.radians(0.1) - SLACK
        return off[topology] <= 1.0e-6 * (1.0 + 1e-3)


def longest_rod(robot):
    """Return the largest distance from the link's end to P5, m, by samples of the ranges of d35 and d45."""
    rigid = robot.rigid_link
    d35, d45 = np.meshgrid(*(np.linspace(i.lower, i.upper, 41) for i in (rigid.d35, rigid.d45)))
    a = (d35**2 - d45**2 + robot.d34**2) / (2.0 * robot.d34)
    squared = d35**2 - a**2
    reach = np.sqrt(np.maximum(squared, 0.0) + (a - robot.tip_offset) ** 2)
    return float(reach[squared >= -1e-9 * robot.d34**2].max(initial=0.0))
