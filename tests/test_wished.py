"""Shapes that a person would want: within the tolerances, with margins, calmer and more forgiving."""

from dataclasses import replace

import numpy as np
import pytest
from planted import ROBOT, planted_task

from synth.robot import Interval, JointLimits
from synth.synthesis import solve, verify
from synth.synthesis.margins import Margins
from synth.synthesis.wished import wished
from synth.task import PointTarget, Task


def tables(tolerance=5e-3):
    """Return the task of picking from one table and placing on another."""
    points = {
        "over pick": [-0.52, 0.40, 0.40],
        "pick": [-0.52, 0.40, 0.25],
        "over place": [-0.52, -0.38, 0.40],
        "place": [-0.52, -0.38, 0.25],
    }
    return Task("tables", ROBOT, tuple(PointTarget(name, at, tolerance) for name, at in points.items()))


@pytest.mark.parametrize("seed", range(3))
def test_shapes_wished_for_are_found_and_have_margins(seed):
    task = tables()
    known = solve(task, alternatives=0).best.arm
    arm, joints = next(wished(task, [known], seed))
    check = verify(task, arm, joints, keep=True)
    assert check.found
    assert np.array_equal(check.joints, joints)
    assert Margins.of(arm, joints, check.clearances).shortfall(Margins.wanted(ROBOT)) == 0.0


def test_the_best_shape_is_off_its_limits_where_the_first_one_leans_on_them():
    task = tables()
    quick = [solve(task, seed=seed, alternatives=0).best.figures for seed in range(3)]
    best = [solve(task, seed=seed).best.figures for seed in range(3)]
    assert [(each.shortfall, each.ways_missing) for each in best] == [(0.0, 0)] * 3
    assert max(each.shortfall for each in quick) > 0.5


def test_the_tolerance_is_used():
    shapes = [solve(tables(tolerance)).best for tolerance in (1e-4, 5e-3)]
    exact, loose = (shape.verification.misses.max() for shape in shapes)
    assert exact < 1e-5
    assert 1e-4 < loose < 5e-3
    assert shapes[1].figures.largest_swing < shapes[0].figures.largest_swing - np.radians(20.0)


def test_targets_with_tight_tolerances_are_met_exactly():
    for seed in range(3):
        task, _ = planted_task(seed, 4)
        task = replace(task, targets=tuple(replace(t, tolerance=1e-5) for t in task.targets))
        solution = solve(task)
        assert solution.found
        assert max(target.miss for target in solution.targets) < 1e-6


def test_where_no_margins_are_to_be_had_the_shape_is_found_as_before():
    task, arm = planted_task(4, 6)
    joints, _ = arm.closest_joints(task.table.positions)
    limits = JointLimits(
        Interval(joints[:, 0].min() - 1e-3, joints[:, 0].max() + 1e-3),
        Interval(joints[:, 1].min() - 1e-3, joints[:, 1].max() + 1e-3),
    )
    solution = solve(replace(task, robot=replace(ROBOT, joint_limits=limits)))
    assert solution.found
    assert solution.best.figures.shortfall > 0.5


def test_the_same_seed_gives_the_same_shapes():
    task = tables()
    known = solve(task, alternatives=0).best.arm
    one, other = (next(wished(task, [known], 1))[0] for _ in range(2))
    assert np.array_equal(one.shape.curvatures, other.shape.curvatures)
