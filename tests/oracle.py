"""A second implementation of the arm, to judge `synth` by: what it keeps clear of, and what limits it breaks.

Its kinematics stand in `oracle_kinematics`; nothing of `synth` is imported there or here. Clearances are
found by samples: the centreline at points half a millimetre apart, each refined about its best sample. So one
is never less than the true one, and hardly more. Metres and radians; shapes of arrays in brackets.
"""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np
from oracle_kinematics import SLACK, OracleKinematics, longest_rod, rotation, turned

__all__ = [
    "SLACK",
    "SPACING",
    "Breach",
    "OracleArm",
    "distance_from_solid",
    "longest_rod",
    "rotation",
    "turned",
]

SPACING = 0.5e-3  # m, between points of the centreline


class Breach(NamedTuple):
    """A limit that is broken, and by how much, m or rad."""

    limit: str
    amount: float


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


class OracleArm(OracleKinematics):
    """A robot in one shape, with its limits and the room it takes."""

    @property
    def tube_radius(self):
        return 0.5 * self.robot.link.diameter

    @property
    def rigid_link(self):
        """The rigid link that may be mounted: of a catalogue the nearest one."""
        if self.robot.rigid_links is None:
            return self.robot.rigid_link
        return min(
            self.robot.rigid_links.links,
            key=lambda each: abs(each.d35.lower - self.d35) + abs(each.d45.lower - self.d45),
        )

    @property
    def rod_radius(self):
        return 0.5 * self.rigid_link.diameter

    def samples(self, first=0.0, last=None, spacing=SPACING):
        """Return lengths along the link, no farther apart than the spacing, both ends included."""
        last = self.length if last is None else last
        return np.linspace(first, last, max(int(np.ceil((last - first) / spacing)), 1) + 1)

    # Limits of the hardware, and the floor.

    def breaches_of_shape(self, floor=None, spacing=SPACING):
        """Return the limits that the shape breaks whatever the joints do."""
        link, rigid = self.robot.link, self.rigid_link
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
