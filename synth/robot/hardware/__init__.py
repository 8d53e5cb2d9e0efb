"""What is fixed in a robot: sizes, ranges, presets."""

from synth.robot.hardware.about_axis_1 import into_turn, turned
from synth.robot.hardware.hardware import JointLimits, MalleableLink, RigidLink, Robot, no_triangle
from synth.robot.hardware.interval import Interval, check_interval
from synth.robot.hardware.presets import PRESETS

__all__ = [
    "PRESETS",
    "Interval",
    "JointLimits",
    "MalleableLink",
    "RigidLink",
    "Robot",
    "check_interval",
    "into_turn",
    "no_triangle",
    "turned",
]
