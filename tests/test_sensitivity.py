"""Tolerances of the shape mean what they say: by forward kinematics, in many directions."""

import math
import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from planted_guide import (
    ARM,
    FREE,
    JOINTS,
    ROBOT,
    arms,
    make_arm,
    make_design,
)

from synth.guide import make_guide
from synth.guide.instructions import (
    tolerance_sentences,
)
from synth.guide.sensitivity import shape_tolerance, tilt_rates
from synth.robot.closest_joints import closest_joints
from synth.robot.kinematics import Kinematics


def worst_excess(task, arm, shifts, tilts):
    """The largest miss over its tolerance once axis 2 is shifted, and tilted about the link's end.

    Rodrigues' rotation and the closest joint angles, for shifts and tilts of shape (k, 3) at once.
    """
    shifts, tilts = np.broadcast_arrays(shifts, tilts)
    rotation, end = arm.end_frame
    angle = np.linalg.norm(tilts, axis=1)[:, None, None]
    cross = np.cross(np.eye(3), -(tilts[:, None] / np.maximum(angle, 1e-300)))
    turn = np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross
    radius = np.asarray(arm.circle.radius)
    centres = end + shifts + turn @ (arm.circle.centre - end)
    misses = [
        closest_joints(Kinematics(frame, centre, radius), task.positions_in_base, arm.robot.joint_limits)[1]
        for frame, centre in zip(turn @ rotation, centres, strict=True)
    ]
    return (np.array(misses) / task.tolerances).max()


def tilts_across(arm, count=180):
    """Unit tilts across axis 2, all around it."""
    angles = np.linspace(0.0, 2.0 * math.pi, count, endpoint=False)[:, None]
    rotation, _ = arm.end_frame
    return np.cos(angles) * rotation[:, 1] + np.sin(angles) * rotation[:, 2]


def directions(rng, count):
    points = rng.normal(size=(count, 3))
    return points / np.linalg.norm(points, axis=1, keepdims=True)


@pytest.mark.parametrize("seed", range(6))
def test_the_tolerance_is_the_smallest_error_that_loses_a_target(seed):
    rng = np.random.default_rng(seed)
    arm = make_arm(rng.uniform(-5.0, 5.0, (3, 2)), robot=(ROBOT, FREE)[seed % 2])
    # A small tolerance: the law is one of first order.
    offsets = directions(rng, 3) * (0.0, 1e-5, 3e-5)[seed % 3]
    task, design = make_design(arm, JOINTS, offsets, tolerance=1e-4)
    tolerance = shape_tolerance(task, design)
    tilts, shifts = tilts_across(arm), directions(rng, 180)
    assert worst_excess(task, arm, np.zeros(3), tolerance.direction * tilts) == pytest.approx(1.0, abs=0.01)
    assert 0.95 < worst_excess(task, arm, tolerance.position * shifts, np.zeros(3)) < 1.0 + 1e-4
    half = 0.5 * tolerance.position * shifts, 0.5 * tolerance.direction * tilts
    assert worst_excess(task, arm, *half) < 1.01


def test_bending_a_real_arm_loses_what_the_rates_say():
    """Errors of the arcs move and tilt axis 2; together they account for the change of the miss."""
    rng = np.random.default_rng(5)
    task, design = make_design(ARM, JOINTS, directions(rng, 3) * 1e-3)
    check, (rotation, end) = design.verification, ARM.end_frame
    for _ in range(20):
        bent = make_arm(np.array(ARM.shape.curvatures) + 1e-5 * rng.normal(size=(3, 2)))
        new_rotation, new_end = bent.end_frame
        skew = new_rotation @ rotation.T
        tilt = 0.5 * np.array([skew[2, 1] - skew[1, 2], skew[0, 2] - skew[2, 0], skew[1, 0] - skew[0, 1]])
        across = tilt - tilt @ rotation[:, 0] * rotation[:, 0]
        _, misses = bent.closest_joints(task.table.positions)
        rates = tilt_rates(ARM, task.table.positions, check.joints)
        bounds = np.linalg.norm(new_end - end) + rates * np.linalg.norm(across)
        assert np.all(np.abs(misses - check.misses) <= bounds * (1.0 + 1e-2) + 1e-9)


