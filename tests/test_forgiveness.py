"""What a hand's errors leave of a task, beside a plain Monte Carlo through nothing of the synthesis."""

from dataclasses import replace

import numpy as np
import pytest
from planted import planted_task
from scipy.spatial.transform import Rotation

from synth.robot import BasePose
from synth.synthesis.shapes import Postures, TargetsSeen
from synth.synthesis.shapes.shapes import Shapes
from synth.synthesis.wanted.forgiveness import hand_forgiveness, misses_after_a_hand


def unit_vectors(rng, count):
    vectors = rng.normal(size=(count, 3))
    return vectors / np.linalg.norm(vectors, axis=1)[:, None]


def least_distances(circles, target, limits):
    """Return the least distances from a target, on grids of joint 2 that get finer; joint 1 clipped."""
    centres, v, t, radius = circles
    theta2 = np.broadcast_to(np.linspace(limits.second.lower, limits.second.upper, 300), (len(v), 300))
    for _ in range(3):
        circle = np.sin(theta2)[..., None] * v[:, None] - np.cos(theta2)[..., None] * t[:, None]
        points = centres[:, None] + radius * circle
        rho, rho_target = np.hypot(points[..., 0], points[..., 1]), np.hypot(*target[:2])
        turn = np.arctan2(target[1], target[0]) - np.arctan2(points[..., 1], points[..., 0])
        turn = np.mod(turn - limits.base.middle + np.pi, 2 * np.pi) - np.pi + limits.base.middle
        beyond = turn - np.clip(turn, limits.base.lower, limits.base.upper)
        squared = (
            rho**2 + rho_target**2 - 2 * rho * rho_target * np.cos(beyond) + (points[..., 2] - target[2]) ** 2
        )
        best, step = np.argmin(squared, axis=1), np.ptp(theta2, axis=1) / (theta2.shape[1] - 1)
        middle = theta2[np.arange(len(v)), best]
        theta2 = middle[:, None] + step[:, None] * np.linspace(-1.0, 1.0, 21)
        theta2 = np.clip(theta2, limits.second.lower, limits.second.upper)
    return np.sqrt(squared.min(axis=1))


def by_brute_force(task, arm, count, seed):
    """Return the misses, m, after errors of a hand: circles moved, joint angles looked for on grids."""
    rng = np.random.default_rng(seed)
    frame, end = arm.end_frame
    shifts = rng.normal(9.64e-3, 2.06e-3, count)[:, None] * unit_vectors(rng, count)
    turns = Rotation.from_rotvec(
        np.radians(rng.normal(4.0, 1.2, count))[:, None] * unit_vectors(rng, count)
    ).as_matrix()
    centres = end + shifts + turns @ (arm.circle.centre - end)
    circles = centres, turns @ frame[:, 1], turns @ frame[:, 2], arm.circle.radius
    targets = arm.base.to_base(task.table.positions)
    return np.column_stack([least_distances(circles, x, task.robot.joint_limits) for x in targets])


@pytest.mark.parametrize(("seed", "count"), [(1, 1), (5, 4), (9, 8)])
def test_the_fixed_sample_agrees_with_ten_thousand_random_errors(seed, count):
    task, arm = planted_task(seed, count)
    targets = tuple(replace(t, tolerance=8e-3 + 4e-3 * (i % 2)) for i, t in enumerate(task.targets))
    task = replace(task, targets=targets)
    misses = by_brute_force(task, arm, 10_000, seed)
    forgiveness = hand_forgiveness(task, arm)
    # 128 errors: about a tenth of the spread, which is below the mean.
    assert forgiveness.expected_worst_miss == pytest.approx(misses.max(axis=1).mean(), rel=0.06)
    assert forgiveness.chance == pytest.approx((misses <= task.tolerances).all(axis=1).mean(), abs=0.06)


def test_where_the_arm_stands_does_not_matter():
    task, arm = planted_task(3, 4)
    base = BasePose([0.3, -0.2, 0.1], 0.7)
    moved = replace(
        task,
        base=base,
        targets=tuple(replace(t, position=base.to_task(t.position)) for t in task.targets),
    )
    one, other = hand_forgiveness(task, arm), hand_forgiveness(moved, replace(arm, base=base))
    assert other.expected_worst_miss == pytest.approx(one.expected_worst_miss, rel=1e-9)


def test_a_target_that_is_missed_already_counts_with_its_miss():
    task, arm = planted_task(3, 2)
    far = replace(task.targets[0], position=task.targets[0].position + [0.0, 0.0, 3.0])
    forgiveness = hand_forgiveness(replace(task, targets=(far, task.targets[1])), arm)
    _, miss = arm.closest_joints(far.position)
    assert forgiveness.expected_worst_miss == pytest.approx(float(miss), rel=0.02)
    assert forgiveness.chance == 0.0


def test_many_shapes_at_once_are_judged_as_one_by_one():
    task, arm = planted_task(3, 4)
    shapes = Shapes.sample(arm.robot, 15, np.random.default_rng(0))
    aims = TargetsSeen(task.positions_in_base, arm.robot.joint_limits)
    postures = Postures.nearest(aims, shapes.kinematics)
    together, _ = misses_after_a_hand(
        aims, task.tolerances, shapes.kinematics, shapes.end[1], postures.theta2
    )
    alone = [hand_forgiveness(task, shapes.arm(i, task.base)).expected_worst_miss for i in range(15)]
    assert np.allclose(together, alone, rtol=0.01)
