"""Values built from lists, tuples, arrays, whole numbers and words: they are run, and checked by mypy."""

import numpy as np

import synth

array = np.array([0, 0, 1])

rates = synth.JointRates(2, (1, 2))
link = synth.MalleableLink([0.55, 0.7], 0.11, 0.05)
robot = synth.Robot(
    "mine",
    0.058,
    link,
    0.049,
    0,
    synth.RigidLink(0.455, (0.4, 0.5)),
    synth.JointLimits(base=np.array([0, 3]), second=(1, 5)),
)
shape = synth.LinkShape([(0, 1), (1, 0)], np.array([0.3, 0.3]))
arm = synth.Arm(robot, shape, 1, 1, synth.BasePose((1, 2, 3)))
places = synth.BaseRange(x=[-1, 1], z=0, yaw=(-1.5, 1.5))
choices = synth.BaseChoices(["here"], [synth.BasePose([0, 0, 1])])
targets = [
    synth.PointTarget("list", [1, 2, 3], approach=synth.Approach([0, 0, -2])),
    synth.PointTarget("tuple", (1, 2, 3), 1),
    synth.PointTarget("array", array),
]
table = synth.TargetTable(["a", "b"], [(1, 2, 3), (0, 0, 1)], [1, 1], (1, 1), [[0, 0, 1, 0.1], [np.nan] * 4])
solids: list[synth.Sphere | synth.Box | synth.Capsule] = [
    synth.Sphere((0, 0, 1), 1),
    synth.Box([0, 0, 0], (1, 1, 1)),
    synth.Capsule(((0, 0, 0), (0, 0, 1)), 1),
]
obstacles = [synth.Obstacle(f"solid {index}", solid) for index, solid in enumerate(solids)]
scan = synth.Surface("scan", synth.Scan([(0, 0, 1), (0, 1, 1)]), position=[0, 0, 1], region=[solids[0]])
panel = synth.Surface("panel", synth.Rectangle((1, 2)), rpy=(0, 0, 1))
mesh = synth.Surface("mesh", synth.TriangleMesh([[(0, 0, 0), (1, 0, 0), (0, 1, 0)]]))
path = synth.Path("path", [array, 2 * array], interpolation="spline")
task = synth.Task(
    "a task",
    robot,
    targets,
    floor=0,
    topology="scara",
    objective=synth.Objective.MINIMAX,
    obstacles=obstacles,
    surfaces=[panel],
    paths=[path],
)

# What is held is what is said to be: these lines are for the type checker.
lengths: tuple[float, float, float] = (link.length.lower, robot.rigid_link.d45.middle, places.x.upper)
held: list[np.ndarray] = [targets[0].position, table.positions, shape.curvatures, path.waypoints, panel.rpy]
