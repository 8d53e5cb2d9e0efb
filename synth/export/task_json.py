"""The task inside `solution.json`: whole, with its robot as read, in metres and radians.

The keys are those of the task file, without a unit in their names: with them a solution can be loaded and
verified again with no other file.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from synth.export.json_data import Plain
from synth.geometry import Box
from synth.task import Floor

if TYPE_CHECKING:
    from collections.abc import Iterator

    from synth.paths import Path
    from synth.robot import Interval, LinkShape, RigidLink, Robot
    from synth.task import Obstacle, TargetTable, Task


def task_to_json(task: Task) -> dict[str, object]:
    """Return a task as data for `plain`: arrays, mappings and numbers, every default written out."""
    return {
        "name": task.name,
        "robot": _robot(task.robot),
        "base": task.base,
        "places": task.places,
        "floor": task.floor_height,
        "floor_at_base": isinstance(task.floor, Floor),
        "topology": task.topology.value,
        "objective": task.objective.value,
        "targets": Plain(targets_asked_for(task.table)),
        "surfaces": _surfaces(task),
        "paths": [_path(path) for path in task.paths],
        "obstacles": [_obstacle(obstacle) for obstacle in task.obstacles],
        "current": None if task.current is None else {"arcs": arcs_to_json(task.current)},
    }


def targets_asked_for(table: TargetTable) -> Iterator[dict[str, object]]:
    """Yield each target as a task has it; of a million points read from columns."""
    columns = (table.positions, table.tolerances, table.weights)
    rows = zip(table.names, *(column.tolist() for column in columns), _approaches(table), strict=True)
    for name, position, tolerance, weight, approach in rows:
        yield {"name": name, "position": position, "tolerance": tolerance, "weight": weight} | approach


def _approaches(table: TargetTable) -> list[dict[str, object]]:
    """Return what is said of the direction of arrival at each target; nothing where there is none."""
    if table.approaches is None:
        return [{}] * len(table)
    rows = table.approaches.tolist()
    return [
        {} if math.isnan(tolerance) else {"approach": {"direction": direction, "tolerance": tolerance}}
        for *direction, tolerance in rows
    ]


def _surfaces(task: Task) -> list[object]:
    """Return of each surface which targets are its samples; their weights are as their areas."""
    of = task.surface_of_targets
    return [
        {
            "name": surface.name,
            "coverage": surface.coverage,
            "tolerance": surface.tolerance,
            "first": int(np.argmax(of == number)),
            "samples": int(np.count_nonzero(of == number)),
        }
        for number, surface in enumerate(task.surfaces)
        if (of == number).any()
    ]


def _path(path: Path) -> dict[str, object]:
    """Return a path whole; its samples are among the targets, after those of the surfaces."""
    return {
        "name": path.name,
        "waypoints": path.waypoints,
        "closed": path.closed,
        "interpolation": path.interpolation.value,
        "tolerance": path.tolerance,
        "speed": path.speed,
    }


def arcs_to_json(shape: LinkShape) -> list[object]:
    """Return the arcs of a link's shape, from P2 to its end: curvatures in 1/m, lengths in m."""
    return [
        {"curvature": curvature, "length": length}
        for curvature, length in zip(shape.curvatures, shape.lengths, strict=True)
    ]


def _robot(robot: Robot) -> dict[str, object]:
    link, limits, rates = robot.link, robot.joint_limits, robot.joint_rates
    return {
        "name": robot.name,
        "d12": robot.d12,
        "link": {
            "length": _interval(link.length),
            "min_bend_radius": link.min_bend_radius,
            "diameter": link.diameter,
            "max_total_bend": link.max_total_bend,  # null: no limit
        },
        "tip_offset": robot.tip_offset,
        "d34": robot.d34,
        "rigid_link": _rigid_link(robot.rigid_link),
        "rigid_links": None
        if robot.rigid_links is None
        else {
            "names": robot.rigid_links.names,
            "links": [_rigid_link(link) for link in robot.rigid_links.links],
        },
        "joint_limits": {"base": _interval(limits.base), "second": _interval(limits.second)},
        "joint_rates": {"speeds": rates.speeds, "accelerations": rates.accelerations},
    }


def _rigid_link(link: RigidLink) -> dict[str, object]:
    return {"d35": _interval(link.d35), "d45": _interval(link.d45), "diameter": link.diameter}


def _interval(interval: Interval) -> list[float]:
    return [interval.lower, interval.upper]


def _obstacle(obstacle: Obstacle) -> dict[str, object]:
    solid = obstacle.solid
    if isinstance(solid, Box):
        box = {key: getattr(solid, key) for key in ("size", "yaw", "pitch", "roll")} | {
            "center": solid.centre
        }
        return {"name": obstacle.name, "box": box}
    start, end = solid.ends
    if np.array_equal(start, end):
        return {"name": obstacle.name, "sphere": {"center": start, "radius": solid.radius}}
    return {"name": obstacle.name, "capsule": {"from": start, "to": end, "radius": solid.radius}}
