"""The synthesis as a whole: planted tasks found, impossible ones not, limits kept, ends told apart."""

from dataclasses import replace

import numpy as np
import pytest
from planted import feasible, out_of_reach, planted_task
from solved import independent_misses, noisy

from synth.robot import BasePose
from synth.synthesis import NotFoundError, Status, solve
from synth.task import Objective, Topology


@pytest.mark.parametrize(
    "topology", [t for t in Topology if t is not Topology.GENERAL], ids=lambda t: t.value
)
@pytest.mark.parametrize(("seed", "count"), [(0, 2), (1, 5), (2, 12)])
def test_planted_targets_are_found_in_every_family(topology, seed, count):
    task, _ = planted_task(seed, count, topology)
    solution = solve(task)
    assert solution.found
    assert all(target.miss < 0.5e-3 for target in solution.targets)
    assert feasible(solution.robot)


def test_the_reported_misses_are_those_of_an_independent_computation():
    task, _ = planted_task(4, 6)
    task = replace(task, base=BasePose([0.2, -0.1, 0.05], 0.5))
    task = replace(
        task, targets=tuple(replace(t, position=task.base.to_task(t.position)) for t in task.targets)
    )
    solution = solve(task)
    assert solution.found
    np.testing.assert_allclose(
        independent_misses(solution), [target.miss for target in solution.targets], atol=1e-7
    )


@pytest.mark.parametrize("seed", range(4))
def test_a_target_out_of_reach_is_proven_and_never_found(seed):
    solution = solve(out_of_reach(seed))
    assert solution.status is Status.PROVEN_IMPOSSIBLE
    assert not solution.found
    assert max(target.miss for target in solution.targets) > 1e-3
    with pytest.raises(NotFoundError) as error:
        solution.or_raise()
    assert error.value.solution is solution


def test_noisy_targets_get_the_best_effort_and_every_miss_is_stated():
    solution = solve(noisy(3, 15, 0.03))
    assert solution.status is Status.BEST_EFFORT
    assert feasible(solution.robot, floor=-np.inf)
    assert "misses by" in solution.message
    assert all(np.isfinite(target.miss) for target in solution.targets)


def test_no_small_change_of_the_link_improves_a_best_effort():
    solution = solve(noisy(6, 12, 0.02))
    best = sum(target.miss**2 for target in solution.targets)
    rng, arm = np.random.default_rng(0), solution.robot
    wanted, compared = [target.position for target in solution.targets], 0
    for scale in (1e-2, 1e-3):
        for _ in range(50):
            curvatures = arm.shape.curvatures + scale * rng.normal(size=arm.shape.curvatures.shape)
            lengths = arm.shape.lengths * (1.0 + scale * rng.normal(scale=0.1))
            other = replace(arm, shape=replace(arm.shape, curvatures=curvatures, lengths=lengths))
            if feasible(other, floor=-np.inf):
                assert np.sum(other.closest_joints(wanted)[1] ** 2) > best * (1.0 - 1e-6)
                compared += 1
    assert compared > 20


def test_minimax_lowers_the_worst_miss_and_least_squares_their_sum():
    squares = solve(noisy(5, 10, 0.02))
    worst = solve(noisy(5, 10, 0.02, objective=Objective.MINIMAX))
    misses_squares = np.array([target.miss for target in squares.targets])
    misses_worst = np.array([target.miss for target in worst.targets])
    assert misses_worst.max() < misses_squares.max()
    assert np.sum(misses_squares**2) < np.sum(misses_worst**2)


@pytest.mark.parametrize("seed", [4, 7])
def test_what_can_be_met_is_found_by_the_worst_miss_too_however_the_tolerances_differ(seed):
    task, _ = planted_task(seed, 16)
    tolerances = 1e-3 * np.exp(np.random.default_rng(seed).uniform(np.log(0.01), np.log(10.0), 16))
    table = replace(task.table, tolerances=tolerances)
    assert solve(replace(task, targets=table, objective=Objective.MINIMAX), alternatives=0).found


def test_a_heavier_weight_and_a_tighter_tolerance_draw_the_surface_nearer():
    task = noisy(7, 10, 0.02)
    plain = solve(task).targets[0].miss
    heavy = replace(task, targets=(replace(task.targets[0], weight=100.0), *task.targets[1:]))
    tight = replace(task, targets=(replace(task.targets[0], tolerance=0.5e-4), *task.targets[1:]))
    assert solve(heavy).targets[0].miss < 0.5 * plain
    assert solve(tight).targets[0].miss < 0.5 * plain
