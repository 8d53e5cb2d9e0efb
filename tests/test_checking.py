"""The check of a link: what it promises is what happens, and what it asks for helps."""

from dataclasses import replace

import numpy as np
import pytest
from planted import ROBOT, planted_task
from standing import BARS, HOLD, SIGMA, seen

from synth.geometry import Sphere
from synth.guide.loop import checking
from synth.guide.loop.aim import aimed, best_aims, towards
from synth.guide.loop.check_text import check_text, way_words
from synth.guide.loop.checking import Verdict, best_joints, check_arm
from synth.guide.loop.outlook import outlook
from synth.guide.loop.settings import best_settings, with_settings
from synth.guide.loop.trying_on import value_of_trying
from synth.measurement import StandingArm, fit_arm, joints_closest_to, joints_following
from synth.measurement.hand import Hand, random_errors
from synth.rounding import rounded_up
from synth.synthesis import Design, solve, verify
from synth.task import Obstacle

HAND = Hand()
OFF = np.array([0.006, -0.005, 0.004, 0.03, 0.02, -0.04])


@pytest.fixture(scope="module", params=[(5, 3), (11, 5)])
def scene(request):
    task, planted = planted_task(*request.param)
    task = replace(task, targets=tuple(replace(each, tolerance=5e-3) for each in task.targets))
    solution = solve(task)
    assert solution.found
    # First a shape that uses nothing of the tolerances: what is said of it does not hang on the search.
    designs = (Design(planted, verify(task, planted)), *solution.designs)
    return task, designs, StandingArm.of(planted, HOLD)


def fit(scene, true, names=BARS, rng=None, *, base_calibrated=True):
    return fit_arm(seen(true, names, rng), scene[2], ROBOT.tip_offset, SIGMA, base_calibrated=base_calibrated)


def misses(arm, joints, task):
    return np.linalg.norm(arm.forward(joints) - task.positions_in_base, axis=-1)


def test_a_link_in_its_place_is_locked(scene):
    task, designs, wanted = scene
    check = check_arm(task, designs, fit(scene, wanted))
    assert check.verdict is Verdict.LOCK
    assert check.correction is None
    # No worse than the shape is by itself, which uses its tolerance, but for what the markers leave open.
    assert misses(wanted, check.now.joints, task).max() < designs[0].verification.misses.max() + 1e-3
    assert "lock it" in check_text(check)


def test_a_link_off_its_place_is_corrected(scene):
    task, designs, wanted = scene
    true = wanted.moved(OFF)
    check = check_arm(task, designs, fit(scene, true, rng=np.random.default_rng(0)))
    assert check.verdict is Verdict.CORRECT
    after = true.moved(np.concatenate([check.correction.move, check.correction.rotate]))
    before = misses(true, joints_closest_to(true, task.positions_in_base), task).max()
    assert misses(after, joints_closest_to(after, task.positions_in_base), task).max() < 0.35 * before
    assert check.correction.shape is not None
    assert "move the link's end" in check_text(check)


def test_four_points_never_lock_and_ask_for_better_markers(scene):
    task, designs, wanted = scene
    check = check_arm(task, designs, fit(scene, wanted, "P1 P2 P3 P4", base_calibrated=False), confidence=0.5)
    assert check.verdict is not Verdict.LOCK
    text = check_text(check)
    for asked in ("P5 must be seen", "A2:150", "--base-calibrated"):
        assert asked in text


def test_where_joint_2_has_no_zero_a_marker_is_asked_for_and_no_move(scene):
    """No move of the link helps much there: so it was told, and what it brings is told still."""
    task, designs, wanted = scene
    measured = fit(scene, wanted.moved(OFF), "P1 P2 P3 P4 A2:-150 A2:150")
    check = check_arm(task, designs, measured)
    after, now = check.correction.outlook.expected_worst, check.stiffened.expected_worst
    assert after > 0.7 * now
    first = check_text(check).splitlines()[2]
    assert first.startswith("• the zero of joint 2 is not shown: P5 must be seen")
    assert (
        f"even after the best correction a practised hand has a largest miss of {rounded_up(after)}" in first
    )
    assert "move the link's end" not in check_text(check)


