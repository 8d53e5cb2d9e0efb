"""What is exported of a solution: the files of each kind, by name."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING

from synth.export.planners.description import Description
from synth.export.planners.dh import dh_parameters
from synth.export.planners.mesh_files import glb_bytes, obj_bytes, ply_bytes, stl_bytes
from synth.export.planners.mjcf import mjcf_bytes
from synth.export.planners.pieces import tube_mesh
from synth.export.planners.symbolic import kinematics_c_code
from synth.export.planners.urdf import TUBE, srdf_bytes, urdf_bytes
from synth.export.planners.xrdf import xrdf_bytes
from synth.robot import Workspace
from synth.trajectories import has_trajectory, trajectory

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from synth.synthesis import Solution

_SPACING = math.radians(3.0)  # of the mesh of a workspace, in each joint


def kinds_of(solution: Solution) -> tuple[str, ...]:
    """Return the kinds of files that there can be of a solution: where ways are missing no trajectory."""
    has_one = has_trajectory(solution)
    return tuple(kind for kind in KINDS if has_one or kind != "trajectory")


def planner_files(solution: Solution, kinds: Iterable[str]) -> dict[str, bytes]:
    """Return the files of a solution for planners and simulators.

    Args:
        solution: A solution that holds a shape.
        kinds: Which, of `KINDS`.

    Returns:
        Their contents by their names.

    Raises:
        NotFoundError: There is no shape.
    """
    description = Description(solution)
    solution.best  # noqa: B018 - raises where there is none
    return {name: content for kind in kinds for name, content in KINDS[kind](description).items()}


def _urdf(description: Description) -> dict[str, bytes]:
    arm = description.solution.robot
    tube = tube_mesh(arm.shape, arm.base_joint[1], description.body.tube_radius)
    return {"robot.urdf": urdf_bytes(description), TUBE: obj_bytes(tube, description.origin)}


def _mesh(description: Description) -> dict[str, bytes]:
    workspace = Workspace.within_limits(description.solution.robot)
    mesh = workspace.mesh(_SPACING, description.task.floor_in_base)
    title = f"synth, metres: {description.origin[0]}"
    return {
        "workspace.stl": stl_bytes(mesh, mesh.faces, title),
        "workspace_reachable.stl": stl_bytes(mesh, mesh.faces[mesh.reachable], title),
        "workspace.ply": ply_bytes(mesh, description.origin),
        "workspace.glb": glb_bytes(mesh, description.origin),
    }


def _dh(description: Description) -> dict[str, bytes]:
    content = {"source": list(description.origin), **dh_parameters(description.solution.robot)}
    return {"dh.json": (json.dumps(content, indent=1) + "\n").encode()}


def _c(description: Description) -> dict[str, bytes]:
    said = "".join(f"// {line}\n" for line in description.origin)
    return {"kinematics.c": (said + kinematics_c_code(description.solution.robot)).encode()}


def _trajectory(description: Description) -> dict[str, bytes]:
    path = trajectory(description.solution)
    content = {"source": list(description.origin), **path.to_json()}
    text = json.dumps(content) + "\n"
    return {"trajectory.csv": path.to_csv().encode(), "trajectory.json": text.encode()}


KINDS: Mapping[str, Callable[[Description], dict[str, bytes]]] = {
    "urdf": _urdf,
    "srdf": lambda description: {"robot.srdf": srdf_bytes(description)},
    "mjcf": lambda description: {"robot.xml": mjcf_bytes(description)},
    "xrdf": lambda description: {"robot.xrdf": xrdf_bytes(description)},
    "mesh": _mesh,
    "dh": _dh,
    "c": _c,
    "trajectory": _trajectory,
}
