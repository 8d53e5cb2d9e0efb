"""The robot: hardware, malleable link, forward and inverse kinematics, workspace."""

from synth.robot.arc_chains import ArcChains
from synth.robot.arm import Arm, JointBranches
from synth.robot.base import BasePose
from synth.robot.clearance import MOST_CLEARANCE, ArmBody
from synth.robot.end_pose import ANYWHERE, PoseMiss, pose_miss
from synth.robot.hardware import JointLimits, MalleableLink, RigidLink, Robot
from synth.robot.interval import Interval
from synth.robot.kinematics import Kinematics
from synth.robot.link import LinkShape, arc_motion, chain_end, chain_points
from synth.robot.pose_proofs import why_no_link
from synth.robot.pose_search import link_to_pose, links_to_poses
from synth.robot.presets import PRESETS
from synth.robot.reach import LinkReach
from synth.robot.turn import into_turn, turned
from synth.robot.workspace import SurfaceMesh, Workspace

__all__ = [
    "ANYWHERE",
    "MOST_CLEARANCE",
    "PRESETS",
    "ArcChains",
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
    "PoseMiss",
    "RigidLink",
    "Robot",
    "SurfaceMesh",
    "Workspace",
    "arc_motion",
    "chain_end",
    "chain_points",
    "into_turn",
    "link_to_pose",
    "links_to_poses",
    "pose_miss",
    "turned",
    "why_no_link",
]
