"""The malleable link: its shapes, its limits, where it can end."""

from synth.robot.link.arc_chains import ArcChains, random_curvatures
from synth.robot.link.chain_steps import stepped
from synth.robot.link.end_pose import ANYWHERE, PoseMiss, pose_miss
from synth.robot.link.pose_proofs import why_no_link
from synth.robot.link.pose_search import link_to_pose, links_to_poses
from synth.robot.link.reach import LinkReach
from synth.robot.link.shape import LinkShape, arc_motion, chain_end, chain_points

__all__ = [
    "ANYWHERE",
    "ArcChains",
    "LinkReach",
    "LinkShape",
    "PoseMiss",
    "arc_motion",
    "chain_end",
    "chain_points",
    "link_to_pose",
    "links_to_poses",
    "pose_miss",
    "random_curvatures",
    "stepped",
    "why_no_link",
]
