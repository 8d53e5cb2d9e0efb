"""A solution from its file: the task with its robot, and the shapes found, to be verified again.

Only `synth.solution/2` holds its whole task. Everything in it is in metres and radians already.
"""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from pydantic import ValidationError

from synth.errors import InputError, Mistake
from synth.files import key_text
from synth.geometry import Box, Capsule, Sphere
from synth.robot import (
    Arm,
    BasePose,
    Interval,
    JointLimits,
    LinkShape,
    MalleableLink,
    RigidLink,
    Robot,
)
from synth.task.model import Obstacle, Task
from synth.task.solution_schema import ShapeEntry, SolidEntry, SolutionFile, TaskEntry
from synth.task.targets import PointTarget

if TYPE_CHECKING:
    import os

SCHEMA = "synth.solution/2"
_MAX_BYTES = 200_000_000
_MISTAKES_AT_MOST = 10


def load_shapes(path: str | os.PathLike[str]) -> tuple[Task, tuple[Arm, ...]]:
    """Read a solution's task and the shapes found for it, the best first.

    Args:
        path: The file, as `synth solve` writes it.

    Returns:
        The task and the arms, each to be verified again; at least one arm.

    Raises:
        InputError: The file cannot be read, is no such solution, or holds no shape.
    """
    file = str(path)
    content = _content(Path(path), file)
    schema = content.get("schema")
    if schema != SCHEMA:
        old = isinstance(schema, str) and schema.startswith("synth.solution/")
        why = (
            f"is of the schema {schema}, and {SCHEMA} is needed, which holds the whole task: solve the "
            "task again"
            if old
            else "is no solution of synth: it names no schema synth.solution/2"
        )
        raise InputError([Mistake(why, file, None, "schema")])
    try:
        read = SolutionFile.model_validate(content)
        main = None if read.link is None else ShapeEntry(link=read.link, distances=read.distances or {})
    except ValidationError as error:
        mistakes = [
            Mistake(str(each["msg"]), file, None, key_text(each["loc"]))
            for each in error.errors()[:_MISTAKES_AT_MOST]
        ]
        raise InputError(mistakes) from None
    if main is None:
        raise InputError([Mistake("holds no shape: the task was not solved", file, None, "link")])
    task = _task(read.task)
    return task, tuple(_arm(task, shape) for shape in (main, *read.alternatives))


def _content(path: Path, file: str) -> dict[str, Any]:
    try:
        with path.open("rb") as stream:
            data = stream.read(_MAX_BYTES + 1)
        content = json.loads(data.decode("utf-8-sig")) if len(data) <= _MAX_BYTES else None
    except FileNotFoundError:
        raise InputError([Mistake("there is no such file", file)]) from None
    except OSError as error:
        raise InputError([Mistake(f"cannot be read: {error.strerror or error}", file)]) from None
    except (ValueError, RecursionError):
        raise InputError([Mistake("is no JSON", file)]) from None
    if not isinstance(content, dict):
        raise InputError([Mistake("is no solution of synth", file)])
    return content


def _interval(limits: list[float]) -> Interval:
    return Interval(min(limits), max(limits))


def _task(read: TaskEntry) -> Task:
    link, rigid, limits = read.robot.link, read.robot.rigid_link, read.robot.joint_limits
    robot = Robot(
        name=read.robot.name,
        d12=read.robot.d12,
        link=MalleableLink(
            _interval(link.length), link.min_bend_radius, link.diameter, link.max_total_bend or math.inf
        ),
        d34=read.robot.d34,
        tip_offset=read.robot.tip_offset,
        rigid_link=RigidLink(_interval(rigid.d35), _interval(rigid.d45), rigid.diameter),
        joint_limits=JointLimits(_interval(limits.base), _interval(limits.second)),
    )
    targets = tuple(PointTarget(t.name, np.array(t.position), t.tolerance, t.weight) for t in read.targets)
    return Task(
        name=read.name,
        robot=robot,
        targets=targets,
        base=BasePose(np.array(read.base.position), read.base.yaw),
        floor=read.floor,
        topology=read.topology,
        objective=read.objective,
        obstacles=tuple(_obstacle(each) for each in read.obstacles),
    )


def _obstacle(read: SolidEntry) -> Obstacle:
    if read.capsule is not None:
        ends = np.array([read.capsule.start, read.capsule.end])
        return Obstacle(read.name, Capsule(ends, read.capsule.radius))
    if read.sphere is not None:
        return Obstacle(read.name, Sphere(np.array(read.sphere.center), read.sphere.radius))
    box = read.box
    if box is None:  # the model allows no such obstacle
        raise TypeError(read)
    return Obstacle(read.name, Box(np.array(box.center), np.array(box.size), box.yaw))


def _arm(task: Task, shape: ShapeEntry) -> Arm:
    arcs = shape.link.arcs
    made = LinkShape(np.array([arc.curvature for arc in arcs]), np.array([arc.length for arc in arcs]))
    return Arm(task.robot, made, shape.distances["35"], shape.distances["45"], task.base)
