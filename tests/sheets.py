"""Solutions to be drawn and written, and what a sheet of them says."""

from dataclasses import replace

import numpy as np

from synth.guide import make_guide
from synth.robot import PRESETS, Arm, BasePose, LinkShape
from synth.synthesis import Design, Solution, Status, Timing, verify
from synth.task import PointTarget, Task

ROBOT = PRESETS["malleable-2dof"]


def make_solution(name="two crates", robot=ROBOT, count=3, offset=0.0, length=0.63, floor=-1.0):
    base = BasePose([0.1, -0.2, 0.05], 0.7)
    arm = Arm(robot, LinkShape([[3.0, 1.0], [-2.0, 4.0], [1.0, 5.0]], [length / 3] * 3), 0.455, 0.460, base)
    points = arm.forward_kinematics(np.linspace(1.0, 5.0, count), np.linspace(2.0, 4.6, count))
    targets = tuple(
        PointTarget(f"target {i}", point + np.array([0.0, 0.0, offset])) for i, point in enumerate(points)
    )
    task = Task(name, robot, targets, base, floor)
    design = Design(arm, verify(task, arm))
    status = Status.FOUND if all(design.verification.within_tolerance) else Status.BEST_EFFORT
    return Solution(task, status, status.sentence, (), 7, (design,), 3, Timing(1.0, 0.25, 0.5, 0.25))


SOLUTION = make_solution()
GUIDE = make_guide(SOLUTION.task, SOLUTION.best)
NOTHING = replace(SOLUTION, status=Status.FAILED, reasons=("ran out of luck",), designs=())
