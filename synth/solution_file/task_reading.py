"""From what a solution file holds of a task to the values of a task."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from synth.errors import InputError
from synth.geometry import Box, Capsule, Sphere
from synth.paths import Path
from synth.robot import (
    BaseChoices,
    BasePose,
    BaseRange,
    Interval,
    JointLimits,
    JointRates,
    LinkShape,
    MalleableLink,
    RigidLink,
    RigidLinkChoices,
    Robot,
)
from synth.solution_file.task_schema import BoxPart, SpherePart
from synth.surfaces import Scan, Surface
from synth.task import Floor, Obstacle, TargetTable, Task

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from typing import TypeVar

    from synth.arrays import FloatArray
    from synth.files import Document, KeyPath
    from synth.geometry import Solid
    from synth.robot import BasePlaces
    from synth.solution_file.task_schema import (
        ArcPart,
        BasePart,
        ObstaclePart,
        PathPart,
        PlacesPart,
        ReleasedTaskPart,
        RigidLinkLimits,
        RobotPart,
        SurfacePart,
        TargetPart,
    )

    _T = TypeVar("_T")


def made(document: Document, path: KeyPath, make: Callable[[], _T]) -> _T | None:
    """Return what is made of a part of a document, or None with the mistakes reported at the part's path."""
    try:
        return make()
    except InputError as error:
        document.refuse(error, path)
        return None


def to_task(
    document: Document, path: KeyPath, read: ReleasedTaskPart, targets: TargetTable | None = None
) -> Task | None:
    """Return the task that a document holds, or None with the mistakes reported.

    Args:
        document: The document.
        path: Where in it the task stands.
        read: What stands there.
        targets: Those of a task whose targets are not in the file.
    """
    robot = made(document, (*path, "robot"), lambda: _robot(read.robot))
    obstacles = [
        made(document, (*path, "obstacles", index), lambda each=each: Obstacle(each.name, _solid(each)))  # type: ignore[misc]
        for index, each in enumerate(read.obstacles)
    ]
    current = read.current
    shape = made(document, (*path, "current"), lambda: None if current is None else to_shape(current.arcs))
    table = made(document, path, lambda: targets if read.targets is None else _targets(read.targets))
    given = table
    surfaces = made(document, (*path, "surfaces"), lambda: _surfaces(read.surfaces, given))
    paths = [
        made(document, (*path, "paths", index), lambda each=each: _path(each))  # type: ignore[misc]
        for index, each in enumerate(read.paths)
    ]
    base = made(document, (*path, "base"), lambda: to_base(read.base))
    if robot is None or base is None or table is None or surfaces is None or document.is_wrong:
        return None
    followed = tuple(each for each in paths if each is not None)
    return made(
        document,
        path,
        lambda: Task(
            name=read.name,
            robot=robot,
            targets=_as_samples(table, surfaces, followed),
            surfaces=surfaces,
            paths=followed,
            base=base,
            floor=Floor.AT_BASE if read.floor_at_base else read.floor,
            topology=read.topology,
            objective=read.objective,
            obstacles=tuple(each for each in obstacles if each is not None),
            current=shape,
            places=None if read.places is None else _places(read.places),
        ),
    )


def _surfaces(read: Sequence[SurfacePart], table: TargetTable | None) -> tuple[Surface, ...]:
    """Return surfaces by their samples; between these they are not known from a file."""
    if table is None:
        return ()
    parts = [(each, slice(each.first, each.first + each.samples)) for each in read]
    return tuple(
        Surface(each.name, Scan(table.positions[part], _areas(table, part)), each.tolerance, each.coverage)
        for each, part in parts
    )


def _areas(table: TargetTable, part: slice) -> FloatArray | None:
    """Return what each of some samples stands for; None where they are alike, as those of a scan are."""
    weights = table.weights[part]
    return None if np.all(weights == 1.0) else weights


def _path(read: PathPart) -> Path:
    return Path(
        read.name, np.array(read.waypoints), read.closed, read.interpolation, read.tolerance, read.speed
    )


def _as_samples(table: TargetTable, surfaces: Sequence[Surface], paths: Sequence[Path]) -> TargetTable:
    """Return targets the last of which are the samples of surfaces, then of paths, in order."""
    count = sum(len(surface.samples) for surface in surfaces) + sum(len(path.samples) for path in paths)
    own = len(table) - count
    if not count or own < 0:
        return table
    return replace(table, samples=np.concatenate([np.full(own, -1), np.arange(count)]))


def to_base(read: BasePart) -> BasePose:
    """Return where the robot stands."""
    return BasePose(np.array(read.position), read.yaw, read.pitch, read.roll)


def _places(read: PlacesPart) -> BasePlaces:
    """Return where the base could be made to stand."""
    if read.poses is not None:
        return BaseChoices(read.names or (), [to_base(pose) for pose in read.poses])
    given = {key: getattr(read, key) for key in ("x", "y", "z", "roll", "pitch", "yaw")}
    return BaseRange(
        **{key: Interval(each.lower, each.upper) for key, each in given.items() if each is not None}
    )


def to_shape(arcs: Sequence[ArcPart]) -> LinkShape:
    """Return the shape of the link that has these arcs."""
    return LinkShape(np.array([arc.curvature for arc in arcs]), np.array([arc.length for arc in arcs]))


def _targets(read: Sequence[TargetPart]) -> TargetTable:
    return TargetTable(
        tuple(target.name for target in read),
        np.array([target.position for target in read]),
        np.array([target.tolerance for target in read]),
        np.array([target.weight for target in read]),
        _approaches(read),
    )


def _approaches(read: Sequence[TargetPart]) -> FloatArray | None:
    """Return the directions of arrival, a row of NaN where there is none; None if there are none at all."""
    if not any(target.approach for target in read):
        return None
    none = [math.nan] * 4
    rows = [
        none if each is None else [*each.direction, each.tolerance] for each in (t.approach for t in read)
    ]
    return np.array(rows)


def _robot(read: RobotPart) -> Robot:
    link, several, limits, rates = read.link, read.rigid_links, read.joint_limits, read.joint_rates
    most = math.inf if link.max_total_bend is None else link.max_total_bend
    return Robot(
        name=read.name,
        d12=read.d12,
        link=MalleableLink(Interval(*link.length), link.min_bend_radius, link.diameter, most),
        d34=read.d34,
        tip_offset=read.tip_offset,
        rigid_link=_rigid_link(read.rigid_link),
        rigid_links=None
        if several is None
        else RigidLinkChoices(several.names, [_rigid_link(link) for link in several.links]),
        joint_limits=JointLimits(Interval(*limits.base), Interval(*limits.second)),
        joint_rates=JointRates() if rates is None else JointRates(rates.speeds, rates.accelerations),
    )


def _rigid_link(read: RigidLinkLimits) -> RigidLink:
    return RigidLink(Interval(*read.d35), Interval(*read.d45), read.diameter)


def _solid(read: ObstaclePart) -> Solid:
    match read.solid:
        case SpherePart(center=center, radius=radius):
            return Sphere(np.array(center), radius)
        case BoxPart() as box:
            return Box(np.array(box.center), np.array(box.size), box.yaw, box.pitch, box.roll)
        case capsule:
            return Capsule(np.array([capsule.start, capsule.end]), capsule.radius)
