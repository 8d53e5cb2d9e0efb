"""The robot: hardware, malleable link, forward and inverse kinematics, workspace."""

from synth.robot.arm import Arm, JointBranches
from synth.robot.base import BasePose
from synth.robot.clearance import CLEAR, MOST_CLEARANCE, ArmBody, turned
from synth.robot.hardware import Interval, JointLimits, MalleableLink, RigidLink, Robot
from synth.robot.kinematics import Kinematics
from synth.robot.link import LinkShape, arc_motion, chain_end, chain_points
from synth.robot.presets import PRESETS
from synth.robot.reach import LinkReach
from synth.robot.turn import into_turn
from synth.robot.workspace import SurfaceMesh, Workspace

__all__ = [
    "CLEAR",
    "MOST_CLEARANCE",
    "PRESETS",
    "Arm",
    "ArmBody",
    "BasePose",
    "Interval",
    "JointBranches",
    "JointLimits",
    "Kinematics",
    "LinkReach",
    "LinkShape",
    "MalleableLink",
    "RigidLink",
    "Robot",
    "SurfaceMesh",
    "Workspace",
    "arc_motion",
    "chain_end",
    "chain_points",
    "into_turn",
    "turned",
]
