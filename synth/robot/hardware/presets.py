"""Robots known by name."""

from __future__ import annotations

import math
from types import MappingProxyType
from typing import TYPE_CHECKING

from synth.robot.hardware.hardware import JointLimits, MalleableLink, Robot
from synth.robot.hardware.interval import Interval
from synth.robot.hardware.joint_rates import SPEED, JointRates
from synth.robot.hardware.rigid_links import RigidLink

if TYPE_CHECKING:
    from collections.abc import Mapping

PRESETS: Mapping[str, Robot] = MappingProxyType(
    {
        # The published prototype. Distances and joint limits: Clark and Rojas (2020), caption of the
        # figure of experimental results and section IV; the link: Ranne, Clark and Rojas, IEEE Robotics
        # and Automation Magazine 29(1), 2022. The link's end is taken in the middle of P3 and P4.
        "malleable-2dof": Robot(
            name="malleable-2dof",
            d12=0.058,
            link=MalleableLink(
                length=Interval(0.550, 0.700), min_bend_radius=0.110, diameter=0.050, max_total_bend=5.0
            ),
            d34=0.049,
            tip_offset=0.0245,
            rigid_link=RigidLink(d35=Interval.fixed(0.455), d45=Interval.fixed(0.460)),
            joint_limits=JointLimits(
                base=Interval(math.radians(10.0), math.radians(350.0)),
                second=Interval(math.radians(53.0), math.radians(307.0)),
            ),
            joint_rates=JointRates(speeds=(SPEED, SPEED)),
        ),
    }
)
