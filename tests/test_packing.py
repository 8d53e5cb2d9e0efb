"""A shape as the unknowns of the program: each by its name, none lost on the way there and back."""

import re
from dataclasses import replace

import numpy as np
import pytest
from planted import ROBOT, planted_arm

from synth.robot import BasePose, RigidLink
from synth.synthesis.nlp import Structure, SynthesisNlp
from synth.synthesis.nlp.packing import packed, unpacked
from synth.synthesis.nlp.planes import Separation
from synth.synthesis.shapes import ARCS, in_equal_arcs
from synth.task import Objective, PointTarget, Task

BASE = BasePose([0.1, -0.2, 0.3], 0.7)
JOINTS = np.array([[0.5, 2.0], [1.5, 3.0], [4.0, 3.5]])
MISSES = 1e-3 * np.array([[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.5, 0.5, -3.0]])  # base frame
WEIGHTS = np.array([1e6, 2e6, 3e6])  # 1/m^2
RIGID_LINKS = {
    "fixed": ROBOT.rigid_link,
    "free": RigidLink([0.44, 0.47], [0.45, 0.48]),
    "half free": RigidLink(0.455, [0.45, 0.48]),
}


@pytest.fixture(params=RIGID_LINKS)
def rigid(request):
    return RIGID_LINKS[request.param]


def posed(rigid, objective=Objective.LEAST_SQUARES):
    """Return a task that an arm misses by MISSES at JOINTS, and the arm."""
    arm = in_equal_arcs(planted_arm(np.random.default_rng(3)))
    robot = replace(ROBOT, rigid_link=rigid)
    arm = replace(arm, robot=robot, d35=rigid.d35.middle, d45=rigid.d45.middle, base=BASE)
    positions = BASE.to_task(BASE.to_base(arm.forward_kinematics(*JOINTS.T)) - MISSES)
    targets = [PointTarget(f"target {index}", position) for index, position in enumerate(positions)]
    return Task("posed", robot, targets, BASE, floor=None, objective=objective), arm


def program_of(task, planes=()):
    """Return the name of each unknown of the program, its f and g as functions of x and p, and its bounds."""
    ipopt = SynthesisNlp(Structure.of(task), ARCS, planes)._ipopt
    functions = ipopt._solver.oracle()
    symbols = functions.sx_in(0)
    names = [re.sub(r"_\d+$", "", symbols[index].name()) for index in range(symbols.numel())]
    return np.array(names), functions, ipopt._bounds


def unknowns_of(task, planes=()):
    """Return what knows the names of the unknowns of the program, and where they are."""
    return SynthesisNlp(Structure.of(task), ARCS, planes)._x


def values_of(task, arm, planes=()):
    """Return the values of the unknowns for the arm, in the order of the program."""
    overlaps = len(JOINTS) + 1 if planes else 0
    return unknowns_of(task, planes).vector_of(packed(task, arm, JOINTS, overlaps, WEIGHTS))


def test_each_unknown_has_the_value_of_its_name(rigid):
    task, arm = posed(rigid)
    names, _, _ = program_of(task)
    values = values_of(task, arm)
    p1, p2, p3, p4 = arm.axis_points
    expected = {
        "curvature": (arm.shape.curvatures * ROBOT.link.min_bend_radius).ravel(),
        "length": [arm.shape.length],
        "s": [np.sum((b - a) ** 2) for a, b in ((p1, p3), (p1, p4), (p2, p3), (p2, p4))],
        "theta1": JOINTS[:, 0],
        "theta2": JOINTS[:, 1],
        "miss": MISSES.T.ravel(),
    }
    if not rigid.is_fixed:
        p5 = BASE.to_base(arm.forward_kinematics(0.0, np.pi))
        along = (p5 - p3) @ (p4 - p3) / ROBOT.d34
        expected |= {
            "s35": [np.sum((p5 - p3) ** 2)],
            "s45": [np.sum((p5 - p4) ** 2)],
            "from_p3": [along],
            "radius": [np.linalg.norm(p5 - p3 - along * (p4 - p3) / ROBOT.d34)],
        }
    assert len(values) == len(names)
    assert set(names) == set(expected)
    for name, numbers in expected.items():
        assert values[names == name] == pytest.approx(np.array(numbers), abs=1e-12), name


def test_a_shape_comes_back_as_it_was(rigid):
    task, arm = posed(rigid)
    again, joints = unpacked(task, unknowns_of(task).by_name(values_of(task, arm)))
    assert joints == pytest.approx(JOINTS, abs=1e-15)
    assert again.shape.curvatures == pytest.approx(arm.shape.curvatures, abs=1e-12)
    assert again.shape.lengths == pytest.approx(arm.shape.lengths, abs=1e-15)
    assert (again.d35, again.d45) == pytest.approx((arm.d35, arm.d45), abs=1e-15)
    assert (again.robot, again.base) == (task.robot, BASE)


def test_a_shape_that_the_link_takes_is_within_all_bounds_of_the_program(rigid):
    task, arm = posed(rigid)
    _, functions, bounds = program_of(task)
    values = values_of(task, arm)
    floor, steepest = 0.0, 0.0
    none = [
        np.zeros(3 * len(WEIGHTS)),
        np.full(len(WEIGHTS), -1.0),
    ]  # directions of arrival and their cosines
    parameters = np.concatenate([task.positions_in_base.T.ravel(), WEIGHTS, [floor, steepest], *none])
    objective, constraints = (part.full().ravel() for part in functions(values, parameters))
    for given, kind in ((values, "x"), (constraints, "g")):
        assert (given >= bounds[f"lb{kind}"] - 1e-10).all()
        assert (given <= bounds[f"ub{kind}"] + 1e-10).all()
    assert (bounds["lbg"] == bounds["ubg"]).sum() >= 4 + 3 * len(JOINTS)
    missed = WEIGHTS @ np.sum(MISSES**2, axis=1)
    assert missed < objective < missed + 0.1  # and the least bit for the bend


def test_what_the_solver_oversteps_is_brought_back_into_the_bounds(rigid):
    task, arm = posed(rigid)
    names, _, _ = program_of(task)
    values = values_of(task, arm)
    values[np.isin(names, ["curvature", "length", "s35", "s45", "theta1", "theta2"])] *= 3.0
    again, joints = unpacked(task, unknowns_of(task).by_name(values))
    robot = task.robot
    assert again.shape.bends.max() <= robot.link.max_curvature * (1.0 + 1e-12)
    assert again.shape.length == pytest.approx(robot.link.length.upper)
    assert (again.d35, again.d45) == (rigid.d35.upper, rigid.d45.upper)
    assert robot.joint_limits.contain(joints).all()


def test_overlaps_and_the_worst_miss_have_their_places():
    task, arm = posed(ROBOT.rigid_link, Objective.MINIMAX)
    planes = [Separation(0, 3, None, [0.0, 0.0, 1.0], -5.0)]
    names, _, _ = program_of(task, planes)
    values = values_of(task, arm, planes)
    assert len(values) == len(names)
    assert list(values[names == "overlap"]) == [0.0] * (len(JOINTS) + 1)
    worst = np.max(WEIGHTS * np.sum(MISSES**2, axis=1))
    assert values[names == "worst"] == pytest.approx([worst])
    again, joints = unpacked(task, unknowns_of(task, planes).by_name(values))
    assert again.shape.curvatures == pytest.approx(arm.shape.curvatures, abs=1e-12)
    assert joints == pytest.approx(JOINTS, abs=1e-15)
