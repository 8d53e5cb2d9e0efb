"""A solution of two shapes, as it is written and read back."""

import json
from dataclasses import replace

import numpy as np

from synth.export import solution_to_json
from synth.robot import (
    PRESETS,
    Arm,
    BasePose,
    LinkShape,
)
from synth.synthesis import Design, Solution, Status, Timing, verify
from synth.task import PointTarget, Task

ROBOT = PRESETS["malleable-2dof"]
BASE = BasePose([0.1, -0.2, 0.05], 0.7)


def make_solution(tolerance=2e-3, offset=1e-4):
    designs, task = [], None
    for sign in (1.0, -1.0):
        shape = LinkShape([[3.0, sign], [-2.0, 4.0 * sign], [1.0, 5.0 * sign]], [0.2, 0.21, 0.22])
        arm = Arm(ROBOT, shape, 0.455, 0.460, BASE)
        if task is None:
            points = arm.forward_kinematics([1.0, 4.0, 2.5], [2.0, 3.3, 4.6]) + np.array([0.0, 0.0, offset])
            targets = tuple(PointTarget(f"t{i}", point, tolerance) for i, point in enumerate(points))
            task = Task("crates", ROBOT, targets, BASE, floor=None)
        designs.append(Design(arm, verify(task, arm)))
    status = Status.FOUND if designs[0].verification.found else Status.BEST_EFFORT
    return Solution(task, status, status.sentence, (), 7, tuple(designs), 3, Timing(1.0, 0.25, 0.5, 0.25))


SOLUTION = make_solution()
NOTHING = replace(SOLUTION, status=Status.FAILED, message="the solver broke down", designs=())


def read_back(solution):
    return json.loads(json.dumps(solution_to_json(solution), allow_nan=False))