def test_without_corrections_left_nothing_is_asked(scene):
    task, designs, wanted = scene
    check = check_arm(task, designs, fit(scene, wanted.moved(OFF)), corrections=0)
    assert check.verdict is Verdict.BEST_POSSIBLE
    assert check.correction is None


def test_a_small_error_is_left_alone_though_it_is_no_lock(scene):
    task, designs, wanted = scene
    task = replace(task, targets=tuple(replace(each, tolerance=0.5e-3) for each in task.targets))
    check = check_arm(task, designs, fit(scene, wanted.moved(0.05 * OFF)))
    assert check.verdict is Verdict.BEST_POSSIBLE
    assert check.probability < 0.95


def test_the_chances_told_are_what_happens(scene):
    task, designs, wanted = scene
    rng = np.random.default_rng(1)
    told, within = [], []
    for _ in range(80):
        # Far more widely spread than the camera errs: else what is known of the spread would count, too.
        true = wanted.moved(rng.uniform(0.0, 0.6) * random_errors(HAND.placement, 1, rng)[0])
        measured = fit(scene, true, BARS, rng)
        joints = best_joints(measured.arm, task, designs[0].verification.joints)
        view = outlook(measured, joints, task.positions_in_base, task.tolerances)
        told.append(view.probability_all_within)
        within.append((misses(true, joints, task) <= task.tolerances).all())
    chance, share = 1.0 - np.mean(told), 1.0 - np.mean(within)
    spread = np.sqrt(np.sum(np.array(told) * (1.0 - np.array(told)))) / len(told)
    assert abs(chance - share) < 3.0 * spread + 0.01


def test_an_aim_meets_the_task_and_is_nearer_than_the_design(scene):
    task, designs, wanted = scene
    arm = wanted.moved(OFF)
    weights = np.ones(len(task.targets))
    joints = joints_closest_to(arm, task.positions_in_base)
    _, move, there = best_aims(
        arm, [d.arm for d in designs], joints, task.positions_in_base, weights, HAND, 0.05
    )[0]
    assert misses(arm.moved(move), there, task).max() < 1.5e-3
    _, near, _ = best_aims(arm, [designs[0].arm], joints, task.positions_in_base, weights, HAND, 0.4)[0]
    direct = towards(arm, designs[0].arm)

    def size(by):
        return np.hypot(np.linalg.norm(by[:3]), 0.15 * np.linalg.norm(by[3:]))

    assert size(near) <= size(direct) + 1e-3


def test_the_cost_of_an_aim_is_the_mean_square_over_errors_of_the_hand(scene):
    task, _, wanted = scene
    # Of a hand so fine that the surface is flat over its errors.
    hand = replace(HAND, floor=(0.25e-3, np.radians(0.085)))
    joints, limits = joints_closest_to(wanted, task.positions_in_base), ROBOT.joint_limits
    # A joint at its limit is held for half of the errors only.
    inner = (joints[:, 1] > limits.second.lower + 0.05) & (joints[:, 1] < limits.second.upper - 0.05)
    assert inner.sum() >= 2
    joints, targets = joints[inner], task.positions_in_base[inner]
    move, there, cost = aimed(wanted, np.zeros(6), joints, targets, np.ones(len(targets)), hand, 0.0)
    arms = wanted.moved(move)
    arms = arms.displaced(
        np.hstack([np.zeros((4000, 5)), random_errors(hand.floor, 4000, np.random.default_rng(0))])
    )
    squares = np.sum((arms.forward(joints_following(arms, there, targets)) - targets) ** 2, axis=(1, 2))
    assert np.mean(squares) == pytest.approx(cost, rel=0.1)


