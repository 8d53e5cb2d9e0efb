"""What blocks a task is named, by how much, and what is named does release it."""

from pathlib import Path

import numpy as np
import pytest
from planted_blocked import blocked_task

from synth.synthesis import explain, solve, verify
from synth.synthesis.solve import follow
from synth.task import load_task

PROBLEMS = Path(__file__).parents[1] / "problems"


@pytest.mark.parametrize(
    ("limit", "planted"), [("link length", 4e-3), ("joint 1", np.radians(3)), ("floor", 5e-3)]
)
def test_the_limit_that_is_too_tight_is_named_first(limit, planted):
    """No more is asked for than the planted arm needs; another arm may do with less."""
    task = blocked_task(limit, 1, lambda task: follow(task, (), starts=8).found)
    first = explain(follow(task, (), starts=8)).releases[0]
    assert first.limit == limit
    assert 0.0 < first.amount < 1.05 * planted
    assert verify(first.task, first.design.arm, first.design.verification.joints).found


def test_each_release_is_enough_and_the_base_is_told_last():
    solution = explain(solve(load_task(PROBLEMS / "out-of-reach/task.yaml")))
    assert [release.limit for release in solution.releases] == ["link length", "base"]
    for release in solution.releases:
        assert verify(release.task, release.design.arm, release.design.verification.joints).found
    longer, base = solution.releases
    # 1277.7 mm from P2 to the shelf, 1156.9 mm of robot, 1 mm of tolerance
    assert 0.1198 < longer.amount < 0.1250
    assert 0.1198 < base.amount < 0.1250
    assert "longer, up to" in longer.sentence
    assert base.task.base.position[2] > 0.1


def test_nothing_blocks_what_was_found():
    solution = solve(load_task(PROBLEMS / "one-target/task.yaml"))
    assert explain(solution) is solution


def test_to_stop_keeps_what_is_known():
    solution = solve(load_task(PROBLEMS / "out-of-reach/task.yaml"))
    assert explain(solution, stop=lambda: True).releases == ()
