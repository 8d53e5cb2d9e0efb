"""Values made in Python refuse what a file may not hold: every mistake at once, one `InputError`."""

import math

import built_values
import numpy as np
import pytest
from command import invoked

import synth
from synth import (
    PRESETS,
    Arm,
    BasePose,
    Box,
    Capsule,
    InputError,
    Interval,
    JointLimits,
    JointRates,
    LinkShape,
    MalleableLink,
    Obstacle,
    PointTarget,
    RigidLink,
    Robot,
    Sphere,
    TargetTable,
    Task,
    Topology,
)
from synth.measurement.distances.reading import parse_measurements

ROBOT = PRESETS["malleable-2dof"]
TARGET = PointTarget("pick", [0.5, 0.1, 0.2])
TASK = Task("a task", ROBOT, [TARGET])
LINK, RIGID = MalleableLink([0.55, 0.7], 0.11), RigidLink(0.455, 0.46)
NAN = math.nan

WRONG = [
    (lambda: PointTarget("", [1, 2], -1, NAN), ["name", "position", "tolerance", "weight"]),
    (
        lambda: PointTarget("a", [1, NAN, math.inf], 0, -1),
        ["position[1]", "position[2]", "tolerance", "weight"],
    ),
    (lambda: PointTarget(7, "abc", True, "x"), ["name", "position", "tolerance", "weight"]),
    (
        lambda: TargetTable(["a", "a"], np.zeros((2, 3)), [1, -1], [NAN, 1]),
        ["targets[1].tolerance", "targets[0].weight"],
    ),
    (lambda: Task("x", ROBOT, TargetTable(["a", "a"], np.eye(3)[:2], [1, 1], [1, 1])), ["targets[1].name"]),
    (lambda: TargetTable(5, [], [], []), ["names"]),
    (lambda: TargetTable([[1], "b"], np.zeros((2, 3)), [1, 1], [1, 1]), ["targets[0].name"]),
    (lambda: Task("x", ROBOT, []), ["targets"]),
    (lambda: Interval(0, 10**400), ["upper"]),
    (lambda: Task("x", ROBOT, [TARGET, TARGET]), ["targets[1].name"]),
    (
        lambda: Task("x", "malleable-2dof", [3], floor=NAN, topology="scra", objective=1, obstacles=[2]),
        ["robot", "targets[0]", "floor", "topology", "objective", "obstacles[0]"],
    ),
    (lambda: Interval(2, 1), [""]),
    (lambda: Interval(NAN, "1"), ["lower", "upper"]),
    (lambda: MalleableLink(-0.5, -1, -2, NAN), ["length", "min_bend_radius", "diameter", "max_total_bend"]),
    (lambda: MalleableLink(Interval(0.5, math.inf), 0.11), ["length.upper"]),
    (lambda: RigidLink(0, [2, 1], NAN), ["d35", "d45", "diameter"]),
    (lambda: JointLimits([1, NAN], 5j), ["base.upper", "second"]),
    (lambda: JointRates(0, [1, -1]), ["speeds", "accelerations[1]"]),
    (lambda: JointRates("fast", [1]), ["speeds", "accelerations"]),
    (lambda: Robot("r", 0, LINK, NAN, "a", RIGID), ["d12", "d34", "tip_offset"]),
    (lambda: Robot("r", 0.058, LINK, 0.001, 0, RIGID), ["rigid_link"]),
    (lambda: Robot("r", 0.058, LINK, 0.049, 0, RIGID, JointLimits([0, 7])), ["joint_limits.base"]),
    (lambda: BasePose([0, 0], math.inf), ["position", "yaw"]),
    (lambda: Sphere([0, 0, NAN], -1), ["centre[2]", "radius"]),
    (lambda: Box([0, 0, 0], [1, 0, -1]), ["size[1]", "size[2]"]),
    (lambda: Capsule([[0, 0, 0]], 0), ["ends", "radius"]),
    (lambda: Obstacle("", 5), ["name", "solid"]),
    (lambda: LinkShape([[0, NAN]], [-1]), ["curvatures[0][1]", "lengths[0]"]),
    (lambda: LinkShape([[0, 0]], [1, 2]), ["lengths"]),
    (lambda: Arm(ROBOT, LinkShape([[0, 0]], [0.6]), NAN, -0.46), ["d35", "d45"]),
    (lambda: Arm(ROBOT, LinkShape([[0, 0]], [0.6]), math.inf, 0), ["d35", "d45"]),
    (lambda: Arm("malleable-2dof", [[0, 0]], "0.455", None, 5), ["robot", "shape", "d35", "d45", "base"]),
    (
        lambda: synth.solve(5, seed=-1, alternatives=0.5, time_limit=NAN, warm_start=3),
        ["task", "seed", "warm_start", "alternatives", "time_limit"],
    ),
    (lambda: synth.explain(None), ["solution"]),
    (lambda: synth.verify(5, 6), ["task"]),
    (lambda: synth.verify(TASK, 6), ["arm"]),
    (lambda: synth.make_guide(TASK, 6), ["design"]),
    (lambda: synth.motions(TASK, 6), ["design"]),
    (lambda: synth.solution_to_json(6), ["solution"]),
    (lambda: synth.load_task(6), ["path"]),
]


@pytest.mark.parametrize(("make", "keys"), WRONG)
def test_every_mistake_of_a_value_is_named_at_once(make, keys):
    with pytest.raises(InputError) as caught:
        make()
    assert [mistake.key for mistake in caught.value.mistakes] == keys