def test_towards_a_design_is_a_turn_about_axis_1_and_a_roll_away_from_it(scene):
    _, designs, wanted = scene
    from synth.measurement import rotation_matrix  # noqa: PLC0415

    turn = rotation_matrix(np.array([0.0, 0.0, 0.4]))
    roll = rotation_matrix(0.3 * wanted.axis)
    arm = replace(wanted, end=turn @ wanted.end, frame=turn @ roll @ wanted.frame)
    assert np.abs(towards(arm, designs[0].arm)).max() < 1e-9


def test_more_tries_are_worth_more(scene):
    task, _, wanted = scene
    measured = fit(scene, wanted.moved(OFF))
    joints = joints_closest_to(wanted, task.positions_in_base)
    values = [
        value_of_trying(measured, -OFF, joints, task.positions_in_base, task.tolerances, HAND, k)[0]
        for k in (1, 2, 3)
    ]
    assert values[0] > values[1] > values[2] > 0.0


def test_settings_take_out_most_of_what_is_left(scene):
    task, designs, wanted = scene
    true = wanted.moved(0.5 * OFF)
    measured = fit(scene, true)
    joints = best_joints(measured.arm, task, designs[0].verification.joints)
    settings = best_settings(task, ROBOT, measured, joints)
    values = np.array([*settings.base, settings.along, settings.radius])
    assert np.abs(values).max() <= 0.03 + 1e-12
    after = with_settings(true, values)
    left = misses(after, settings.outlook.joints, task).max()
    assert left < max(0.4 * misses(true, joints, task).max(), 0.5e-3)
    p3 = after.end - ROBOT.tip_offset * after.axis
    p5 = after.forward(np.array([[HOLD, 1.0]]))[0]
    assert np.linalg.norm(p5 - p3) == pytest.approx(settings.d35)
    assert np.linalg.norm(p5 - p3 - ROBOT.d34 * after.axis) == pytest.approx(settings.d45)


def test_settings_keep_what_may_not_be_set(scene):
    task, designs, wanted = scene
    measured = fit(scene, wanted.moved(0.5 * OFF))
    settings = best_settings(task, ROBOT, measured, designs[0].verification.joints, tool=0.0)
    assert settings.along == settings.radius == 0.0
    assert settings.d35 == pytest.approx(ROBOT.rigid_link.d35.lower)


@pytest.mark.parametrize(
    ("way", "words"),
    [
        ([0.0, 0.0, -0.008], "8.0 mm down"),
        ([0.003, 0.0, -0.008], "8.0 mm down and 3.0 mm towards +x"),
        ([0.003, -0.004, 0.008], "8.0 mm up, 4.0 mm towards -y and 3.0 mm towards +x"),
        ([1e-4, 0.0, 0.0], ""),
    ],
)
def test_a_way_in_words(way, words):
    assert way_words(np.array(way), 0.5e-3) == words


def test_an_aim_that_is_blocked_is_left_for_a_nearer_one_or_a_design(scene, monkeypatch):
    task, designs, wanted = scene
    seen_there = fit(scene, wanted.moved(OFF), rng=np.random.default_rng(0))
    free = check_arm(task, designs, seen_there).correction
    answers = iter([False, True])
    monkeypatch.setattr(checking, "is_clear", lambda _task, _arm: next(answers))
    nearer = check_arm(task, designs, seen_there).correction
    assert nearer.shape is not None
    assert not np.allclose(nearer.move, free.move, atol=1e-5)
    monkeypatch.setattr(checking, "is_clear", lambda _task, _arm: False)
    at_design = check_arm(task, designs, seen_there, corrections=3).correction
    assert at_design is None or at_design.shape is None


def test_what_is_in_the_way_of_a_shape_is_seen(scene):
    task, designs, _ = scene
    arm = designs[0].arm
    for where, clear in (((0.0, 0.0, 0.058), False), ((2.0, 2.0, 2.0), True)):  # P2, where every link begins
        ball = Obstacle("ball", Sphere(np.array(where), 0.01))
        assert checking.is_clear(replace(task, obstacles=(ball,)), arm) is clear
