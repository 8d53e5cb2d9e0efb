"""The robot: hardware, malleable link, forward and inverse kinematics, workspace."""

from synth.robot.arm import Arm, JointBranches
from synth.robot.base_places import BaseChoices, BasePlaces, BaseRange
from synth.robot.base_pose import BasePose
from synth.robot.body import ArmBody
from synth.robot.clearance import MOST_CLEARANCE, clear_of_obstacles, clear_of_tube, tube_clear_of_itself
from synth.robot.closest_joints import closest_joints
from synth.robot.hardware import (
    ACCELERATION,
    PRESETS,
    SPEED,
    Interval,
    JointLimits,
    JointRates,
    MalleableLink,
    RigidLink,
    RigidLinkChoices,
    Robot,
    into_turn,
    no_triangle,
    turned,
)
from synth.robot.kinematics import Kinematics
from synth.robot.link import (
    ANYWHERE,
    ArcChains,
    LinkReach,
    LinkShape,
    PoseMiss,
    arc_motion,
    chain_end,
    chain_points,
    link_to_pose,
    links_to_poses,
    pose_miss,
    random_curvatures,
    stepped,
    why_no_link,
)
from synth.robot.surface_mesh import SurfaceMesh
from synth.robot.validity import keeps_clear
from synth.robot.workspace import Workspace

__all__ = [
    "ACCELERATION",
    "ANYWHERE",
    "MOST_CLEARANCE",
    "PRESETS",
    "SPEED",
    "ArcChains",
    "Arm",
    "ArmBody",
    "BaseChoices",
    "BasePlaces",
    "BasePose",
    "BaseRange",
    "Interval",
    "JointBranches",
    "JointLimits",
    "JointRates",
    "Kinematics",
    "LinkReach",
    "LinkShape",
    "MalleableLink",
    "PoseMiss",
    "RigidLink",
    "RigidLinkChoices",
    "Robot",
    "SurfaceMesh",
    "Workspace",
    "arc_motion",
    "chain_end",
    "chain_points",
    "clear_of_obstacles",
    "clear_of_tube",
    "closest_joints",
    "into_turn",
    "keeps_clear",
    "link_to_pose",
    "links_to_poses",
    "no_triangle",
    "pose_miss",
    "random_curvatures",
    "stepped",
    "tube_clear_of_itself",
    "turned",
    "why_no_link",
]
