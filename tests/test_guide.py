"""Laws of the guide: rigid markers, points on the link, and tolerances that mean what they say."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from planted import planted_task

from synth.errors import SynthError
from synth.geometry import Box, Sphere
from synth.guide import MARKERS, guide_text, instructions, make_guide, solution_text, summary_text
from synth.guide.instructions import (
    axis_sentence,
    hold_sentence,
    link_sentence,
    station_sentence,
    tolerance_sentences,
)
from synth.guide.markers import SPACING, _stations, place
from synth.guide.posture import hold_posture
from synth.guide.sensitivity import ShapeTolerance, shape_tolerance, tilt_rate
from synth.guide.text import clearance_told, help_told
from synth.robot import MOST_CLEARANCE, PRESETS, Arm, ArmBody, BasePose, Interval, JointLimits, LinkShape
from synth.robot.closest_joints import closest_joints
from synth.robot.kinematics import Kinematics
from synth.synthesis import Bound, Design, Release, Solution, Status, Timing, showing, verify
from synth.synthesis.wanted.ways import Motion
from synth.task import DEFAULT_TOLERANCE, Obstacle, PointTarget, Task

ROBOT = PRESETS["malleable-2dof"]
FREE = replace(ROBOT, joint_limits=JointLimits())
BASE = BasePose([0.1, -0.2, 0.05], 0.7)
TIMING = Timing(1.25, 0.5, 0.5, 0.25)


def make_arm(curvatures=((3.0, 1.0), (-2.0, 4.0), (1.0, 5.0)), length=0.63, robot=ROBOT, base=BASE):
    shape = LinkShape(curvatures, np.full(len(curvatures), length / len(curvatures)))
    return Arm(robot, shape, 0.455, 0.460, base)


def make_design(arm, joints, offsets, tolerance=2e-3):
    """A task whose targets are some way off what an arm reaches, and the design that does it."""
    points = arm.forward_kinematics(*np.asarray(joints).T) + np.asarray(offsets)
    targets = tuple(PointTarget(f"t{i}", point, tolerance) for i, point in enumerate(points))
    task = Task("a task", arm.robot, targets, arm.base, floor=None)
    return task, Design(arm, verify(task, arm))


ARM = make_arm()
JOINTS = [[1.0, 2.0], [4.0, 3.3], [2.5, 4.6]]
TASK, DESIGN = make_design(ARM, JOINTS, np.zeros((3, 3)))
GUIDE = make_guide(TASK, DESIGN)
SOLUTION = Solution(TASK, Status.FOUND, Status.FOUND.sentence, (), 7, (DESIGN,), 3, TIMING)
NOTHING = replace(SOLUTION, status=Status.FAILED, reasons=("no", "never"), designs=())

curvature = st.floats(-6.0, 6.0)
arms = st.builds(
    make_arm,
    st.lists(st.tuples(curvature, curvature), min_size=1, max_size=4),
    st.floats(0.55, 0.7),
    st.just(FREE),
    st.builds(BasePose, st.tuples(*[st.floats(-1.0, 1.0)] * 3).map(np.array), st.floats(-math.pi, math.pi)),
)


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
    return float(ArmBody(ARM).from_obstacles(joints, task.solids).min())


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
        _, misses = bent.closest_joints([target.position for target in task.targets])
        for target, joints, before, after in zip(
            task.targets, check.joints, check.misses, misses, strict=True
        ):
            rate = tilt_rate(ARM, target.position, joints)
            bound = np.linalg.norm(new_end - end) + rate * np.linalg.norm(across)
            assert abs(after - before) <= bound * (1.0 + 1e-2) + 1e-9


def test_at_a_joint_limit_the_worst_tilt_may_push_past_the_limit():
    lower = ROBOT.joint_limits.second.lower
    task, design = make_design(ARM, [[2.0, lower]], np.zeros((1, 3)), tolerance=1e-4)
    tolerance = shape_tolerance(task, design)
    worst = worst_excess(task, ARM, np.zeros(3), tolerance.direction * tilts_across(ARM))
    assert worst == pytest.approx(1.0, abs=0.01)


@given(arms, st.floats(-math.pi, math.pi), st.floats(0.0, 2.0 * math.pi))
def test_no_tilt_moves_p5_faster_than_its_distance_from_the_links_end(arm, theta1, theta2):
    point = arm.forward_kinematics(theta1, theta2)
    rate = tilt_rate(arm, point, np.array([theta1, theta2]))
    lever = np.linalg.norm(arm.kinematics.forward(0.0, theta2) - arm.end_frame[1])
    assert 0.0 <= rate <= lever * (1.0 + 1e-9)


@pytest.mark.parametrize("missed", [1, 3])
def test_a_task_that_is_not_met_has_no_tolerance_and_no_instruction(missed):
    """Not even if all targets but one are reached: the one that is barely met is no measure of anything."""
    task, design = make_design(ARM, JOINTS, [[0.9] * 3] * missed + [[1e-3, 0.0, 0.0]] * (3 - missed))
    tolerance = shape_tolerance(task, design)
    assert math.isnan(tolerance.position)
    assert math.isnan(tolerance.direction)
    assert tolerance.position_target == ShapeTolerance().direction_target == ""
    guide = make_guide(task, design)
    assert not guide.met
    assert guide.forgiveness is None
    assert tolerance_sentences(guide) == guide.ways == ()
    for status in (Status.BEST_EFFORT, Status.PROVEN_IMPOSSIBLE, Status.LIMIT):
        solution = replace(SOLUTION, task=task, designs=(design,), status=status, reasons=("it is too far",))
        text = guide_text(guide, solution)
        assert f"✗ a task: {status.sentence}" in text.splitlines()[0]
        assert "• it is too far" in text
        assert "✗ t0  MISSED" in text
        for words in ("Set joint 1", "Hold axis 2", "P3", "END", "hand", "bend radius"):
            assert words not in text


def test_only_where_there_is_a_shape_is_it_called_the_nearest():
    for status in (Status.BEST_EFFORT, Status.LIMIT):
        assert "nearest" in status.told(with_shape=True)
        assert status.told(with_shape=False) == status.sentence
        assert "nearest" not in summary_text(replace(NOTHING, status=status))
        assert "this is" not in status.sentence


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


def test_a_default_tolerance_is_marked_as_such():
    text = summary_text(
        replace(SOLUTION, **on(make_design(ARM, JOINTS, np.zeros((3, 3)), DEFAULT_TOLERANCE)))
    )
    assert "of 1.000 mm, the default" in text
    assert "the default" not in summary_text(SOLUTION)


def on(made):
    task, design = made
    return {"task": task, "designs": (design,)}


def test_proof_and_help_stand_below_the_headline_and_speak_of_the_shape_shown():
    task, design = make_design(ARM, JOINTS, np.full((3, 3), 0.1))
    worst = 1e3 * design.verification.misses.max()
    bound = Bound(0.02, 0.0201, 2e-3, 7)
    release = Release("floor", 0.1, 0.1, "a floor 100.0 mm lower", design, task)
    solution = replace(
        SOLUTION, task=task, designs=(design,), status=Status.PROVEN_IMPOSSIBLE,
        reasons=(bound.sentence,), bound=bound, releases=(release,),
    )  # fmt: skip
    lines = summary_text(solution).splitlines()
    assert lines[2].startswith(
        "• proven: every shape misses some target by at least 20.000 mm; the worst miss of"
    )
    gap = float(re.search(r"within ([\d.]+) mm", lines[2])[1])
    assert worst - 20.0 <= gap < worst - 20.0 + 1.1e-3
    assert lines[3] == "• a floor 100.0 mm lower would do"
    assert lines[4].startswith("✗ t0")


def test_of_many_reasons_some_are_told_and_the_others_counted():
    text = summary_text(replace(NOTHING, reasons=tuple(f"reason {i}" for i in range(48))))
    assert "reason 4" in text
    assert "reason 5" not in text
    assert "and 43 more of this kind" in text


def test_another_shape_is_shown_on_request():
    other = make_arm(curvatures=((2.0, 1.0), (-2.0, 3.0), (1.0, 5.0)))
    second = Design(other, verify(TASK, other))
    both = replace(SOLUTION, designs=(DESIGN, second))
    shown = showing(both, 2)
    assert shown.robot is other
    assert shown.shape_numbers == (2, 1)
    assert "this is shape 2 (" in summary_text(shown)
    assert solution_text(shown, alternatives=True).splitlines()[-1].startswith("  1  worst miss")
    assert showing(both, 1).shape_numbers == (1, 2)
    for number in (0, 3):
        with pytest.raises(
            SynthError, match=f"there is no shape {number} to show: there are 2 distinct shapes"
        ):
            showing(both, number)
    with pytest.raises(SynthError, match="there is no shape of this task"):
        showing(NOTHING, 1)


def test_the_text_holds_the_headline_the_angle_and_the_points():
    text = guide_text(GUIDE, SOLUTION)
    lines = text.splitlines()
    assert lines[0] == f"✓ a task: {Status.FOUND.sentence}"
    assert "2. Set joint 1 to 180.0 deg and hold it there, joint 2 at 180.0 deg." in lines
    rows = {name: line.split()[1:] for line in lines for name in MARKERS if line.startswith(f"{name}   ")}
    for name, row in zip(MARKERS, GUIDE.hold.markers, strict=True):
        np.testing.assert_allclose(np.array(rows[name], dtype=float), 1e3 * row, atol=0.051)
    assert f"link {1e3 * ARM.shape.length:.1f} mm long" in text
    assert "seed 7, 3 starts, 1.25 s" in text
    assert "nan" not in text


def test_many_targets_are_summed_up():
    task, design = make_design(ARM, [[1.0, 2.0]] * 14, np.outer(np.arange(14) - 7, [1e-3, 0, 0]))
    text = summary_text(Solution(task, Status.BEST_EFFORT, "x", (), 0, (design, design), 1, TIMING))
    assert "of 14 targets are within tolerance; the 10 worst:" in text
    assert "2 distinct shapes" in text
    assert len(text.splitlines()) < 20


def test_a_solution_without_a_shape_has_a_summary_and_its_reasons():
    text = guide_text(None, NOTHING)
    assert text == summary_text(NOTHING)
    assert "• no\n• never\n• 3 targets asked for, none reached" in text


def test_the_other_shapes_have_a_line_each_on_request():
    both = replace(SOLUTION, designs=(DESIGN, DESIGN))
    assert solution_text(both) == guide_text(GUIDE, both)
    assert solution_text(SOLUTION, alternatives=True) == guide_text(GUIDE, SOLUTION)
    assert solution_text(both, alternatives=True).splitlines()[-1].startswith("  2  worst miss")
    assert solution_text(NOTHING, alternatives=True) == summary_text(NOTHING)


def test_a_joint_that_turns_all_round_has_no_limit_at_its_end():
    arm = make_arm(robot=FREE)
    for theta1 in (math.pi, math.pi - 1e-3):
        point = arm.forward_kinematics(theta1, 2.0)
        rate = tilt_rate(arm, point, np.array([theta1, 2.0]))
        assert rate == pytest.approx(tilt_rate(arm, arm.forward_kinematics(0.0, 2.0), np.array([0.0, 2.0])))


def test_a_task_that_is_missed_tells_what_would_help():
    task, design = make_design(ARM, JOINTS, np.full((3, 3), 0.1))
    missed = replace(SOLUTION, task=task, designs=(design,), status=Status.BEST_EFFORT)
    told = help_told(missed)
    worst = 1e3 * design.verification.misses.max()
    tolerance = float(
        re.search(r"tolerances of ([\d.]+) mm would be met by the nearest shape found", told[0])[1]
    )
    assert worst <= tolerance < worst + 0.01
    # That is true: with such tolerances the same shape is found to do.
    loose = replace(task, targets=tuple(replace(t, tolerance=1e-3 * tolerance) for t in task.targets))
    assert verify(loose, design.arm, design.verification.joints).found
    assert ["--why" in each for each in told[1:]] == [True, False]
    assert "--prove" in told[2]
    assert all(f"• {each}" in summary_text(missed).splitlines() for each in told)
    stopped = help_told(replace(missed, status=Status.LIMIT, explained=True))
    assert "more time may find a shape" in stopped
    assert not any("--why" in each for each in stopped)
    impossible = help_told(replace(missed, status=Status.PROVEN_IMPOSSIBLE))
    assert len(impossible) == 1  # no tolerance is promised, and nothing is left to prove
    assert help_told(SOLUTION) == []


def test_a_straight_link_is_told_as_one_without_a_bend():
    straight = link_sentence(LinkShape([[1e-4, 0.0]], [0.6]))
    assert straight == "link 600.0 mm long, as good as straight"


def test_a_radius_to_bend_no_tighter_than_is_never_told_too_small():
    robot = replace(ARM.robot, link=replace(ARM.robot.link, min_bend_radius=0.10004))
    told = " ".join(instructions(replace(GUIDE, arm=replace(ARM, robot=robot))))
    assert "nowhere tighter than to a radius of 100.1 mm" in told


def test_the_headline_of_a_shape_without_a_way_says_so():
    ways = (Motion("a", "b", np.zeros((0, 2))),)
    design = replace(SOLUTION.best, ways=ways)
    headline = summary_text(replace(SOLUTION, designs=(design,))).splitlines()[0]
    assert headline.endswith(": every target is reached, but no way was found from a to b")


def test_the_guide_of_a_shape_is_made_once():
    task, arm = planted_task(2, 3)
    design = Design(arm, verify(task, arm))
    assert make_guide(task, design) is make_guide(task, design)
    assert make_guide(replace(task, name="other"), design) is not make_guide(task, design)


def test_a_clearance_is_told_no_farther_than_it_was_looked_for():
    assert clearance_told(MOST_CLEARANCE) == "100.0 mm at least"
    assert clearance_told(np.nextafter(MOST_CLEARANCE, 0.0)) == "100.0 mm at least"
    assert clearance_told(0.04999) == "49.9 mm"
