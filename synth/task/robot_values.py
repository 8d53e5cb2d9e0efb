"""From what a file holds of a robot, in its unit, to its values, in metres and radians."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from synth.robot import (
    ACCELERATION,
    SPEED,
    Interval,
    JointLimits,
    JointRates,
    MalleableLink,
    RigidLink,
    Robot,
)
from synth.task.catalogue import to_rigid_links
from synth.task.entry_types import ends
from synth.task.robot_schema import CatalogueEntry, LengthsEntry

if TYPE_CHECKING:
    from synth.task.robot_schema import JointRateEntry, RobotEntry


def to_robot(entry: RobotEntry, per_metre: float, name: str) -> Robot:
    """Return the robot that an entry describes; `name` if it states none.

    Raises:
        InputError: A catalogue of rigid links is wrong; with every mistake at its own key.
    """
    link, limits, full = entry.link, entry.joint_limits_deg, JointLimits()
    tip_offset = 0.5 * entry.d34 if entry.tip_offset is None else entry.tip_offset
    bend, rigid = link.max_total_bend_deg, entry.rigid_link
    if (
        isinstance(rigid, CatalogueEntry)
        or isinstance(rigid.d35, LengthsEntry)
        or isinstance(rigid.d45, LengthsEntry)
    ):
        rigid_links = to_rigid_links(rigid, entry.d34, per_metre)
        rigid_link = rigid_links.links[0]
    else:
        d35, d45 = to_interval(rigid.d35, per_metre), to_interval(rigid.d45, per_metre)
        rigid_links, rigid_link = None, RigidLink(d35, d45, (rigid.diameter or 0.0) / per_metre)
    return Robot(
        name=entry.name or name,
        d12=entry.d12 / per_metre,
        link=MalleableLink(
            length=to_interval(link.length, per_metre),
            min_bend_radius=link.min_bend_radius / per_metre,
            diameter=(link.diameter or 0.0) / per_metre,
            max_total_bend=math.inf if bend is None else math.radians(bend),
        ),
        d34=entry.d34 / per_metre,
        tip_offset=tip_offset / per_metre,
        rigid_link=rigid_link,
        rigid_links=rigid_links,
        joint_limits=JointLimits(
            base=full.base if limits.base is None else _radians(limits.base),
            second=full.second if limits.second is None else _radians(limits.second),
        ),
        joint_rates=_rates(entry.joint_rates.base, entry.joint_rates.second),
    )


def to_interval(value: float | list[float], per_metre: float) -> Interval:
    """Return a number or a pair of a file as an interval, in metres."""
    low, high = ends(value)
    return Interval(low / per_metre, high / per_metre)


def _rates(*joints: JointRateEntry) -> JointRates:
    return JointRates(
        speeds=[_in_radians(each.max_speed_deg_s, SPEED) for each in joints],
        accelerations=[_in_radians(each.max_acceleration_deg_s2, ACCELERATION) for each in joints],
    )


def _in_radians(degrees: float | None, default: float) -> float:
    return default if degrees is None else math.radians(degrees)


def _radians(limits: list[float]) -> Interval:
    return Interval(math.radians(limits[0]), math.radians(limits[1]))
