"""The task: what is asked, and how it is read from a file."""

from synth.robot import BasePose
from synth.task.model import DEFAULT_TOLERANCE, Objective, Obstacle, PointTarget, TargetTable, Task, Topology
from synth.task.reading import as_task, load_robot, load_task, parse_task
from synth.task.schema import task_schema

__all__ = [
    "DEFAULT_TOLERANCE",
    "BasePose",
    "Objective",
    "Obstacle",
    "PointTarget",
    "TargetTable",
    "Task",
    "Topology",
    "as_task",
    "load_robot",
    "load_task",
    "parse_task",
    "task_schema",
]
