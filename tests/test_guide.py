"""Laws of the guide: rigid markers, points on the link, postures to hold, instructions."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from planted import planted_task
from planted_guide import (
    ARM,
    BASE,
    DESIGN,
    GUIDE,
    JOINTS,
    ROBOT,
    TASK,
    arms,
    make_design,
)

from synth.geometry import Box, Sphere
from synth.guide import MARKERS, instructions, make_guide
from synth.guide.instructions import (
    axis_sentence,
    hold_sentence,
    station_sentence,
)
from synth.guide.markers import SPACING, _stations, place
from synth.guide.posture import hold_posture
from synth.robot import ArmBody, BasePose, Interval, JointLimits, clear_of_obstacles
from synth.synthesis import (
    Design,
    verify,
)
from synth.task import Obstacle


def placements(arm):
    guide = make_guide(*make_design(arm, JOINTS, np.zeros((3, 3))))
    return guide, (place(arm, guide.stations, 0.0), guide.hold)


@given(arms)
def test_markers_have_the_distances_of_the_solution_at_both_angles(arm):
    guide = make_guide(*make_design(replace(arm, robot=ROBOT), JOINTS, np.zeros((3, 3))))
    assert guide.hold.joint1 == pytest.approx(math.pi)
    for placement in (place(arm, guide.stations, 0.0), guide.hold):
        difference = placement.markers[:, None] - placement.markers[None]
        np.testing.assert_allclose((difference**2).sum(-1), arm.squared_distances[:4, :4], atol=1e-12)


@given(arms)
def test_axis_2_passes_through_p3_p4_and_the_links_end(arm):
    guide, both = placements(arm)
    for placement in both:
        p3, p4 = placement.markers[2:]
        along = (p3 - placement.axis_point) @ placement.axis_direction
        assert along == pytest.approx(-arm.robot.tip_offset, abs=1e-12)
        np.testing.assert_allclose(placement.axis_point + along * placement.axis_direction, p3, atol=1e-12)
        np.testing.assert_allclose(p3 + arm.robot.d34 * placement.axis_direction, p4, atol=1e-12)
        np.testing.assert_allclose(placement.centreline[-1], placement.axis_point, atol=1e-12)
    assert guide.station_names[-1] == "END"


@given(arms)
def test_the_points_of_the_centreline_are_on_the_link_50_mm_apart(arm):
    guide, both = placements(arm)
    np.testing.assert_allclose(guide.stations[:-1], SPACING * np.arange(1, len(guide.stations)))
    assert guide.stations[-1] == arm.shape.length
    assert 0.0099 < guide.stations[-1] - guide.stations[-2] < 0.0601
    assert guide.station_names[:2] == ("L050", "L100")
    dense = np.linspace(0.0, arm.shape.length, 4001)
    link = arm.base.to_task(arm.shape.point_at(dense) + arm.base_joint[1])
    travelled = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(link, axis=0), axis=1)))
    for station, point in zip(guide.stations, both[0].centreline, strict=True):
        nearest = np.argmin(np.linalg.norm(link - point, axis=1))
        assert np.linalg.norm(link[nearest] - point) < 1e-4
        assert abs(travelled[nearest] - station) < 3e-4


def test_the_hold_set_is_the_zero_set_turned_about_axis_1():
    turn = BasePose(yaw=GUIDE.hold.joint1)
    for name, point in GUIDE.points(place(ARM, GUIDE.stations, 0.0)).items():
        turned = BASE.to_task(turn.to_task(BASE.to_base(point)))
        np.testing.assert_allclose(GUIDE.points(GUIDE.hold)[name], turned, atol=1e-12)
    assert tuple(GUIDE.points(GUIDE.hold))[:4] == MARKERS


@pytest.mark.parametrize(
    ("limits", "angle"),
    [((-1.0, 2.0), 0.0), ((0.0, 2.0), 0.0), ((0.2, 6.2), 3.2), ((-3.0, -1.0), -2.0)],
)
def test_joint_1_is_held_at_zero_or_in_the_middle_of_its_range(limits, angle):
    robot = replace(ROBOT, joint_limits=JointLimits(Interval(*limits), ROBOT.joint_limits.second))
    posture = hold_posture(replace(TASK, robot=robot), replace(ARM, robot=robot))
    assert math.degrees(posture.joint1) == pytest.approx(round(math.degrees(angle), 1), abs=1e-9)
    assert posture.joint2 == pytest.approx(math.pi)
    assert posture.clear


@given(
    st.floats(-200.0, 300.0), st.floats(0.02, 60.0), st.floats(90.0, 250.0), st.floats(0.02, 60.0),
)  # fmt: skip
def test_the_angles_to_hold_are_within_the_limits_as_they_are_printed(first, wide, second, high):
    ranges = [(first, first + wide), (second, second + high)]
    limits = JointLimits(*(Interval(*map(math.radians, each)) for each in ranges))
    robot = replace(ROBOT, joint_limits=limits)
    task, arm = replace(TASK, robot=robot, floor=None), replace(ARM, robot=robot)
    posture = hold_posture(task, arm)
    said = re.findall(r"-?\d+\.\d", hold_sentence(replace(GUIDE, posture=posture)))
    held = (posture.joint1, posture.joint2)
    for number, angle, (low, high_end) in zip(said, held, ranges, strict=True):
        if math.ceil(10.0 * low) > math.floor(10.0 * high_end):  # no such number is within
            assert low - 1e-9 <= math.degrees(angle) <= high_end + 1e-9
            continue
        assert low - 1e-6 <= float(number) <= high_end + 1e-6
        assert math.degrees(angle) == pytest.approx(float(number), abs=1e-6)  # and the points stand there


@pytest.mark.parametrize("length", [0.04, 0.09, 0.6, 8.0])
def test_the_point_on_the_link_that_the_words_name_is_one_of_the_table(length):
    guide = replace(GUIDE, stations=_stations(length))
    words = station_sentence(guide)
    named = re.findall(r"(L\d+) is the middle of the tube, (\d+) mm", words)
    assert "END" in words
    assert bool(named) == (len(guide.stations) > 1)
    for name, along in named:
        index = guide.station_names.index(name)
        assert 1e3 * guide.stations[index] == pytest.approx(float(along))


def test_the_posture_to_hold_is_clear_of_obstacles_and_the_nearest_that_is():
    body = ArmBody(ARM)
    middle = body.tube(np.array([0.5 * ARM.shape.length]))
    ball = BASE.to_task(BasePose(yaw=math.pi).to_task(middle))[
        0
    ]  # in the way in the middle of joint 1's range
    task = replace(TASK, obstacles=(Obstacle("ball", Sphere(ball, 0.08)),))
    posture = hold_posture(task, ARM)
    assert posture.clear
    assert 0.0 < abs(posture.joint1 - math.pi) < math.pi / 2
    assert ROBOT.joint_limits.base.contains(posture.joint1)
    assert clearance(task, posture) > 0.0
    nearer = posture.joint1 + math.copysign(math.radians(6.0), math.pi - posture.joint1)
    assert clearance(task, replace(posture, joint1=nearer)) < 0.0
    guide = make_guide(task, Design(ARM, verify(task, ARM)))
    assert "make room" not in hold_sentence(guide)


def test_where_no_posture_is_clear_the_sentence_says_so():
    box = Box(BASE.to_task([[0.0, 0.0, 0.5]])[0], np.array([3.0, 3.0, 0.5]))
    task = replace(TASK, obstacles=(Obstacle("a block", box),))
    assert not hold_posture(task, ARM).clear
    guide = make_guide(task, Design(ARM, verify(task, ARM)))
    assert "No posture was found in which the bent arm is clear of everything" in hold_sentence(guide)


def clearance(task, posture):
    joints = np.array([[posture.joint1, posture.joint2]])
    return float(clear_of_obstacles(ArmBody(ARM), joints, task.solids).min())


def test_axis_2_is_told_as_elevation_and_heading():
    hold = GUIDE.hold
    u = hold.axis_direction
    level = math.cos(hold.elevation)
    expected = [level * math.cos(hold.heading), level * math.sin(hold.heading), math.sin(hold.elevation)]
    np.testing.assert_allclose(u, expected, atol=1e-12)
    sentence = axis_sentence(GUIDE)
    assert (
        f"{abs(math.degrees(hold.elevation)):.1f} deg {'above' if u[2] > 0 else 'below'} horizontal"
        in sentence
    )
    assert f"heading {math.degrees(hold.heading):.1f} deg" in sentence
    upright = replace(GUIDE, hold=replace(hold, axis_direction=[0.0, 0.0, -1.0]))
    assert "is vertical, P4 below P3" in axis_sentence(upright)


def test_the_instructions_hold_what_a_tape_measures_and_what_is_cut():
    text = " ".join(instructions(GUIDE))
    s = np.sqrt(ARM.squared_distances)
    for i, j in ((1, 3), (1, 4), (2, 3), (2, 4)):
        assert f"d{i}{j} {1e3 * s[i - 1, j - 1]:.1f}" in text
    assert "Cut" not in text
    robot = replace(ROBOT, rigid_link=replace(ROBOT.rigid_link, d35=Interval(0.3, 0.5)))
    design = Design(replace(ARM, robot=robot), DESIGN.verification)
    first = instructions(make_guide(replace(TASK, robot=robot), design))[0]
    assert first.startswith("Cut the rigid link to d35 = 455.0 mm and d45 = 460.0 mm")


def test_a_tolerance_that_no_hand_holds_is_called_that():
    tight, loose = (make_design(ARM, JOINTS, np.zeros((3, 3)), tolerance) for tolerance in (1e-3, 0.1))
    assert "No hand holds this at the first try" in instructions(make_guide(*tight))[-1]
    last = instructions(make_guide(*loose))[-1]
    assert last.startswith("At the first try a hand as published")
    assert "in about 99 % of tries" in last


def test_a_radius_to_bend_no_tighter_than_is_never_told_too_small():
    robot = replace(ARM.robot, link=replace(ARM.robot.link, min_bend_radius=0.10004))
    told = " ".join(instructions(replace(GUIDE, arm=replace(ARM, robot=robot))))
    assert "nowhere tighter than to a radius of 100.1 mm" in told


def test_the_guide_of_a_shape_is_made_once():
    task, arm = planted_task(2, 3)
    design = Design(arm, verify(task, arm))
    assert make_guide(task, design) is make_guide(task, design)
    assert make_guide(replace(task, name="other"), design) is not make_guide(task, design)
