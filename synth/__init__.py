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
    from synth.errors import GeometryError, InputError, Mistake, SolverError, SynthError, TimeLimitError
    from synth.export import (
        casadi_kinematics,
        kinematics_c_code,
        solution_to_json,
        write_files,
        write_planner_files,
    )
    from synth.geometry import Box, Capsule, Category, Invariants, Sphere, WorkspaceSurface
    from synth.guide import Guide, make_guide
    from synth.measurement import Inspection, Measurement, inspect, load_measurements
    from synth.paths import Interpolation, Path
    from synth.robot import (
        PRESETS,
        Arm,
        BaseChoices,
        BasePose,
        BaseRange,
        Interval,
        JointBranches,
        JointLimits,
        JointRates,
        LinkShape,
        MalleableLink,
        RigidLink,
        RigidLinkChoices,
        Robot,
        SurfaceMesh,
        Workspace,
        keeps_clear,
        link_to_pose,
        links_to_poses,
        why_no_link,
    )

    # isort: split - else mypy takes `solve` for the module that it stands in
    from synth.solution_file import load_solution, solution_from_json, solution_schema
    from synth.surfaces import Profile, Rectangle, Revolved, Scan, Surface, TriangleMesh
    from synth.sweep import SweepProgress, TaskOutcome, solve_many
    from synth.synthesis import (
        Bound,
        Design,
        Figures,
        Forgiveness,
        Margins,
        Motion,
        NotFoundError,
        Progress,
        Release,
        Solution,
        Status,
        TargetResult,
        Timing,
        Verification,
        Violation,
        explain,
        motions,
        solve,
        verify,
    )
    from synth.task import (
        Approach,
        Floor,
        Objective,
        Obstacle,
        PointTarget,
        TargetTable,
        Task,
        Topology,
        load_robot,
        load_task,
        parse_task,
        robot_schema,
        sampled,
        task_schema,
    )
    from synth.trajectories import Trajectory, trajectory

_ROOMS = {
    "errors": "GeometryError InputError Mistake SolverError SynthError TimeLimitError",
    "export": "casadi_kinematics kinematics_c_code solution_to_json write_files write_planner_files",
    "geometry": "Box Capsule Category Invariants Sphere WorkspaceSurface",
    "guide": "Guide make_guide",
    "measurement": "Inspection Measurement inspect load_measurements",
    "paths": "Interpolation Path",
    "robot": (
        "PRESETS Arm BaseChoices BasePose BaseRange Interval JointBranches JointLimits JointRates "
        "LinkShape MalleableLink RigidLink RigidLinkChoices Robot SurfaceMesh Workspace keeps_clear "
        "link_to_pose links_to_poses why_no_link"
    ),
    "solution_file": "load_solution solution_from_json solution_schema",
    "surfaces": "Profile Rectangle Revolved Scan Surface TriangleMesh",
    "sweep": "TaskOutcome SweepProgress solve_many",
    "synthesis": (
        "Bound Design Figures Forgiveness Margins Motion NotFoundError Progress Release Solution Status "
        "TargetResult Timing Verification Violation explain motions solve verify"
    ),
    "task": (
        "Approach Floor Objective Obstacle PointTarget TargetTable Task Topology load_robot load_task "
        "parse_task robot_schema sampled task_schema"
    ),
    "trajectories": "Trajectory trajectory",
}
_ROOM_OF = {name: room for room, names in _ROOMS.items() for name in names.split()}

__all__ = [
    "PRESETS",
    "Approach",
    "Arm",
    "BaseChoices",
    "BasePose",
    "BaseRange",
    "Bound",
    "Box",
    "Capsule",
    "Category",
    "Design",
    "Figures",
    "Floor",
    "Forgiveness",
    "GeometryError",
    "Guide",
    "InputError",
    "Inspection",
    "Interpolation",
    "Interval",
    "Invariants",
    "JointBranches",
    "JointLimits",
    "JointRates",
    "LinkShape",
    "MalleableLink",
    "Margins",
    "Measurement",
    "Mistake",
    "Motion",
    "NotFoundError",
    "Objective",
    "Obstacle",
    "Path",
    "PointTarget",
    "Profile",
    "Progress",
    "Rectangle",
    "Release",
    "Revolved",
    "RigidLink",
    "RigidLinkChoices",
    "Robot",
    "Scan",
    "Solution",
    "SolverError",
    "Sphere",
    "Status",
    "Surface",
    "SurfaceMesh",
    "SweepProgress",
    "SynthError",
    "TargetResult",
    "TargetTable",
    "Task",
    "TaskOutcome",
    "TimeLimitError",
    "Timing",
    "Topology",
    "Trajectory",
    "TriangleMesh",
    "Verification",
    "Violation",
    "Workspace",
    "WorkspaceSurface",
    "__version__",
    "casadi_kinematics",
    "explain",
    "inspect",
    "keeps_clear",
    "kinematics_c_code",
    "link_to_pose",
    "links_to_poses",
    "load_measurements",
    "load_robot",
    "load_solution",
    "load_task",
    "make_guide",
    "motions",
    "parse_task",
    "robot_schema",
    "sampled",
    "solution_from_json",
    "solution_schema",
    "solution_to_json",
    "solve",
    "solve_many",
    "task_schema",
    "trajectory",
    "verify",
    "why_no_link",
    "write_files",
    "write_planner_files",
]


def __getattr__(name: str) -> object:
    """Import a public name from its room on first use (PEP 562)."""
    if name not in _ROOM_OF:
        raise AttributeError(f"module 'synth' has no attribute {name!r}")
    return getattr(importlib.import_module(f"synth.{_ROOM_OF[name]}"), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
