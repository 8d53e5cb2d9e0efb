"""The worst miss: the norm that gets sharper, and shapes that no small change improves."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from planted import ROBOT, noisy, planted_task
from planted_surfaces import as_points

from synth.synthesis import solve
from synth.synthesis.shapes import Postures, TargetsSeen
from synth.synthesis.shapes.shapes import Shapes, in_equal_arcs, into_limits
from synth.synthesis.starts.descent import _curvature_of_norm
from synth.synthesis.starts.refinement import level, refine
from synth.task import Objective, PointTarget


def test_the_worst_miss_is_less_where_it_counts():
    worst = {}
    for objective in Objective:
        task = noisy(4, objective=objective)
        refined = refine(task, Shapes.sample(ROBOT, 60, np.random.default_rng(4)))
        kinematics = refined.shapes.kinematics.each_target()
        misses = kinematics.forward(*np.moveaxis(refined.joints, -1, 0)) - task.positions_in_base
        worst[objective] = np.linalg.norm(misses, axis=-1).max(axis=-1).min()
    assert worst[Objective.MINIMAX] < 0.97 * worst[Objective.LEAST_SQUARES]


def test_the_curvature_of_the_norm_is_its_second_derivative_where_misses_are_linear():
    """By differences of the squared p-norm itself, for misses that change linearly."""
    rng = np.random.default_rng(7)
    misses, slopes, exponent = rng.uniform(0.5, 1.0, 6), rng.normal(size=(6, 3)), 12.0

    def squared_norm(x):
        return np.mean((misses + slopes @ x) ** exponent) ** (2.0 / exponent)

    cost = squared_norm(np.zeros(3))
    shares = cost ** (1.0 - exponent / 2.0) * misses ** (exponent - 2.0) / 6.0
    slope = slopes.T @ (shares * misses)
    curvature = slopes.T @ (shares[:, None] * slopes)
    half = _curvature_of_norm(exponent, np.array([cost]), curvature[None], slope[None])[0]
    step = 1e-4
    for i, j in itertools.product(range(3), repeat=2):
        one, other = step * np.eye(3)[i], step * np.eye(3)[j]
        mixed = squared_norm(one + other) - squared_norm(one - other)
        mixed += squared_norm(-one - other) - squared_norm(other - one)
        assert np.isclose(2.0 * half[i, j], mixed / (4.0 * step**2), rtol=1e-3, atol=1e-3)


def test_the_worst_miss_is_levelled_to_what_no_small_change_improves():
    task = noisy(8, objective=Objective.MINIMAX)
    refined = level(task, refine(task, Shapes.sample(ROBOT, 60, np.random.default_rng(8))).best(12))
    rng, best = np.random.default_rng(0), refined.best(1)
    nearby = np.repeat(best.shapes.unknowns, 200, axis=0)
    nearby = into_limits(ROBOT, nearby + 1e-3 * rng.normal(size=nearby.shape))
    aims = TargetsSeen(task.positions_in_base, ROBOT.joint_limits)
    worst = Postures.nearest(aims, Shapes(ROBOT, nearby).kinematics).squared.max(axis=1)
    assert worst.min() > (1.0 - 1e-3) * best.cost[0]


def test_where_all_targets_are_met_the_worst_miss_has_no_slope_and_warns_of_nothing():
    task, arm = planted_task(10, 5)
    task = replace(task, floor=None, objective=Objective.MINIMAX)
    here = Shapes.of(in_equal_arcs(arm))
    met = refine(replace(task, objective=Objective.LEAST_SQUARES), here, iterations=40)
    exact = met.shapes.kinematics.each_target().forward(*np.moveaxis(met.joints, -1, 0))[0]
    task = replace(task, targets=tuple(PointTarget(f"t{i}", point) for i, point in enumerate(exact)))
    refined = level(task, refine(task, met.shapes))
    assert refined.cost[0] < 1e-18


@pytest.mark.parametrize(("seed", "weighted"), [(0, False), (7, False), (13, True)])
def test_what_the_least_squares_just_break_is_met_where_a_shape_is_within_all_tolerances(seed, weighted):
    """The least sum of squares misses one target by up to a fifth more than the planted arm misses any."""
    rng = np.random.default_rng([seed, 77])
    count = int(rng.integers(6, 31))
    task, planted = planted_task(seed, count)
    points = task.table.positions + rng.normal(0.0, 2e-3, (count, 3))
    weights = rng.uniform(0.2, 5.0, count) if weighted else np.ones(count)
    tolerance = 1.02 * float(planted.closest_joints(points)[1].max())
    targets = tuple(
        replace(target, position=point, tolerance=tolerance, weight=float(weight))
        for target, point, weight in zip(task.targets, points, weights, strict=True)
    )
    solution = solve(replace(task, targets=targets))
    assert solution.found
    assert solution.best.arm.closest_joints(points)[1].max() <= tolerance


def test_of_many_targets_each_is_met_where_a_shape_is_within_all_tolerances():
    task, planted, _ = as_points(96, noise=2e-3)
    points = task.table.positions
    tolerance = 1.1 * float(planted.closest_joints(points)[1].max())
    solution = solve(as_points(96, noise=2e-3, tolerance=tolerance)[0])
    assert solution.found
    assert solution.best.arm.closest_joints(points)[1].max() <= tolerance


def test_the_least_worst_miss_of_very_many_targets_is_that_of_those_that_bind():
    """A fourth of them proves, as far as a search of its own tells, that no shape misses all by less."""
    task = noisy(3, 120, noise=0.03, objective=Objective.MINIMAX)
    best = solve(task, alternatives=0).best
    misses = best.verification.misses
    few = task.asking_for(task.table.take(np.sort(np.argsort(-misses)[:30])))
    least = solve(few, alternatives=0, seed=1).best.verification.misses.max()
    assert misses.max() < 1.01 * least
