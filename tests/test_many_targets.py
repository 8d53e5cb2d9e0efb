"""Tasks of more targets than the nonlinear program knows at once."""

from dataclasses import replace

import numpy as np
import pytest
from planted import planted_task, scanned

from synth.synthesis import solve, verify
from synth.synthesis.whole import part_of
from synth.task import Objective, PointTarget, TargetTable, Task


@pytest.fixture(scope="module")
def scan():
    return scanned(1500)


def rms(verification):
    return float(np.sqrt(np.mean(verification.misses**2)))


def test_a_scanned_surface_is_found_to_within_its_noise(scan):
    task, arm = scan
    solution = solve(task)
    planted = rms(verify(task, arm))
    assert solution.found
    assert len(solution.targets) == len(task.targets)
    # Of shapes within tolerance the gentlest is the best; the nearest fits better than what was planted.
    assert rms(solution.best.verification) < 1.05 * planted
    assert planted * 0.99 < min(rms(design.verification) for design in solution.designs) < planted
    assert np.all(solution.best.verification.misses <= 5e-3)


def test_the_fit_with_all_targets_is_better_than_with_the_part(scan):
    task, _ = scan
    of_part = solve(part_of(task, 0)).robot
    assert rms(solve(task).best.verification) < rms(verify(task, of_part))


@pytest.mark.parametrize("seed", range(3))
def test_joint_1_has_its_dead_zone_where_no_target_is_though_the_part_does_not_show_where(seed):
    task, _ = scanned(3000, tolerance=6e-3)
    assert solve(task, seed=seed).found


def test_the_worst_miss_is_levelled():
    task, _ = scanned(1500, tolerance=2e-3)
    worst = {
        objective: solve(replace(task, objective=objective)).best.verification.misses.max()
        for objective in Objective
    }
    assert worst[Objective.MINIMAX] < 0.95 * worst[Objective.LEAST_SQUARES]


def test_a_target_out_of_reach_is_named_though_it_is_not_of_the_part(scan):
    task, _ = scan
    beyond = PointTarget("beyond", np.array([2.0, 0.0, 0.3]))
    part = part_of(task, 0)
    missed = next(i for i in range(len(task.targets)) if task.targets[i].name not in part.table.names)
    targets = [*task.targets[:missed], beyond, *task.targets[missed + 1 :]]
    solution = solve(replace(task, targets=targets))
    assert solution.status.value == "proven_impossible"
    assert "beyond is " in solution.message


def test_a_table_is_a_sequence_of_its_targets():
    targets = tuple(PointTarget(f"t{i}", np.arange(3.0) + i, 1e-3 * (i + 1), 1.0 + i) for i in range(4))
    table = TargetTable.of(targets)
    for one, other in zip(targets, table, strict=True):
        assert (one.name, one.tolerance, one.weight) == (other.name, other.tolerance, other.weight)
        assert np.array_equal(one.position, other.position)
    assert [target.name for target in table[1:3]] == ["t1", "t2"]
    assert table.take(np.array([3, 0])).names == ("t3", "t0")
    assert len(table.followed_by(table)) == 8
    task = Task("table", planted_task(1, 1)[0].robot, targets)
    assert np.array_equal(task.tolerances, [target.tolerance for target in targets])
    assert np.array_equal(task.positions_in_base, [target.position for target in targets])
