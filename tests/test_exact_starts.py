"""Where algebra and search meet: exact designs as start points, and as the reason why there are none."""

from dataclasses import astuple, replace

import numpy as np
import pytest
from planted import ROBOT, planted_task

from synth.geometry import Invariants
from synth.robot import Interval, RigidLink
from synth.synthesis import Status, solve
from synth.synthesis.shapes.shapes import Shapes
from synth.synthesis.starts.exact_arms import arms_near_all, arms_through_all, exact_arms
from synth.synthesis.starts.random_shapes import RandomShapes
from synth.task import PointTarget, Task, Topology


def is_design(invariants, designs, tolerance=1e-6):
    """Whether invariants are those of a design to a tolerance (m, rad), axis 2 turned round or not."""
    a, alpha, z0, h, radius = astuple(invariants)
    forms = np.array([(a, alpha, z0, h, radius), (a, np.pi - alpha, z0, -h, radius)])
    return any(np.abs(forms - astuple(design)).max(axis=1).min() <= tolerance for design in designs)


@pytest.mark.parametrize("seed", range(8))
def test_four_planted_targets_have_the_planted_design_and_the_answer_is_one_of_them(seed):
    task, arm = planted_task(seed, 4)
    designs = exact_arms(task)
    assert is_design(arm.invariants, designs)
    # To a tolerance that leaves nothing to choose: else a shape with margins is worth a miss within it.
    exactly = replace(task, targets=replace(task.table, tolerances=np.full(4, 1e-6)))
    solution = solve(exactly)
    assert solution.found
    # The link can take the planted design, which misses nothing: nor may the answer.
    assert max(target.miss for target in solution.targets) < 1e-6
    # The gentler bend is worth a miss of some nanometres, which moves ill-conditioned designs by more.
    assert is_design(solution.robot.invariants, designs, tolerance=1e-3)


def test_five_targets_of_a_free_rigid_link_have_the_planted_design():
    task, arm = planted_task(3, 5)
    assert exact_arms(task) is None
    free = replace(ROBOT, rigid_link=RigidLink(Interval(0.3, 0.6), Interval(0.3, 0.6)))
    assert is_design(arm.invariants, exact_arms(replace(task, robot=free)))


@pytest.mark.parametrize("count", [1, 3, 5, 6])
def test_other_counts_of_targets_have_no_finite_answer(count):
    assert exact_arms(planted_task(1, count)[0]) is None


def test_targets_in_a_plane_or_on_a_sphere_have_no_finite_answer():
    for topology in (Topology.SCARA, Topology.SPHERICAL):
        assert exact_arms(planted_task(2, 4, topology)[0]) is None


def test_the_nearest_shapes_are_near_whichever_way_the_design_lies():
    task, arm = planted_task(5, 4)
    shapes = Shapes.sample(ROBOT, 20_000, np.random.default_rng(0))
    chosen = RandomShapes(shapes).nearest_to_arms(np.array([astuple(arm.invariants)]), 5)
    assert 5 <= len(chosen) <= 20
    misses = [shapes.arm(int(i), task.base).closest_joints(task.positions_in_base)[1].max() for i in chosen]
    everyone = [shapes.arm(i, task.base).closest_joints(task.positions_in_base)[1].max() for i in range(100)]
    assert np.median(misses) < 0.5 * np.median(everyone)


@pytest.mark.parametrize("count", [4, 5, 8, 40])
def test_an_arm_through_all_of_many_targets_is_found_from_few_of_them(count):
    task, arm = planted_task(7, count)
    through = [Invariants(*row) for row in arms_through_all(task).tolist()]
    assert is_design(arm.invariants, through)
    assert len(through) == 1 or count == 4


def test_targets_off_a_surface_by_more_than_their_tolerance_have_no_arm_through_all():
    task, arm = planted_task(7, 8)
    off = np.random.default_rng(0).normal(scale=5e-3, size=(8, 3))
    noisy = replace(task, targets=replace(task.table, positions=task.table.positions + off))
    assert not len(arms_through_all(noisy))
    near = arms_near_all(noisy)
    assert is_design(arm.invariants, [Invariants(*row) for row in near.tolist()], tolerance=0.05)


def test_too_few_targets_and_a_free_base_leave_algebra_without_an_answer():
    assert arms_near_all(planted_task(1, 3)[0]).shape == (0, 5)


def test_targets_without_a_real_design_are_reported_with_that_reason():
    positions = [[0.45, 0.1, 0.2], [0.1, 0.5, 0.45], [-0.3, 0.2, 0.6], [0.2, -0.6, 0.75]]
    task = Task("none", ROBOT, tuple(PointTarget(f"p{i}", p, 1e-4) for i, p in enumerate(positions)))
    assert exact_arms(task) == ()
    solution = solve(task)
    assert solution.status is Status.BEST_EFFORT
    assert any("by algebra" in reason for reason in solution.reasons)
