"""What a task is: frozen values in metres and radians."""

from synth.task.model.samples import points_of, sampled
from synth.task.model.standing import Floor, Obstacle
from synth.task.model.targets import DEFAULT_TOLERANCE, Approach, PointTarget, TargetTable
from synth.task.model.task import Objective, Task, Topology

__all__ = [
    "DEFAULT_TOLERANCE",
    "Approach",
    "Floor",
    "Objective",
    "Obstacle",
    "PointTarget",
    "TargetTable",
    "Task",
    "Topology",
    "points_of",
    "sampled",
]
