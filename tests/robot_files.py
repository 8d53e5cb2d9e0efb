"""Robot descriptions read with the standard library and numpy alone, and solutions to be described."""

from __future__ import annotations

from dataclasses import dataclass, replace
from xml.etree import ElementTree as ET

import numpy as np
from planted import ROBOT, planted_arm

from synth.robot import Arm, BasePose, LinkShape
from synth.synthesis import Design, Solution, Status, Timing, verify
from synth.task import PointTarget, Task, Topology


def _bent(curvatures, lengths, **changes):
    return replace(Arm(ROBOT, LinkShape(curvatures, lengths), 0.455, 0.460), **changes)


def arms():
    """Return ten different shapes: all categories, straight, tightly bent, elsewhere, of other robots."""
    rng = np.random.default_rng(4)
    elsewhere = BasePose([0.4, -0.3, 0.2], 2.1)
    thick = replace(ROBOT, rigid_link=replace(ROBOT.rigid_link, diameter=0.04))
    thin = replace(ROBOT, link=replace(ROBOT.link, diameter=0.0))
    return {
        "general": planted_arm(rng),
        "spherical": planted_arm(rng, Topology.SPHERICAL),
        "puma": planted_arm(rng, Topology.PUMA),
        "scara": planted_arm(rng, Topology.SCARA),
        "straight": _bent([[0.0, 0.0]], [0.6]),
        "a quarter turn": _bent([[np.pi / 2 / 0.6, 0.0]], [0.6]),
        "tightest": _bent([[1 / 0.11, 0.0], [0.0, -1 / 0.11], [0.0, 0.0]], [0.2, 0.2, 0.25]),
        "elsewhere": replace(planted_arm(rng), base=elsewhere),
        "thick rod": replace(planted_arm(rng), robot=thick),
        "thin tube": replace(planted_arm(rng), robot=thin, base=elsewhere),
    }


def solution_with(arm, floor=None, obstacles=(), name="two & <crates>"):
    """Return a solution with one shape, of a task with targets at random joint angles of it."""
    joints = np.random.default_rng(1).uniform(*arm.joint_bounds, (4, 2))
    names = ["pick", "place it", "place-it", "3rd"]
    targets = [PointTarget(n, p) for n, p in zip(names, arm.forward_kinematics(*joints.T), strict=True)]
    task = Task(name, arm.robot, targets, arm.base, floor=floor, obstacles=obstacles)
    design = Design(arm, verify(task, arm))
    return Solution(task, Status.FOUND, "found", (), 7, (design,), 1, Timing(0.0, 0.0, 0.0, 0.0))


def numbers(text):
    return np.array([float(part) for part in text.split()])


def about(axis, angle):
    """Return the rotation about a coordinate axis."""
    c, s = np.cos(angle), np.sin(angle)
    i, j = [(1, 2), (2, 0), (0, 1)][axis]
    rotation = np.eye(3)
    rotation[i, i] = rotation[j, j] = c
    rotation[i, j], rotation[j, i] = -s, s
    return rotation


def pose_of(element):
    """Return the pose that an <origin> of a URDF states, as a 4 x 4 matrix."""
    pose = np.eye(4)
    if element is not None:
        roll, pitch, yaw = numbers(element.get("rpy", "0 0 0"))
        pose[:3, :3] = about(2, yaw) @ about(1, pitch) @ about(0, roll)
        pose[:3, 3] = numbers(element.get("xyz", "0 0 0"))
    return pose


def turned(axis, angle):
    pose = np.eye(4)
    pose[:3, :3] = about(int(np.argmax(np.abs(axis))), angle * axis.sum())
    return pose


