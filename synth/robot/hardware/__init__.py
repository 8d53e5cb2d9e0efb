"""What is fixed in a robot: sizes, ranges, presets."""

from synth.robot.hardware.about_axis_1 import into_turn, turned
from synth.robot.hardware.hardware import JointLimits, MalleableLink, Robot
from synth.robot.hardware.interval import GivenInterval, Interval, check_interval
from synth.robot.hardware.joint_rates import ACCELERATION, SPEED, JointRates
from synth.robot.hardware.presets import PRESETS
from synth.robot.hardware.rigid_links import RigidLink, RigidLinkChoices, no_triangle

__all__ = [
    "ACCELERATION",
    "PRESETS",
    "SPEED",
    "GivenInterval",
    "Interval",
    "JointLimits",
    "JointRates",
    "MalleableLink",
    "RigidLink",
    "RigidLinkChoices",
    "Robot",
    "check_interval",
    "into_turn",
    "no_triangle",
    "turned",
]
