"""Tasks and robots from files: read once, checked strictly, every mistake at once.

Beyond this module a task is frozen values in metres and radians, never a mapping.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from synth.errors import InputError
from synth.geometry import Box, Capsule
from synth.robot import (
    PRESETS,
    BasePose,
    Interval,
    JointLimits,
    LinkShape,
    MalleableLink,
    RigidLink,
    Robot,
    link_to_pose,
    turned,
)
from synth.task.document import Document
from synth.task.model import DEFAULT_TOLERANCE, Obstacle, PointTarget, TargetTable, Task
from synth.task.points_file import read_points
from synth.task.schema import (
    SURFACES_TO_COME,
    BoxEntry,
    CapsuleEntry,
    CurrentEntry,
    ObstacleEntry,
    RobotEntry,
    RobotFile,
    SphereEntry,
    SurfaceTaskFile,
    TargetEntry,
    TaskFile,
    ends,
)
from synth.task.wording import did_you_mean, validate
from synth.task.yaml_text import read_file, read_text

if TYPE_CHECKING:
    import os
    from collections.abc import Mapping, Sequence

    from synth.arrays import FloatArray
    from synth.geometry import Solid

PER_METRE = {"mm": 1000.0, "cm": 100.0, "m": 1.0}  # to divide by: 455 / 1000 is 0.455 exactly
_ROBOT_FILES = {".yaml", ".yml", ".json"}


def load_task(path: str | os.PathLike[str]) -> Task:
    """Read a task file.

    Args:
        path: The file; a robot file that it names is looked for beside it.

    Returns:
        The task in metres and radians; its name is that of the file if it states none.

    Raises:
        InputError: The file, or the robot file it names, cannot be read or is wrong; with every
            mistake, in the order of the file.
    """
    path = Path(path)
    return _task(read_file(path), directory=path.parent, name=path.stem)


def parse_task(
    source: str | Mapping[str, object], *, directory: str | os.PathLike[str] = ".", name: str = "task"
) -> Task:
    """Read a task from a YAML text or from a mapping with the same keys.

    Args:
        source: The text or the mapping; it states its `length_unit` as a file does. A mapping may
            hold tuples and arrays for lists.
        directory: Where a robot file that it names is looked for.
        name: What the task is called if it states no name.

    Returns:
        The task in metres and radians.

    Raises:
        InputError: As `load_task`; mistakes name no file and, in a mapping, no line.
    """
    document = read_text(source) if isinstance(source, str) else Document.from_mapping(source)
    return _task(document, directory=Path(directory), name=name)


def load_robot(path: str | os.PathLike[str]) -> Robot:
    """Read a robot file.

    Args:
        path: The file.

    Returns:
        The robot in metres and radians; its name is that of the file if it states none.

    Raises:
        InputError: The file cannot be read or is wrong; with every mistake, in the order of the file.
    """
    path = Path(path)
    return _robot(read_file(path), name=path.stem)


def _robot(document: Document, name: str) -> Robot:
    """Read a robot file's document."""
    if isinstance(document.value, dict) and {"synth", "targets"} & document.value.keys():
        document.report((), "is a task file, but a robot file is expected")
        raise document.error()
    entry = validate(document, RobotFile)
    if entry is None or document.is_wrong:
        raise document.error()
    return to_robot(entry, PER_METRE[entry.length_unit], name)


def _task(document: Document, directory: Path, name: str) -> Task:
    """Read a task's document; the robot and the names are checked even where the rest is wrong."""
    content = document.value if isinstance(document.value, dict) else {}
    reference = content.get("robot")
    robot = named_robot(document, reference, directory) if isinstance(reference, str) else None
    for key, kind in (("targets", "target"), ("obstacles", "obstacle")):
        _report_names_given_twice(document, key, kind, content.get(key))
    scan = _scan(document, content["surface"], directory) if "surface" in content else None
    file = validate(document, SurfaceTaskFile if "surface" in content else TaskFile)
    if file is None or document.is_wrong:
        raise document.error()
    per_metre = PER_METRE[file.length_unit]
    if isinstance(file.robot, RobotEntry):
        unit = file.length_unit if file.robot.length_unit is None else file.robot.length_unit
        robot = to_robot(file.robot, PER_METRE[unit], "inline robot")
    assert robot is not None, "a robot is named or described"  # noqa: S101 - for the type checker
    base = BasePose(np.array(file.base.position) / per_metre, math.radians(file.base.yaw_deg))
    current = None if file.current is None else _to_shape(file.current, per_metre, robot, base)
    if file.current is not None and current is None:
        sentence = "no shape of this robot's link was found that puts P3 and P4 there"
        document.report(("current", "markers"), sentence)
        raise document.error()
    return Task(
        name=file.name or name,
        robot=robot,
        targets=_targets(file, scan, per_metre),
        base=base,
        floor=None if file.floor is None else file.floor / per_metre,
        topology=file.topology,
        objective=file.objective,
        obstacles=tuple(
            _to_obstacle(entry, per_metre, _default_name("obstacle", index))
            for index, entry in enumerate(file.obstacles)
        ),
        current=current,
    )


def _scan(document: Document, surface: object, directory: Path) -> FloatArray | None:
    """Return the points of a surface's file in its unit, or None with the mistakes reported."""
    entry = surface if isinstance(surface, dict) else {}
    if isinstance(surface, dict) and not entry.keys() & {"points", *SURFACES_TO_COME}:
        document.report(("surface",), "must name a file of points: {points: file.csv}")
    file = entry.get("points")
    if isinstance(file, str) and file:
        try:
            return read_points(directory / file)
        except InputError as error:
            for mistake in error.mistakes:
                document.adopt(("surface", "points"), mistake)
    return None