class Urdf:
    """A URDF: a chain of links, each after its joint."""

    def __init__(self, path):
        self.root = ET.parse(path).getroot()
        self.joints = self.root.findall("joint")

    def poses(self, joints):
        """Return the pose of each link by its name at (theta1, theta2)."""
        angles = dict(zip(("joint1", "joint2"), joints, strict=True))
        poses = {"world": np.eye(4)}
        for joint in self.joints:
            pose = poses[joint.find("parent").get("link")] @ pose_of(joint.find("origin"))
            if joint.get("type") == "revolute":
                pose = pose @ turned(numbers(joint.find("axis").get("xyz")), angles[joint.get("name")])
            poses[joint.find("child").get("link")] = pose
        return poses

    def pieces(self, link):
        """Return the collision pieces of a link."""
        element = next(each for each in self.root.findall("link") if each.get("name") == link)
        return [piece_of(collision) for collision in element.findall("collision")]


@dataclass
class Piece:
    """A cylinder, or a sphere where it has no length, in the frame of its link."""

    start: np.ndarray
    end: np.ndarray
    radius: float
    capped: bool = False  # with half a sphere at each end

    def depth(self, points):
        """Return how deep points are inside, negative outside."""
        along = self.end - self.start
        length = np.linalg.norm(along)
        if length == 0.0:
            return self.radius - np.linalg.norm(points - self.start, axis=-1)
        share = (points - self.start) @ along / length
        across = np.linalg.norm(points - self.start - share[..., None] * along / length, axis=-1)
        inside = np.minimum(self.radius - across, np.minimum(share, length - share))
        if self.capped:
            nearest = self.start + np.clip(share, 0.0, length)[..., None] * along / length
            return self.radius - np.linalg.norm(points - nearest, axis=-1)
        return inside

    def surface(self, rng, count=400):
        """Return random points of its surface."""
        directions = rng.normal(size=(count, 3))
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
        along = self.end - self.start
        length = np.linalg.norm(along)
        if length == 0.0 or self.capped:
            return self.start + rng.uniform(size=(count, 1)) * along + self.radius * directions
        across = np.cross(directions, along / length)
        across /= np.linalg.norm(across, axis=1, keepdims=True)
        share = np.concatenate([[0.0, 1.0], rng.uniform(size=count - 2)])[:, None]
        return self.start + share * along + self.radius * across


def piece_of(collision):
    pose = pose_of(collision.find("origin"))
    (shape,) = collision.find("geometry")
    length = float(shape.get("length", "0"))
    half = 0.5 * length * pose[:3, 2]
    return Piece(pose[:3, 3] - half, pose[:3, 3] + half, float(shape.get("radius")))


def tube_surface(arm, rng):
    """Return points of the surface of the malleable link in the base frame at joint 1 = 0, ends rounded."""
    radius = 0.5 * arm.robot.link.diameter
    s = np.linspace(0.0, arm.shape.length, 4001)
    centres = arm.shape.point_at(s) + arm.base_joint[1]
    tangents = np.gradient(centres, s, axis=0)
    across = np.cross(tangents, rng.normal(size=centres.shape))
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    ball = rng.normal(size=(500, 3))
    ball *= radius / np.linalg.norm(ball, axis=1, keepdims=True)
    return np.concatenate([centres, centres + radius * across, centres[0] + ball, centres[-1] + ball])


def off_the_centreline(arm, points):
    """Return how far points of the base frame at joint 1 = 0 are from the malleable link's centreline, m."""
    s = np.linspace(0.0, arm.shape.length, 4001)
    centres = arm.shape.point_at(s) + arm.base_joint[1]
    return np.array([np.linalg.norm(centres - point, axis=1).min() for point in points])


def exported_arm(request, tmp_path_factory):
    """Return an arm and the folder with all its files; to be made a fixture over the names of `arms`."""
    arm = arms()[request.param]
    folder = tmp_path_factory.mktemp("planner")
    solution_with(arm, floor=-1.0).export(folder)
    return arm, folder


def random_joints(arm, count=1000):
    return np.random.default_rng(0).uniform(*arm.joint_bounds, (count, 2))


def mjcf(folder):
    return ET.parse(folder / "robot.xml").getroot()


def matrix(element):
    """Return the pose that an element of MJCF states, as a 4 x 4 matrix."""
    w, x, y, z = numbers(element.get("quat", "1 0 0 0"))
    pose = np.eye(4)
    pose[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    pose[:3, 3] = numbers(element.get("pos", "0 0 0"))
    return pose
