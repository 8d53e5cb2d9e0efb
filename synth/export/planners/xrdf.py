"""XRDF 1.0, beside the URDF: spheres along the centreline, for planners that know nothing else (cuRobo)."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

from synth.export.planners.description import JERK
from synth.export.planners.pieces import rod_spheres, tube_spheres

if TYPE_CHECKING:
    from collections.abc import Iterator

    from synth.arrays import FloatArray
    from synth.export.planners.description import Description

_GEOMETRY = "spheres"


def xrdf_bytes(description: Description) -> bytes:
    """Return the XRDF of an arm, to be read together with its URDF."""
    return ("\n".join(_lines(description)) + "\n").encode()


def _lines(description: Description) -> Iterator[str]:
    for line in (*description.origin, description.nominal):
        yield f"# {line}"
    middle = description.solution.robot.joint_bounds.mean(axis=0).tolist()
    accelerations = description.task.robot.joint_rates.accelerations.tolist()
    names = [body.name for body in description.bodies]
    yield from (
        "format: xrdf",
        "format_version: 1.0",
        f"default_joint_positions: {{joint1: {middle[0]!r}, joint2: {middle[1]!r}}}",
        "cspace:",
        '  joint_names: ["joint1", "joint2"]',
        f"  acceleration_limits: {accelerations!r}",
        f"  jerk_limits: [{JERK!r}, {JERK!r}]",
        'tool_frames: ["tool0"]',
        "collision:",
        f"  geometry: {_GEOMETRY}",
        "self_collision:",
        f"  geometry: {_GEOMETRY}",
        "  ignore:",
        *(f'    {one}: ["{other}"]' for one, other in pairwise(names)),
        "geometry:",
        f"  {_GEOMETRY}:",
        "    spheres:",
    )
    arm, body = description.solution.robot, description.body
    p2 = arm.base_joint[1]
    yield from _spheres("base_link", *rod_spheres(p2, body.tube_radius))
    yield from _spheres("malleable_link", *tube_spheres(arm.shape, p2, body.tube_radius))
    yield from _spheres("rigid_link", *rod_spheres(description.tool, body.rod_radius))


def _spheres(name: str, centres: FloatArray, radius: float) -> Iterator[str]:
    yield f"      {name}:"
    for x, y, z in centres.tolist():
        yield f"        - {{center: [{x!r}, {y!r}, {z!r}], radius: {radius!r}}}"
