"""Arms with tasks that they meet, or miss by what is said, and the guide to one of them."""

import math
from dataclasses import replace

import numpy as np
from hypothesis import strategies as st

from synth.guide import make_guide
from synth.robot import PRESETS, Arm, BasePose, JointLimits, LinkShape
from synth.synthesis import (
    Design,
    Solution,
    Status,
    Timing,
    verify,
)
from synth.task import PointTarget, Task

ROBOT = PRESETS["malleable-2dof"]
FREE = replace(ROBOT, joint_limits=JointLimits())
BASE = BasePose([0.1, -0.2, 0.05], 0.7)
TIMING = Timing(1.25, 0.5, 0.5, 0.25)


def make_arm(curvatures=((3.0, 1.0), (-2.0, 4.0), (1.0, 5.0)), length=0.63, robot=ROBOT, base=BASE):
    shape = LinkShape(curvatures, np.full(len(curvatures), length / len(curvatures)))
    return Arm(robot, shape, 0.455, 0.460, base)


def make_design(arm, joints, offsets, tolerance=2e-3):
    """A task whose targets are some way off what an arm reaches, and the design that does it."""
    points = arm.forward_kinematics(*np.asarray(joints).T) + np.asarray(offsets)
    targets = tuple(PointTarget(f"t{i}", point, tolerance) for i, point in enumerate(points))
    task = Task("a task", arm.robot, targets, arm.base, floor=None)
    return task, Design(arm, verify(task, arm))


ARM = make_arm()
JOINTS = [[1.0, 2.0], [4.0, 3.3], [2.5, 4.6]]
TASK, DESIGN = make_design(ARM, JOINTS, np.zeros((3, 3)))
GUIDE = make_guide(TASK, DESIGN)
SOLUTION = Solution(TASK, Status.FOUND, Status.FOUND.sentence, (), 7, (DESIGN,), 3, TIMING)
NOTHING = replace(SOLUTION, status=Status.FAILED, reasons=("no", "never"), designs=())
curvature = st.floats(-6.0, 6.0)
arms = st.builds(
    make_arm,
    st.lists(st.tuples(curvature, curvature), min_size=1, max_size=4),
    st.floats(0.55, 0.7),
    st.just(FREE),
    st.builds(BasePose, st.tuples(*[st.floats(-1.0, 1.0)] * 3).map(np.array), st.floats(-math.pi, math.pi)),
)
