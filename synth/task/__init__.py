"""The task: what is asked, and how it is read from a file."""

from synth.task.entry_types import (
    LARGEST,
    MAPPING,
    TEXT,
    LengthUnit,
    Name,
    Pair,
    Position,
    Positive,
    Strict,
    absent,
)
from synth.task.hardware_distances import off_the_hardware
from synth.task.model import (
    DEFAULT_TOLERANCE,
    Approach,
    Floor,
    Objective,
    Obstacle,
    PointTarget,
    TargetTable,
    Task,
    Topology,
    points_of,
    sampled,
)
from synth.task.reading import as_path, as_task, load_robot, load_task, named_robot, parse_task, robot_within
from synth.task.robot_schema import FileOfARobot, RobotEntry
from synth.task.schema import json_schema, robot_schema, task_schema
from synth.task.sizes import PER_METRE
from synth.task.wording import validate

__all__ = [
    "DEFAULT_TOLERANCE",
    "LARGEST",
    "MAPPING",
    "PER_METRE",
    "TEXT",
    "Approach",
    "FileOfARobot",
    "Floor",
    "LengthUnit",
    "Name",
    "Objective",
    "Obstacle",
    "Pair",
    "PointTarget",
    "Position",
    "Positive",
    "RobotEntry",
    "Strict",
    "TargetTable",
    "Task",
    "Topology",
    "absent",
    "as_path",
    "as_task",
    "json_schema",
    "load_robot",
    "load_task",
    "named_robot",
    "off_the_hardware",
    "parse_task",
    "points_of",
    "robot_schema",
    "robot_within",
    "sampled",
    "task_schema",
    "validate",
]