def test_words_become_enumerations_and_numbers_intervals():
    assert Task("x", ROBOT, [TARGET], topology="SCARA").topology is Topology.SCARA
    assert RigidLink(0.455, (0.4, 0.5)) == RigidLink(Interval.fixed(0.455), Interval(0.4, 0.5))
    with pytest.raises(InputError, match="did you mean 'scara'"):
        Task("x", ROBOT, [TARGET], topology="scra")


@pytest.mark.parametrize(
    ("robot", "position", "words"),
    [
        (ROBOT, [5e-4, 1e-4, 2e-4], "within 0.5478 mm of P1"),
        (ROBOT, [500.0, 100.0, 200.0], "In mm the farthest would be 547.8 mm away"),
        (Robot("r", 58.0, LINK, 0.049, 0.02, RIGID), [0.5, 0.1, 0.2], "too short beside d12"),
        (Robot("r", 0.058, MalleableLink(700, 110), 0.049, 0.02, RIGID), [5, 0, 0], "too long beside d12"),
    ],
)
def test_sizes_that_cannot_be_meant_are_asked_about(robot, position, words):
    with pytest.raises(InputError, match=words):
        synth.solve(Task("x", robot, [PointTarget("a", position)]))


@pytest.mark.parametrize("position", [[0.0, 0.0, 0.02], [0.0, 3.0, 3.0]])
def test_targets_near_the_base_and_out_of_reach_are_honest(position):
    assert synth.solve(Task("x", ROBOT, [PointTarget("a", position)]), time_limit=0.0).status


def test_a_rigid_link_of_no_length_and_one_of_no_radius_are_solved():
    for rigid in (RigidLink(0.0245, 0.0245), RigidLink(0.3, 0.349)):
        robot = Robot("r", 0.058, ROBOT.link, 0.049, 0.0245, rigid, ROBOT.joint_limits)
        ball = Obstacle("ball", Sphere([0.2, 0.2, 0.1], 0.03))
        solution = synth.solve(Task("x", robot, [PointTarget("a", [0.3, 0.2, 0.4])], obstacles=[ball]))
        assert solution.found
        assert np.isfinite(solution.designs[0].verification.clearances).all()


@pytest.mark.parametrize(
    "make",
    [
        lambda x: PointTarget("a", [x, 0, 0]),
        lambda x: TargetTable(["a", "b"], [[x, 0, 0], [0, 0, 1]], [1, 1], [1, 1]),
        lambda x: BasePose([x, 0, 0]),
        lambda x: Sphere([x, 0, 0], 1),
        lambda x: Box([x, 0, 0], [1, 1, 1]),
        lambda x: Capsule([[x, 0, 0], [1, 1, 1]], 1),
        lambda x: Obstacle("a", Sphere([x, 0, 0], 1)),
        lambda x: LinkShape([[x, 0]], [1]),
        lambda x: Arm(ROBOT, LinkShape([[x, 0]], [1]), 0.455, 0.46),
        lambda x: Task("a", ROBOT, [PointTarget("a", [x, 0, 0])]),
    ],
)
def test_values_that_hold_arrays_compare_by_value_and_never_raise(make):
    assert make(0.25) == make(0.25)
    assert make(0.0) == make(-0.0)
    assert hash(make(0.0)) == hash(make(-0.0))
    assert make(0.25) != make(0.5)
    assert make(0.25) != 3
    assert len({make(0.25), make(0.25), make(0.5)}) == 2


def test_markers_that_are_not_those_of_the_hardware_are_refused_with_the_number():
    words = "P3 and P4 are 62.8 mm apart; on this robot they are 49.0 mm apart"
    start = {"synth": 1, "length_unit": "mm", "robot": "malleable-2dof"}
    markers = {"P3": [0, 0, 600], "P4": [62.8, 0, 600]}
    task = start | {"targets": [{"position": [400, 300, 500]}], "current": {"markers": markers}}
    with pytest.raises(InputError, match=words) as caught:
        synth.parse_task(task)
    assert [mistake.key for mistake in caught.value.mistakes] == ["current.markers"]
    measured = markers | {"P1": [0, 0, 0], "P2": [0, 0, 40]}
    with pytest.raises(InputError) as caught:
        parse_measurements(start | {"sigma": 0.3, "markers": measured})
    assert [m.message for m in caught.value.mistakes] == [
        words.replace("P3 and P4", "P1 and P2").replace("62.8", "40.0").replace("49.0", "58.0"),
        words,
    ]


def test_no_number_of_seconds_is_nan():
    result = invoked("solve", "task.yaml", "--time-limit", "nan")
    assert result.exit_code == 2
    assert "not a number" in result.output


def arrays_in(value):
    for name in getattr(value, "__dataclass_fields__", ()):
        held = getattr(value, name)
        if isinstance(held, np.ndarray):
            yield f"{type(value).__name__}.{name}", held
        for each in held if isinstance(held, tuple) else [held]:
            yield from arrays_in(each)


def test_whatever_arrays_values_are_built_from_they_hold_copies_that_nobody_writes_to():
    held = [
        each
        for value in vars(built_values).values()
        for one in (value if isinstance(value, list) else [value])
        for each in arrays_in(one)
    ]
    assert len({name for name, _ in held}) >= 15
    for name, each in held:
        assert not each.flags.writeable, name
        assert not np.shares_memory(each, built_values.array), name
        assert each.dtype == np.float64, name
    assert built_values.table[0].approach is not None
    assert built_values.table[1].approach is None
    with pytest.raises(InputError, match="must be 2 x 4 numbers"):
        TargetTable(["a", "b"], np.eye(3)[:2], [1, 1], [1, 1], [[0, 0, 1, 0.1]])
