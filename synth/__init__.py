"""Topology synthesis for malleable robots: from target points to a verified link shape and a guide.

    import synth

    solution = synth.solve(synth.load_task("task.yaml"))
    solution.found, solution.targets[0].miss, solution.robot.inverse_kinematics(point)

Everything is in metres and radians. Names are imported when they are first used, so that the command
line answers at once.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

from synth.version import __version__

if TYPE_CHECKING:
    from synth.errors import GeometryError, InputError, Mistake, SolverError, SynthError
    from synth.export import solution_to_json, write_files
    from synth.geometry import Box, Capsule, Sphere
    from synth.guide import Guide, make_guide
    from synth.robot import (
        PRESETS,
        Arm,
        BaseChoices,
        BasePose,
        BaseRange,
        Interval,
        JointLimits,
        LinkShape,
        MalleableLink,
        RigidLink,
        Robot,
        Workspace,
        link_to_pose,
        links_to_poses,
        why_no_link,
    )
    from synth.synthesis import NotFoundError, Solution, Status, explain, motions, solve, verify
    from synth.task import (
        Approach,
        Objective,
        Obstacle,
        PointTarget,
        TargetTable,
        Task,
        Topology,
        load_robot,
        load_task,
        parse_task,
    )

_ROOMS = {
    "errors": ("GeometryError", "InputError", "Mistake", "SolverError", "SynthError"),
    "export": ("solution_to_json", "write_files"),
    "geometry": ("Box", "Capsule", "Sphere"),
    "guide": ("Guide", "make_guide"),
    "robot": (
        "PRESETS",
        "Arm",
        "BaseChoices",
        "BasePose",
        "BaseRange",
        "Interval",
        "JointLimits",
        "LinkShape",
        "MalleableLink",
        "RigidLink",
        "Robot",
        "Workspace",
        "link_to_pose",
        "links_to_poses",
        "why_no_link",
    ),
    "synthesis": ("NotFoundError", "Solution", "Status", "explain", "motions", "solve", "verify"),
    "task": (
        "Approach",
        "Objective",
        "Obstacle",
        "PointTarget",
        "TargetTable",
        "Task",
        "Topology",
        "load_robot",
        "load_task",
        "parse_task",
    ),
}
_ROOM_OF = {name: room for room, names in _ROOMS.items() for name in names}

__all__ = [
    "PRESETS",
    "Approach",
    "Arm",
    "BaseChoices",
    "BasePose",
    "BaseRange",
    "Box",
    "Capsule",
    "GeometryError",
    "Guide",
    "InputError",
    "Interval",
    "JointLimits",
    "LinkShape",
    "MalleableLink",
    "Mistake",
    "NotFoundError",
    "Objective",
    "Obstacle",
    "PointTarget",
    "RigidLink",
    "Robot",
    "Solution",
    "SolverError",
    "Sphere",
    "Status",
    "SynthError",
    "TargetTable",
    "Task",
    "Topology",
    "Workspace",
    "__version__",
    "explain",
    "link_to_pose",
    "links_to_poses",
    "load_robot",
    "load_task",
    "make_guide",
    "motions",
    "parse_task",
    "solution_to_json",
    "solve",
    "verify",
    "why_no_link",
    "write_files",
]


def __getattr__(name: str) -> object:
    """Import a public name from its room on first use (PEP 562)."""
    if name not in _ROOM_OF:
        raise AttributeError(f"module 'synth' has no attribute {name!r}")
    return getattr(importlib.import_module(f"synth.{_ROOM_OF[name]}"), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
