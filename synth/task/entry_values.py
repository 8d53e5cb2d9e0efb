"""From what a file holds, in its unit, to the values of a task, in metres and radians."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from synth.errors import InputError, Mistake
from synth.geometry import Box, Capsule, Sphere, roll_pitch_yaw, rotation_of
from synth.paths import Path
from synth.robot import (
    BaseChoices,
    BasePlaces,
    BasePose,
    BaseRange,
    Interval,
    LinkShape,
    Robot,
    link_to_pose,
    turned,
)
from synth.surfaces import Scan, Surface, TriangleMesh, plane_within
from synth.task.entry_types import BoxEntry, CapsuleEntry, SphereEntry, default_name, ends
from synth.task.hardware_distances import off_the_hardware
from synth.task.model import DEFAULT_TOLERANCE, Approach, Obstacle, PointTarget, Task, sampled
from synth.task.robot_values import to_interval
from synth.task.sizes import PER_METRE
from synth.task.surface_schema import turned_to

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from typing import TypeVar

    from synth.arrays import FloatArray
    from synth.geometry import Solid
    from synth.surfaces import Shape
    from synth.task.base_schema import BaseEntry, ChoiceEntry
    from synth.task.entry_types import SolidEntry
    from synth.task.path_schema import PathEntry
    from synth.task.schema import CurrentEntry, ObstacleEntry, TargetEntry, TaskFile
    from synth.task.surface_schema import SurfaceEntry

    _E = TypeVar("_E")
    _V = TypeVar("_V")


def to_task(
    file: TaskFile,
    robot: Robot,
    read: Mapping[int, FloatArray],
    waypoints: Mapping[int, FloatArray],
    name: str,
) -> Task:
    """Return the task of a file; `name` if it states none.

    Args:
        file: What the file holds.
        robot: The robot that it names or describes.
        read: Of the surfaces that files hold, by their number, the points, shape (n, 3), or the corners of
            triangles, shape (n, 3, 3), in the unit of the file.
        waypoints: Likewise of the paths whose waypoints files hold, shape (n, 3).
        name: What the task is called if it states no name.

    Raises:
        InputError: The values do not fit together; keys are those of the file.
    """
    per_metre = PER_METRE[file.length_unit]
    base, places = _to_base(file.base, per_metre)
    current = None if file.current is None else _to_shape(file.current, per_metre, robot, base)
    unit = file.length_unit
    surfaces = _entries(
        file.surface, "surface", lambda each, i, name: _to_surface(each, per_metre, unit, read.get(i), name)
    )
    paths = _entries(
        file.path, "path", lambda each, i, name: _to_path(each, per_metre, waypoints.get(i), name)
    )
    return Task(
        name=file.name or name,
        robot=robot,
        targets=sampled(surfaces, _targets(file, per_metre), paths),
        surfaces=surfaces,
        paths=paths,
        base=base,
        floor=file.floor / per_metre if isinstance(file.floor, float) else file.floor,
        topology=file.topology,
        objective=file.objective,
        obstacles=tuple(
            _to_obstacle(entry, per_metre, default_name("obstacle", index))
            for index, entry in enumerate(file.obstacles)
        ),
        current=current,
        places=places,
    )


def _to_base(entry: BaseEntry, per_metre: float) -> tuple[BasePose, BasePlaces | None]:
    """Return the pose of the base, and from which places it is to be chosen if it is not given."""
    if entry.choices:
        names = [choice.name or default_name("place", index) for index, choice in enumerate(entry.choices)]
        choices = BaseChoices(names, [_to_range(choice, per_metre).middle for choice in entry.choices])
        return choices.middle, choices
    places = _to_range(entry, per_metre)
    return places.middle, None if places.is_fixed else places


def _to_range(entry: BaseEntry | ChoiceEntry, per_metre: float) -> BaseRange:
    angles = entry.rpy_deg or [0.0, 0.0, entry.yaw_deg or 0.0]
    in_radians = (tuple(map(math.radians, ends(angle))) for angle in angles)
    return BaseRange(
        *(to_interval(coordinate, per_metre) for coordinate in entry.position),
        *(Interval(low, high) for low, high in in_radians),
    )


def _targets(file: TaskFile, per_metre: float) -> Sequence[PointTarget]:
    return tuple(
        _to_target(entry, per_metre, default_name("target", index))
        for index, entry in enumerate(file.targets or ())
    )


def _entries(given: _E | list[_E] | None, key: str, make: Callable[[_E, int, str], _V]) -> tuple[_V, ...]:
    """Return the values of one entry under a key, or of a list of them, with every mistake at its own key.

    Args:
        given: What stands under the key.
        key: The key.
        make: Returns the value of an entry, of its number and of what it is called if it states no name.
    """
    values, mistakes = [], []
    is_list = isinstance(given, list)
    for index, entry in enumerate(given if isinstance(given, list) else [given]):
        if not entry:
            continue
        name, at = (default_name(key, index), f"{key}[{index}]") if is_list else (key, key)
        try:
            values.append(make(entry, index, name))
        except InputError as error:
            mistakes += [Mistake(each.message, key=f"{at}.{each.key}") for each in error.mistakes]
    if mistakes:
        raise InputError(mistakes)
    return tuple(values)


def _to_path(entry: PathEntry, per_metre: float, read: FloatArray | None, name: str) -> Path:
    return Path(
        name=entry.name or name,
        waypoints=np.array(entry.waypoints if read is None else read) / per_metre,
        closed=entry.closed,
        interpolation=entry.interpolation,
        tolerance=DEFAULT_TOLERANCE if entry.tolerance is None else entry.tolerance / per_metre,
        speed=None if entry.speed is None else entry.speed / per_metre,
    )


def _to_surface(
    entry: SurfaceEntry, per_metre: float, unit: str, read: FloatArray | None, name: str
) -> Surface:
    """Return a surface; of what a file holds the numbers are in a unit of its own, if it states one."""
    position, frame = np.zeros(3), np.eye(3)
    region = tuple(_to_solid(each, per_metre) for each in entry.region or ())
    pose = rotation_of(*np.radians(entry.pose.rpy_deg))
    moved = np.array(entry.pose.position) / per_metre
    if read is not None:
        lengths = read / PER_METRE[unit if entry.length_unit is None else entry.length_unit]
        shape: Shape = TriangleMesh(lengths) if lengths.ndim == 3 else Scan(lengths)
    elif entry.kind == "plane":
        frame = turned_to(np.array(entry.plane.normal))
        point = pose @ (np.array(entry.plane.point) / per_metre) + moved
        shape, middle = plane_within(point, pose @ frame, region)
        position = pose.T @ (middle - moved)
    else:
        shape, position, frame = getattr(entry, entry.kind).placed(per_metre)
    return Surface(
        name=entry.name or name,
        shape=shape,
        tolerance=DEFAULT_TOLERANCE if entry.tolerance is None else entry.tolerance / per_metre,
        coverage=entry.coverage,
        position=pose @ position + moved,
        rpy=np.array(roll_pitch_yaw(pose @ frame)),
        region=region,
        margin=0.0 if entry.margin is None else entry.margin / per_metre,
    )


def _to_target(entry: TargetEntry, per_metre: float, name: str) -> PointTarget:
    return PointTarget(
        name=entry.name or name,
        position=np.array(entry.position) / per_metre,
        tolerance=DEFAULT_TOLERANCE if entry.tolerance is None else entry.tolerance / per_metre,
        weight=entry.weight,
        approach=None
        if entry.approach is None
        else Approach(np.array(entry.approach.direction), math.radians(entry.approach.tolerance_deg)),
    )


def _to_obstacle(entry: ObstacleEntry, per_metre: float, name: str) -> Obstacle:
    return Obstacle(entry.name or name, _to_solid(entry, per_metre))


def _to_solid(entry: SolidEntry, per_metre: float) -> Solid:
    match entry.solid:
        case SphereEntry(center=center, radius=radius):
            return Sphere(np.array(center) / per_metre, radius / per_metre)
        case BoxEntry(center=center, size=size, yaw_deg=yaw):
            return Box(np.array(center) / per_metre, np.array(size) / per_metre, math.radians(yaw))
        case CapsuleEntry(from_=start, to=end, radius=radius):
            return Capsule(np.array([start, end]) / per_metre, radius / per_metre)


def _to_shape(entry: CurrentEntry, per_metre: float, robot: Robot, base: BasePose) -> LinkShape:
    """Return the present shape of the link.

    Of markers the direction counts, and where the link's end is by it; how far they are apart only says
    whether they are those of this robot.

    Raises:
        InputError: The markers are not those of this robot, or no shape of its link is found that has them.
    """
    if entry.arcs:
        curvatures = np.array([arc.curvature for arc in entry.arcs]) * per_metre
        return LinkShape(curvatures, np.array([arc.length for arc in entry.arcs]) / per_metre)
    markers = np.array([entry.markers.P3, entry.markers.P4]) / per_metre
    p3, p4 = turned(base.to_base(markers), np.asarray(-math.radians(entry.markers.joint1_deg)))
    apart = float(np.linalg.norm(p4 - p3))
    for wrong in off_the_hardware({"d34": apart}, robot).values():
        raise InputError([Mistake(wrong, key="current.markers")])
    along = (p4 - p3) / max(apart, 1e-12)
    end = p3 + robot.tip_offset * along - np.array([0.0, 0.0, robot.d12])
    shape = link_to_pose(robot.link, end, along, theta1=Interval.fixed(0.0))
    if shape is None:
        sentence = "no shape of this robot's link was found that puts P3 and P4 there"
        raise InputError([Mistake(sentence, key="current.markers")])
    return shape
