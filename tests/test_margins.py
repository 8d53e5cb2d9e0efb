"""Distances from limits, what is missing of them, and tasks whose limits are drawn in by them."""

import math
from dataclasses import replace

import numpy as np
import pytest
from planted import ROBOT, arm_of, planted_task

from synth.robot import Interval, JointLimits, LinkShape
from synth.synthesis import verify
from synth.synthesis.wanted.margins import Margins, drawn_in, joint_shortfalls

FAR = np.array([math.inf])


def margins(length=0.6, bend=4.0, joints=(3.0, 3.0), clearances=FAR):
    shape = LinkShape([[bend, 0.0]] * 4, [length / 4] * 4)
    return Margins.of(arm_of(shape), np.array([joints]), clearances)


def test_margins_are_distances_from_the_nearer_limit():
    found = margins(joints=np.radians([40.0, 300.0]), clearances=np.array([0.03, 0.01]))
    assert found.joint1 == pytest.approx(math.radians(30.0))
    assert found.joint2 == pytest.approx(math.radians(7.0))
    assert found.length == pytest.approx(0.05)
    assert found.bend_radius == pytest.approx(0.25 - 0.11)
    assert found.total_bend == pytest.approx(5.0 - 2.4)
    assert found.clearance == 0.01


@pytest.mark.parametrize(
    ("changes", "missing"),
    [
        ({}, 0.0),
        ({"joints": np.radians([15.0, 180.0])}, 0.0),
        ({"joints": np.radians([12.5, 180.0])}, 0.5),
        ({"joints": np.radians([10.0, 307.0])}, 2.0),
        ({"length": 0.7}, 1.0),
        ({"length": 0.697}, 0.4),
        ({"clearances": np.array([0.001])}, 0.8),
        ({"bend": 1 / 0.11, "length": 0.54}, 2.0 + (1 - (5 - 0.54 / 0.11) / 0.25)),
    ],
)
def test_what_is_missing_counts_in_shares(changes, missing):
    assert margins(**changes).shortfall(Margins.wanted(ROBOT)) == pytest.approx(missing, abs=1e-9)


def test_what_is_fixed_or_has_no_limit_asks_for_no_margin():
    robot = replace(ROBOT, link=replace(ROBOT.link, length=Interval.fixed(0.6), max_total_bend=math.inf))
    arm = replace(arm_of(LinkShape([[4.0, 0.0]] * 4, [0.15] * 4)), robot=robot)
    found = Margins.of(arm, np.array([[3.0, 3.0]]), FAR)
    assert found.shortfall(Margins.wanted(robot)) == 0.0


def test_of_a_narrow_range_a_part_is_left():
    robot = replace(ROBOT, joint_limits=JointLimits(Interval(1.0, 1.1), Interval(1.0, 5.0)))
    assert Margins.wanted(robot).joint1 == pytest.approx(0.025)
    narrow = drawn_in(replace(planted_task(1, 2)[0], robot=robot)).robot.joint_limits
    assert (narrow.base.lower, narrow.base.upper) == pytest.approx((1.025, 1.075))
    assert narrow.second.lower == pytest.approx(1.0 + math.radians(5.0))


def test_postures_miss_of_the_margins_of_both_joints():
    joints = np.radians([[[180.0, 180.0], [10.0, 180.0]], [[10.0, 53.0], [347.5, 180.0]]])
    assert joint_shortfalls(ROBOT, joints) == pytest.approx(np.array([[0.0, 1.0], [2.0, 0.5]]))


@pytest.mark.parametrize("seed", range(5))
def test_a_shape_within_limits_drawn_in_has_all_margins(seed):
    task, arm = planted_task(seed, 3)
    narrow = drawn_in(task)
    check = verify(narrow, replace(arm, robot=narrow.robot))
    found = Margins.of(arm, check.joints, check.clearances)
    limits = {v.limit for v in check.violations if v.limit not in {"itself", "floor: link"}}
    assert bool(limits) == (found.shortfall(Margins.wanted(ROBOT)) > 1e-6)
