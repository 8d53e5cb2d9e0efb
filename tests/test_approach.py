"""Directions of arrival: read, found, checked by points alone, and told."""

from dataclasses import replace

import numpy as np
import pytest
from planted_approaches import planted_approach, pointing_of

import synth
from synth.export import solution_to_json
from synth.synthesis import Design, Status
from synth.synthesis.shapes import Postures, Shapes, TargetsSeen
from synth.synthesis.solution import message
from synth.synthesis.starts import start_points
from synth.synthesis.starts.residuals import Residuals
from synth.task import Approach, PointTarget, TargetTable

TASK = """
synth: 1
length_unit: mm
robot: malleable-2dof
targets: [{{position: [350, 100, 150], tolerance: 5, approach: {approach}}}]
"""


def read(approach):
    return synth.parse_task(TASK.format(approach=approach))


def astray(solution):
    """The angles beside the directions asked for, by points alone."""
    asked = {target.name: target.approach for target in solution.task.targets}
    for target in solution.targets:
        pointing = pointing_of(solution.robot, target.joints)
        direction = asked[target.name].direction
        yield np.arctan2(np.linalg.norm(np.cross(pointing, direction)), pointing @ direction)


def test_a_file_states_direction_and_tolerance():
    (target,) = read("{direction: [0, 0, -2], tolerance_deg: 15}").targets
    assert target.approach == Approach([0.0, 0.0, -1.0], np.radians(15.0))
    assert read("{direction: [1, 0, 0]}").targets[0].approach.tolerance == pytest.approx(np.radians(5.0))


@pytest.mark.parametrize(
    ("approach", "key", "words"),
    [
        ("{direction: [0, 0, 0]}", "targets[0].approach.direction", "must point somewhere"),
        ("{direction: [0, 0]}", "targets[0].approach.direction", "3 numbers"),
        ("{direction: [0, 0, 1], tolerance_deg: 0}", "targets[0].approach.tolerance_deg", "greater than 0"),
        ("{directon: [0, 0, 1]}", "targets[0].approach.directon", "did you mean 'direction'"),
    ],
)
def test_mistakes_are_named(approach, key, words):
    with pytest.raises(synth.InputError) as caught:
        read(approach)
    mistakes = {mistake.key: mistake.message for mistake in caught.value.mistakes}
    assert words in mistakes[key]


def test_a_table_keeps_the_directions_of_its_targets():
    one = PointTarget("one", [0.1, 0.2, 0.3], approach=Approach([1.0, 0.0, 0.0], 0.1))
    two = PointTarget("two", [0.1, 0.2, 0.4])
    table = TargetTable.of([one, two])
    assert [*table] == [one, two]
    assert TargetTable.of([two]).followed_by(table.take(np.array([0])))[1] == one
    assert TargetTable.of([two]).approaches is None


@pytest.mark.parametrize(("seed", "count", "degrees"), [(0, 1, 1.0), (1, 1, 15.0), (2, 2, 1.0), (3, 2, 15.0)])
def test_planted_directions_are_found(seed, count, degrees):
    task = planted_approach(seed, count, np.radians(degrees))
    solution = synth.solve(task)
    assert solution.found
    assert max(astray(solution)) <= np.radians(degrees) + 2e-6
    stated = [target["astray"] for target in solution_to_json(solution)["targets"]]
    assert stated == pytest.approx([*astray(solution)], abs=1e-6)


def test_a_shape_that_points_elsewhere_does_not_meet_the_task():
    task = planted_approach(0, 1)
    arm = synth.solve(task).robot
    (target,) = task.targets
    turned = replace(target, approach=replace(target.approach, direction=-target.approach.direction))
    check = synth.verify(replace(task, targets=[turned]), arm)
    assert not check.found
    assert check.misses[0] <= target.tolerance
    assert np.degrees(check.astray[0]) > 170.0


def test_what_points_elsewhere_is_told_as_that():
    task = planted_approach(0, 1)
    arm = synth.solve(task).robot
    (target,) = task.targets
    turned = replace(target, approach=replace(target.approach, direction=-target.approach.direction))
    task = replace(task, targets=[turned])
    told = message(task, Status.BEST_EFFORT, [Design(arm, synth.verify(task, arm))], ())
    assert "target 1 is arrived at 17" in told
    assert "deg beside its direction, where 1.00 deg are allowed" in told


def test_the_slope_of_what_points_elsewhere_is_its_derivative():
    """Near the answer, where the misses are small, by differences of the shapes' own postures."""
    task = planted_approach(3, 4)
    arm = next(start_points(task, 0)).arm
    rng, step = np.random.default_rng(0), 1e-6
    shapes = replace(Shapes.of(arm), unknowns=Shapes.of(arm).unknowns + 1e-3 * rng.normal(size=(6, 9)))
    aims = TargetsSeen.by(task, shapes)
    postures = Postures.nearest(aims, shapes.kinematics)
    assert (postures.astray > 0.0).any()
    _, by_motion = Residuals(shapes, postures, aims).normal_equations(np.ones(postures.theta2.shape))
    slopes = (shapes.motion.transpose(0, 2, 1) @ by_motion[..., None])[..., 0]
    for unknown in range(9):
        costs = []
        for side in (step, -step):
            moved = shapes.unknowns.copy()
            moved[:, unknown] += side
            there = replace(shapes, unknowns=moved)
            led = Postures.led_from(TargetsSeen.by(task, there), there.kinematics, postures.theta2)
            costs.append(0.5 * led.squared.sum(axis=1))
        change = (costs[0] - costs[1]) / (2.0 * step)
        assert slopes[:, unknown] == pytest.approx(change, rel=0.02, abs=2e-4)
