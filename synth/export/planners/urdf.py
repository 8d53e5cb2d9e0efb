"""URDF 1.0 and SRDF: cylinders and spheres, because capsules and meshes that collide are not read alike.

Capsules are not in URDF 1.0, and readers drop them or fail; of a mesh that collides they take the convex
hull, more than twice the volume of a tube bent by a quarter turn. So the tube is cylinders with a sphere at
each knee, and the one mesh is for the eye.
"""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING
from xml.etree.ElementTree import Comment, Element, SubElement, indent, tostring

import numpy as np

from synth.export.planners.description import EFFORT, numbers
from synth.export.planners.rotations import along
from synth.geometry import roll_pitch_yaw

if TYPE_CHECKING:
    from collections.abc import Sequence

    from synth.arrays import FloatArray
    from synth.export.planners.description import Body, Description
    from synth.export.planners.pieces import Chain
    from synth.robot import Interval

TUBE = "malleable_link.obj"
_STRAIGHT = np.eye(3)


def urdf_bytes(description: Description) -> bytes:
    """Return the URDF of an arm; it names the mesh `TUBE` beside it."""
    robot = Element("robot", name=description.robot_name)
    for line in (*description.origin, description.nominal):
        robot.append(Comment(f" {in_comment(line)} "))
    # For MuJoCo, which would else merge tool0 into rigid_link and leave out what is only seen.
    SubElement(SubElement(robot, "mujoco"), "compiler", fusestatic="false", discardvisual="false")
    SubElement(robot, "link", name="world")
    for body in description.bodies:
        _add_link(robot, body)
    base, limits = description.solution.robot.base, description.task.robot.joint_limits
    rates = description.task.robot.joint_rates
    rotation, end = description.link_end
    _add_joint(robot, "base", "world", "base_link", base.position, base.rotation)
    joint = _add_joint(robot, "joint1", "base_link", "malleable_link", np.zeros(3), _STRAIGHT)
    _turns(joint, (0.0, 0.0, 1.0), limits.base, rates.speeds[0])
    joint = _add_joint(robot, "joint2", "malleable_link", "rigid_link", end, rotation)
    _turns(joint, (1.0, 0.0, 0.0), limits.second, rates.speeds[1])
    _add_joint(robot, "tool", "rigid_link", "tool0", description.tool, description.tool_rotation)
    return xml_bytes(robot)


def srdf_bytes(description: Description) -> bytes:
    """Return the SRDF of an arm: its group, a named state at each target, and which bodies may touch."""
    robot = Element("robot", name=description.robot_name)
    for line in description.origin:
        robot.append(Comment(f" {in_comment(line)} "))
    group = SubElement(robot, "group", name="arm")
    SubElement(group, "chain", base_link="base_link", tip_link="tool0")
    for name, (theta1, theta2) in description.postures.items():
        state = SubElement(robot, "group_state", name=name, group="arm")
        SubElement(state, "joint", name="joint1", value=numbers(theta1))
        SubElement(state, "joint", name="joint2", value=numbers(theta2))
    names = [body.name for body in description.bodies]
    for one, other in itertools.pairwise(names):
        SubElement(robot, "disable_collisions", link1=one, link2=other, reason="Adjacent")
    return xml_bytes(robot)


def xml_bytes(root: Element) -> bytes:
    """Return an XML file, indented."""
    indent(root)
    text: bytes = tostring(root, encoding="utf-8")
    return b'<?xml version="1.0"?>\n' + text + b"\n"


def in_comment(line: str) -> str:
    """Return a line that may stand in a comment, where no two hyphens may."""
    return line.replace("--", "- -").rstrip("-")


def _add_link(robot: Element, body: Body) -> None:
    link = SubElement(robot, "link", name=body.name)
    inertial = SubElement(link, "inertial")
    SubElement(inertial, "origin", xyz=numbers(body.inertia.centre), rpy="0 0 0")
    SubElement(inertial, "mass", value=numbers(body.inertia.mass))
    moments = body.inertia.moments
    pairs = {"ixx": (0, 0), "ixy": (0, 1), "ixz": (0, 2), "iyy": (1, 1), "iyz": (1, 2), "izz": (2, 2)}
    SubElement(inertial, "inertia", {name: numbers(moments[pair]) for name, pair in pairs.items()})
    if body.pieces is None:
        return
    visual = SubElement(link, "visual", name=f"{body.name}_seen")
    if body.name == "malleable_link":
        SubElement(SubElement(visual, "geometry"), "mesh", filename=TUBE)
    else:
        _add_cylinder(visual, body.pieces.middles[0], body.pieces.chords[0], body.pieces.radius)
    _add_collisions(link, body.pieces)


def _add_collisions(link: Element, pieces: Chain) -> None:
    names = (f"{link.get('name')}_piece_{number}" for number in itertools.count(1))
    for middle, chord in zip(pieces.middles, pieces.chords, strict=True):
        collision = SubElement(link, "collision", name=next(names))
        _add_cylinder(collision, middle, chord, pieces.radius)
    for knee in pieces.knees if pieces.rounded else ():
        collision = SubElement(link, "collision", name=next(names))
        SubElement(collision, "origin", xyz=numbers(knee), rpy="0 0 0")
        SubElement(SubElement(collision, "geometry"), "sphere", radius=numbers(pieces.radius))


def _add_cylinder(parent: Element, middle: FloatArray, chord: FloatArray, radius: float) -> None:
    SubElement(parent, "origin", xyz=numbers(middle), rpy=numbers(along(chord)))
    length = numbers(np.linalg.norm(chord))
    SubElement(SubElement(parent, "geometry"), "cylinder", radius=numbers(radius), length=length)


def _add_joint(
    robot: Element, name: str, parent: str, child: str, position: FloatArray, rotation: FloatArray
) -> Element:
    """Add a joint, fixed until it turns."""
    joint = SubElement(robot, "joint", name=name, type="fixed")
    SubElement(joint, "origin", xyz=numbers(position), rpy=numbers(roll_pitch_yaw(rotation)))
    SubElement(joint, "parent", link=parent)
    SubElement(joint, "child", link=child)
    return joint


def _turns(joint: Element, axis: Sequence[float], limits: Interval, speed: float) -> None:
    """Let a joint turn about an axis of its own frame within limits, rad, at most at a speed, rad/s."""
    joint.set("type", "revolute")
    SubElement(joint, "axis", xyz=numbers(axis))
    SubElement(
        joint,
        "limit",
        lower=numbers(limits.lower),
        upper=numbers(limits.upper),
        effort=numbers(EFFORT),
        velocity=numbers(speed),
    )
