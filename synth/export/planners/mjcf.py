"""MJCF: capsules, sites at P1 to P5 and at the targets, the obstacles, a motor for each joint."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING
from xml.etree.ElementTree import Comment, Element, SubElement

import numpy as np

from synth.export.planners.description import EFFORT, numbers, word
from synth.export.planners.rotations import quaternion
from synth.export.planners.urdf import in_comment, xml_bytes
from synth.geometry import Box, Sphere

if TYPE_CHECKING:
    from synth.arrays import FloatArray
    from synth.export.planners.description import Body, Description
    from synth.geometry import Solid

_STIFFNESS, _DAMPING = 400.0, 40.0  # N m/rad and N m s/rad, of the motors
_MARK = "0.004"  # m, radius of what marks a site
_FLOOR = "2 2 0.1"  # m, half the size of what is seen of the floor


def mjcf_bytes(description: Description) -> bytes:
    """Return the MJCF model of an arm in its task."""
    model = Element("mujoco", model=description.robot_name)
    for line in (*description.origin, description.nominal):
        model.append(Comment(f" {in_comment(line)} "))
    SubElement(model, "compiler", angle="radian", autolimits="true")
    SubElement(model, "option", integrator="implicitfast")
    world = SubElement(model, "worldbody")
    SubElement(world, "light", pos="0 0 3", dir="0 0 -1")
    _add_surroundings(world, description)
    _add_arm(world, description)
    contact = SubElement(model, "contact")
    SubElement(contact, "exclude", body1="base_link", body2="malleable_link")
    SubElement(contact, "exclude", body1="malleable_link", body2="rigid_link")
    actuators, keys = SubElement(model, "actuator"), SubElement(model, "keyframe")
    for joint, (lower, upper) in zip(
        ("joint1", "joint2"), description.solution.robot.joint_bounds.T, strict=True
    ):
        SubElement(
            actuators,
            "position",
            name=joint,
            joint=joint,
            kp=numbers(_STIFFNESS),
            kv=numbers(_DAMPING),
            ctrlrange=numbers([lower, upper]),
            forcerange=numbers([-EFFORT, EFFORT]),
        )
    for name, joints in description.postures.items():
        SubElement(keys, "key", name=name, qpos=numbers(joints), ctrl=numbers(joints))
    return xml_bytes(model)


def _add_surroundings(world: Element, description: Description) -> None:
    """Add targets, obstacles and floor, in the task frame."""
    task, base = description.task, description.solution.robot.base
    for name, position in zip(description.postures, task.table.positions, strict=False):
        SubElement(world, "site", name=f"target_{name}", pos=numbers(position), size=_MARK, rgba="1 0 0 1")
    for index, obstacle in enumerate(task.obstacles_from(base), 1):
        _add_solid(world, f"obstacle_{index}_{word(obstacle.name)}", obstacle.solid)
    if task.floor_in_base is not None:
        height = base.to_task([0.0, 0.0, task.floor_in_base])
        plane = {"name": "floor", "type": "plane", "size": _FLOOR}
        SubElement(world, "geom", {**plane, **_pose(height, base.rotation)})


def _add_solid(world: Element, name: str, solid: Solid) -> None:
    match solid:
        case Sphere():
            kind = {"type": "sphere", "pos": numbers(solid.centre), "size": numbers(solid.radius)}
        case Box():
            kind = {
                "type": "box",
                "pos": numbers(solid.centre),
                "size": numbers(0.5 * solid.size),
                "quat": numbers(quaternion(solid.axes)),
            }
        case _:
            kind = {"type": "capsule", "fromto": numbers(solid.ends), "size": numbers(solid.radius)}
            if np.array_equal(*solid.ends):
                kind = {"type": "sphere", "pos": numbers(solid.ends[0]), "size": numbers(solid.radius)}
    SubElement(world, "geom", {"name": name, "rgba": "0.6 0.6 0.6 1", **kind})


def _add_arm(world: Element, description: Description) -> None:
    """Add the bodies, one within the other, with their joints and sites."""
    arm, limits = description.solution.robot, description.task.robot.joint_limits
    base, malleable, rigid, tool = description.bodies
    rotation, end = description.link_end
    body = _add_body(world, base, arm.base.position, arm.base.rotation)
    _add_site(body, "P1", np.zeros(3))
    body = _add_body(body, malleable, np.zeros(3), np.eye(3))
    _add_hinge(body, "joint1", "0 0 1", [limits.base.lower, limits.base.upper])
    for name, point in zip(("P2", "P3", "P4"), arm.axis_points[1:], strict=True):
        _add_site(body, name, point)
    body = _add_body(body, rigid, end, rotation)
    _add_hinge(body, "joint2", "1 0 0", [limits.second.lower, limits.second.upper])
    body = _add_body(body, tool, description.tool, description.tool_rotation)
    _add_site(body, "P5", np.zeros(3))


def _add_hinge(body: Element, name: str, axis: str, span: list[float]) -> None:
    SubElement(body, "joint", name=name, type="hinge", axis=axis, range=numbers(span), damping="1")


def _add_site(body: Element, name: str, position: object) -> None:
    SubElement(body, "site", name=name, pos=numbers(position), size=_MARK)


def _pose(position: FloatArray, rotation: FloatArray) -> dict[str, str]:
    return {"pos": numbers(position), "quat": numbers(quaternion(rotation))}


def _add_body(parent: Element, body: Body, position: FloatArray, rotation: FloatArray) -> Element:
    # Its motors are taken to hold the arm up: nobody published how stiff they are.
    told = {"name": body.name, "gravcomp": "1", **_pose(position, rotation)}
    element = SubElement(parent, "body", told)
    inertia = body.inertia
    m = inertia.moments
    SubElement(
        element,
        "inertial",
        pos=numbers(inertia.centre),
        mass=numbers(inertia.mass),
        fullinertia=numbers([m[0, 0], m[1, 1], m[2, 2], m[0, 1], m[0, 2], m[1, 2]]),
    )
    pieces = body.pieces
    if pieces is not None:
        kind = "capsule" if pieces.rounded else "cylinder"
        for ends in pairwise(pieces.knees):
            SubElement(element, "geom", type=kind, fromto=numbers(ends), size=numbers(pieces.radius))
    return element
