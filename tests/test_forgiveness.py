"""What a shape forgives the hand: against tries of another random source, and in the limits of tolerance."""

import math
from dataclasses import replace

import numpy as np
import pytest
from planted import planted_task

from synth.robot.closest import closest_joints
from synth.robot.kinematics import Kinematics
from synth.synthesis import hand_forgiveness
from synth.synthesis.displaced import misses_displaced, rotations

TASK, ARM = planted_task(1, 4)


def with_tolerance(tolerance):
    return replace(TASK, targets=replace(TASK.table, tolerances=np.full(len(TASK.targets), tolerance)))


def brute(rng, count):
    """Worst misses of tries by another generator, each arm by the exact closest joints: shape (count,), m."""
    rotation, end = ARM.end_frame
    worst = []
    for _ in range(count):
        shift, turn = rng.normal(size=3), rng.normal(size=3)
        shift *= rng.normal(9.64e-3, 2.06e-3) / np.linalg.norm(shift)
        turn *= rng.normal(math.radians(4.0), math.radians(1.2)) / np.linalg.norm(turn)
        matrix = rotations(turn[None])[0]
        centre = end + shift + matrix @ (ARM.circle.centre - end)
        joints = Kinematics(matrix @ rotation, centre, np.asarray(ARM.circle.radius))
        worst.append(closest_joints(joints, TASK.positions, ARM.robot.joint_limits)[1].max())
    return np.array(worst)


def test_it_is_what_many_tries_of_a_hand_give():
    worst = brute(np.random.default_rng(11), 1500)
    for tolerance in (5e-3, 10e-3, 20e-3):
        forgiveness = hand_forgiveness(with_tolerance(tolerance), ARM)
        # Both are samples: 3 standard deviations of 256 tries.
        assert forgiveness.chance == pytest.approx(float(np.mean(worst <= tolerance)), abs=0.1)
        spread = 3.5 * worst.std() / 16.0
        assert forgiveness.expected_worst_miss == pytest.approx(worst.mean(), abs=spread)


def test_a_tolerance_wide_enough_is_always_met_and_a_narrow_one_never():
    assert hand_forgiveness(with_tolerance(1.0), ARM).chance == 1.0
    assert hand_forgiveness(with_tolerance(1e-6), ARM).chance == 0.0
    assert hand_forgiveness(TASK, ARM) == hand_forgiveness(TASK, ARM)


def test_without_an_error_nothing_is_missed_by_more():
    misses = misses_displaced(ARM, TASK.positions, np.zeros((1, 3)), np.eye(3)[None])
    np.testing.assert_allclose(misses[0], ARM.closest_joints(TASK.table.positions)[1], atol=1e-6)


def test_rotations_are_those_of_rodrigues():
    vector = np.array([[0.3, -0.2, 0.5], [0.0, 0.0, 0.0]])
    first, second = rotations(vector)
    np.testing.assert_allclose(first @ first.T, np.eye(3), atol=1e-14)
    np.testing.assert_allclose(first @ vector[0], vector[0], atol=1e-14)
    assert np.trace(first) == pytest.approx(1.0 + 2.0 * math.cos(np.linalg.norm(vector[0])))
    np.testing.assert_array_equal(second, np.eye(3))