def _targets(file: TaskFile, scan: FloatArray | None, per_metre: float) -> Sequence[PointTarget]:
    """Return the targets, and behind them the points of a surface."""
    targets = tuple(
        _to_target(entry, per_metre, _default_name("target", index))
        for index, entry in enumerate(file.targets or ())
    )
    if scan is None:
        return targets
    given, count = file.surface.tolerance, len(scan)
    tolerance = DEFAULT_TOLERANCE if given is None else given / per_metre
    names = tuple(f"surface point {number}" for number in range(1, count + 1))
    points = TargetTable(names, scan / per_metre, np.full(count, tolerance), np.ones(count))
    return TargetTable.of(targets).followed_by(points)


def named_robot(document: Document, reference: str, directory: Path) -> Robot | None:
    """Return a preset or the robot of a file, or None with the mistakes reported."""
    if reference in PRESETS:
        return PRESETS[reference]
    is_path = "/" in reference or Path(reference).suffix.lower() in _ROBOT_FILES
    if not (is_path and reference.isprintable()):
        known = did_you_mean(reference, PRESETS) or f"; presets are {', '.join(PRESETS)}"
        document.report(
            ("robot",), f"{reference[:40]!r} is neither a preset nor the path of a YAML file{known}"
        )
        return None
    try:
        return load_robot(directory / reference)
    except InputError as error:
        for mistake in error.mistakes:
            if mistake.line is None:  # not a place in that file, but the file itself
                document.report(("robot",), f"{mistake.file}: {mistake.message}")
            else:
                document.adopt(("robot",), mistake)
    return None


def _report_names_given_twice(document: Document, key: str, kind: str, entries: object) -> None:
    first: dict[str, int] = {}
    for index, entry in enumerate(entries if isinstance(entries, list) else []):
        name = entry.get("name", _default_name(kind, index)) if isinstance(entry, dict) else None
        if not isinstance(name, str):
            continue
        if first.setdefault(name, index) != index:
            message = f"{name[:40]!r} is the name of {key}[{first[name]}] already"
            document.report((key, index, "name"), message)


def _default_name(kind: str, index: int) -> str:
    return f"{kind} {index + 1}"


def _to_target(entry: TargetEntry, per_metre: float, name: str) -> PointTarget:
    return PointTarget(
        name=entry.name or name,
        position=np.array(entry.position) / per_metre,
        tolerance=DEFAULT_TOLERANCE if entry.tolerance is None else entry.tolerance / per_metre,
        weight=entry.weight,
    )


def _to_obstacle(entry: ObstacleEntry, per_metre: float, name: str) -> Obstacle:
    solid: Solid
    match entry.solid:
        case SphereEntry(center=center, radius=radius):
            solid = Capsule.sphere(np.array(center) / per_metre, radius / per_metre)
        case BoxEntry(center=center, size=size, yaw_deg=yaw):
            solid = Box(np.array(center) / per_metre, np.array(size) / per_metre, math.radians(yaw))
        case CapsuleEntry(from_=start, to=end, radius=radius):
            solid = Capsule(np.array([start, end]) / per_metre, radius / per_metre)
    return Obstacle(entry.name or name, solid)


def _to_shape(entry: CurrentEntry, per_metre: float, robot: Robot, base: BasePose) -> LinkShape | None:
    """Return the present shape of the link; None if none is found that has the markers.

    Of markers the direction counts, and where the link's end is by it; not how far apart they are.
    """
    if entry.arcs:
        curvatures = np.array([arc.curvature for arc in entry.arcs]) * per_metre
        return LinkShape(curvatures, np.array([arc.length for arc in entry.arcs]) / per_metre)
    markers = np.array([entry.markers.P3, entry.markers.P4]) / per_metre
    p3, p4 = turned(base.to_base(markers), np.asarray(-math.radians(entry.markers.joint1_deg)))
    along = (p4 - p3) / max(float(np.linalg.norm(p4 - p3)), 1e-12)
    end = p3 + robot.tip_offset * along - np.array([0.0, 0.0, robot.d12])
    return link_to_pose(robot.link, end, along, theta1=Interval.fixed(0.0))


def to_robot(entry: RobotEntry, per_metre: float, name: str) -> Robot:
    """Return the robot that an entry describes; `name` if it states none."""
    link, limits, full = entry.link, entry.joint_limits_deg, JointLimits()
    tip_offset = 0.5 * entry.d34 if entry.tip_offset is None else entry.tip_offset
    bend = link.max_total_bend_deg
    return Robot(
        name=entry.name or name,
        d12=entry.d12 / per_metre,
        link=MalleableLink(
            length=_interval(link.length, per_metre),
            min_bend_radius=link.min_bend_radius / per_metre,
            diameter=(link.diameter or 0.0) / per_metre,
            max_total_bend=math.inf if bend is None else math.radians(bend),
        ),
        d34=entry.d34 / per_metre,
        tip_offset=tip_offset / per_metre,
        rigid_link=RigidLink(
            _interval(entry.rigid_link.d35, per_metre),
            _interval(entry.rigid_link.d45, per_metre),
            (entry.rigid_link.diameter or 0.0) / per_metre,
        ),
        joint_limits=JointLimits(
            base=full.base if limits.base is None else _radians(limits.base),
            second=full.second if limits.second is None else _radians(limits.second),
        ),
    )


def _interval(value: float | list[float], per_metre: float) -> Interval:
    low, high = ends(value)
    return Interval(low / per_metre, high / per_metre)


def _radians(limits: list[float]) -> Interval:
    return Interval(math.radians(limits[0]), math.radians(limits[1]))