def test_at_a_joint_limit_the_worst_tilt_may_push_past_the_limit():
    lower = ROBOT.joint_limits.second.lower
    task, design = make_design(ARM, [[2.0, lower]], np.zeros((1, 3)), tolerance=1e-4)
    tolerance = shape_tolerance(task, design)
    worst = worst_excess(task, ARM, np.zeros(3), tolerance.direction * tilts_across(ARM))
    assert worst == pytest.approx(1.0, abs=0.01)


@given(arms, st.floats(-math.pi, math.pi), st.floats(0.0, 2.0 * math.pi))
def test_no_tilt_moves_p5_faster_than_its_distance_from_the_links_end(arm, theta1, theta2):
    point = arm.forward_kinematics(theta1, theta2)
    (rate,) = tilt_rates(arm, point[None], np.array([[theta1, theta2]]))
    lever = np.linalg.norm(arm.kinematics.forward(0.0, theta2) - arm.end_frame[1])
    assert 0.0 <= rate <= lever * (1.0 + 1e-9)


def test_a_large_tilt_is_no_number_to_keep():
    """One target with a huge tolerance: no tilt that a hand can make loses it."""
    task, design = make_design(ARM, JOINTS[:1], np.zeros((1, 3)), tolerance=0.9)
    guide = make_guide(task, design)
    (sentence,) = tolerance_sentences(guide)
    assert "its direction matters little: a tilt of 10.00 deg alone loses no target" in sentence
    assert worst_excess(task, ARM, np.zeros(3), guide.tolerance.direction * tilts_across(ARM)) <= 1.0


@pytest.mark.parametrize("tolerance", [2e-4, 2e-3, 0.02, 0.05])
def test_an_error_of_the_size_that_is_told_loses_no_target(tolerance):
    """Not to first order only: by forward kinematics, in many directions, at the number that is printed."""
    task, design = make_design(ARM, JOINTS, np.zeros((3, 3)), tolerance)
    told = " ".join(tolerance_sentences(make_guide(task, design)))
    shift = 1e-3 * float(re.search(r"within ([\d.]+) mm", told)[1])
    tilt = math.radians(float(re.search(r"([\d.]+) deg", told)[1]))
    assert worst_excess(task, ARM, np.zeros(3), tilt * tilts_across(ARM)) <= 1.0 + 1e-4
    assert (
        worst_excess(task, ARM, shift * directions(np.random.default_rng(1), 180), np.zeros(3)) <= 1.0 + 1e-9
    )


def test_a_joint_that_turns_all_round_has_no_limit_at_its_end():
    arm = make_arm(robot=FREE)
    joints = np.array([[0.0, 2.0], [math.pi, 2.0], [math.pi - 1e-3, 2.0]])
    rates = tilt_rates(arm, arm.forward_kinematics(*joints.T), joints)
    np.testing.assert_allclose(rates, rates[0])


def test_the_rates_of_many_targets_are_those_of_each(monkeypatch):
    """Also at the limits of either joint and of both, on the surface and off it; and P5 is asked for once."""
    base, second = ROBOT.joint_limits.base, ROBOT.joint_limits.second
    joints = np.array(
        [[a, b] for a in (base.lower, 2.0, base.upper) for b in (second.lower, 2.0, second.upper)]
    )
    points = ARM.forward_kinematics(*np.tile(joints, (2, 1)).T)
    points[9:] += 1e-3 * directions(np.random.default_rng(2), 9)
    joints, _ = ARM.closest_joints(points)
    alone = [tilt_rates(ARM, points[[i]], joints[[i]])[0] for i in range(18)]
    asked, forward = [], Kinematics.forward
    monkeypatch.setattr(Kinematics, "forward", lambda *given: asked.append(1) or forward(*given))
    rates = tilt_rates(ARM, points, joints)
    assert len(asked) == 1
    np.testing.assert_allclose(rates, alone, rtol=1e-12)
    levers = np.linalg.norm(forward(ARM.kinematics, 0.0, joints[:, 1]) - ARM.end_frame[1], axis=1)
    np.testing.assert_allclose(rates[[0, 2, 6, 8]], levers[[0, 2, 6, 8]])  # no joint can make the best of it
    assert rates[4] < 0.9 * levers[4]
