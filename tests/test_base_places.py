"""A base that may be made to stand elsewhere: ranges and choices of its pose, found and told."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from planted import ROBOT, noisy, planted_arm, planted_task
from planted_bases import LEANING, planted_base, planted_choice
from scipy.spatial.transform import Rotation

import synth
from synth.export import solution_to_json
from synth.geometry import Box, roll_pitch_yaw, rotation_of
from synth.guide import make_guide
from synth.robot import BaseChoices, BasePose, BaseRange, Interval, Workspace
from synth.synthesis import Status, blocking
from synth.synthesis.shapes import Shapes
from synth.synthesis.starts import refine, start_points
from synth.synthesis.starts.random_shapes import shapes_for
from synth.task import Obstacle, PointTarget, Task

WALL = """
synth: 1
length_unit: mm
robot: malleable-2dof
base: {base}
targets: [{{position: [400, 100, 200]}}]
"""


def read(base: str) -> Task:
    return synth.parse_task(WALL.format(base=base))


@pytest.mark.parametrize("angles", [(0.3, -1.2, 2.5), (0.0, np.pi / 2, 0.4), (np.pi, 0.0, 0.0)])
def test_roll_pitch_and_yaw_are_about_fixed_axes_in_this_order(angles):
    rotation = rotation_of(*angles)
    assert rotation == pytest.approx(Rotation.from_euler("xyz", angles).as_matrix(), abs=1e-12)
    assert rotation_of(*roll_pitch_yaw(rotation)) == pytest.approx(rotation, abs=1e-9)


class TestFile:
    def test_each_number_may_be_a_range(self):
        task = read("{position: [[-200, 200], 0, 50], rpy_deg: [0, 90, [-180, 180]]}")
        assert task.places == BaseRange(
            Interval(-0.2, 0.2), 0.0, 0.05, 0.0, np.pi / 2, Interval(-np.pi, np.pi)
        )
        assert task.places.contains(task.base)

    def test_choices_have_names(self):
        task = read("{choices: [{name: bench}, {position: [0, 500, 400], rpy_deg: [90, 0, 0]}]}")
        assert task.places.names == ("bench", "place 2")
        assert task.places.poses[1].rotation @ [0, 0, 1] == pytest.approx([0, -1, 0])

    def test_a_fixed_pose_leaves_no_choice(self):
        assert read("{position: [1, 2, 3], yaw_deg: 90}").places is None

    @pytest.mark.parametrize(
        ("base", "key", "words"),
        [
            ("{position: [[1, 0], 2, 3]}", "base.position[0]", "low to high"),
            ("{yaw_deg: 3, rpy_deg: [0, 0, 3]}", "base", "both rpy_deg and yaw_deg"),
            ("{yaw_deg: [0, 500]}", "base.yaw_deg", "at most 360"),
            ("{choices: []}", "base.choices", "one place"),
            ("{choices: [{name: a}], yaw_deg: 3}", "base", "nothing beside them"),
            ("{choices: [{name: a}, {name: a}]}", "base.choices[1].name", "is the name of"),
            ("{choices: [{nam: a}]}", "base.choices[0].nam", "did you mean 'name'"),
        ],
    )
    def test_mistakes_are_named(self, base, key, words):
        with pytest.raises(synth.InputError) as caught:
            read(base)
        mistakes = {mistake.key: mistake.message for mistake in caught.value.mistakes}
        assert words in mistakes[key]

    def test_the_floor_is_a_height_of_the_task_frame(self):
        content = WALL.format(base="{position: [0, 0, 300]}")
        assert synth.parse_task(content).floor_in_base == 0.0  # absent: that of an upright base
        assert synth.parse_task(content + "floor: 0\n").floor_in_base == pytest.approx(-0.3)
        leaning = synth.parse_task(WALL.format(base="{rpy_deg: [90, 0, 0]}"))
        assert leaning.floor_height is None
        assert leaning.solids == ()


class TestRange:
    PLACES = BaseRange(Interval(0.0, 1.0), yaw=Interval(-np.pi, np.pi))

    def test_a_full_turn_has_no_ends(self):
        row = self.PLACES.into_limits([2.0, 0.1, 0.0, 0.0, 0.0, 4.0])
        assert row == pytest.approx([1.0, 0.0, 0.0, 0.0, 0.0, 4.0 - 2.0 * np.pi])

    def test_a_base_elsewhere_is_found_out(self):
        task, _ = planted_task(3, 4)
        arm = synth.solve(task).robot
        moved = BasePose([0.5, 0.0, 0.3])
        there = replace(task, base=moved, places=self.PLACES, floor=None)
        assert there.base == self.PLACES.middle  # the one said is none of its places
        check = synth.verify(there, replace(arm, base=moved))
        assert any(violation.limit == "base: position" for violation in check.violations)
        assert not check.found


def test_a_leaning_base_keeps_the_arm_over_a_floor():
    base = BasePose([0.0, 0.7, 0.5], roll=np.pi / 2)
    low = PointTarget("low", [0.2, 0.3, -0.05], 5e-3)
    task = Task("wall", ROBOT, [low], base=base, floor=0.0)
    solution = synth.solve(task)
    assert solution.status is Status.PROVEN_IMPOSSIBLE
    assert "the floor" in solution.message
    assert synth.solve(replace(task, floor=None)).found


@pytest.mark.parametrize("leaning", [0.0, LEANING])
@pytest.mark.parametrize("seed", range(2))
def test_a_planted_base_is_found(seed, leaning):
    task, _ = planted_base(seed, leaning=leaning)
    solution = synth.solve(task)
    arm = solution.robot
    assert solution.found
    assert task.places.contains(arm.base)
    joints = np.array([target.joints for target in solution.targets])
    reached = arm.forward_kinematics(*joints.T)
    assert (np.linalg.norm(reached - task.table.positions, axis=1) <= task.tolerances).all()


def test_the_place_is_told_in_round_numbers_with_how_precisely():
    task, _ = planted_base(1)
    task = replace(task, targets=[replace(target, tolerance=5e-3) for target in task.targets])
    solution = synth.solve(task)
    millimetres = 1e3 * solution.robot.base.position
    assert millimetres == pytest.approx(np.round(millimetres), abs=1e-6)
    place = make_guide(solution.task, solution.best).place
    rng = np.random.default_rng(0)
    for _ in range(50):
        off = rng.normal(size=3)
        off *= 0.99 * place.position / np.linalg.norm(off)
        base = replace(solution.robot.base, position=solution.robot.base.position + off)
        _, misses = replace(solution.robot, base=base).closest_joints(task.table.positions)
        assert (misses <= task.tolerances + 1e-5).all()
    text = synth.guide.solution_text(solution)
    assert "Place the base" in text
    assert f"{1e3 * place.position:.0f}"[0] in text


@pytest.mark.parametrize("seed", range(2))
def test_the_right_one_of_five_places_is_chosen(seed):
    task, name = planted_choice(seed)
    solution = synth.solve(task)
    assert solution.found
    assert task.places.name_of(solution.robot.base) == name
    assert sum("misses by" in note or "no shape" in note for note in solution.notes) == 4
    assert solution_to_json(solution)["guide"]["base"]["name"] == name


def test_what_no_place_can_do_is_proven_only_if_each_is():
    far = PointTarget("far", [9.0, 0.0, 0.3])
    near, there = BasePose(), BasePose([8.5, 0.0, 0.0])
    task = Task("far", ROBOT, [far], places=BaseChoices(["near"], [near]))
    assert synth.solve(task).status is Status.PROVEN_IMPOSSIBLE
    assert synth.solve(replace(task, places=BaseChoices(["near", "there"], [near, there]))).found
    ranged = replace(task, places=BaseRange(Interval(0.0, 1.0)))
    assert synth.solve(ranged).status is Status.PROVEN_IMPOSSIBLE
    assert synth.solve(replace(task, places=BaseRange(Interval(0.0, 8.0)))).found


def test_what_a_base_in_a_range_misses_is_no_proof():
    solution = synth.solve(noisy(0, places=BaseRange(Interval(0.0, 0.1))))
    assert solution.status is Status.BEST_EFFORT


def test_obstacles_are_kept_clear_of_from_the_place_chosen():
    task, base = planted_base(0, count=3)
    block = Obstacle("block", Box(base.to_task([0.0, 0.0, 0.45]), [0.2, 0.2, 0.1]))
    solution = synth.solve(replace(task, obstacles=(block,)))
    assert solution.found
    assert solution.best.verification.clearances.min() >= 0.0


def test_shapes_and_targets_move_with_the_base_as_differences_say():
    task, _ = planted_base(1, leaning=LEANING)
    shapes = shapes_for(task, 0).shapes.take(slice(20))
    rows = shapes.motion[:, -6:, -6:]  # shift and turn of the base in its own frame
    point, step = np.array([[0.3, -0.2, 0.5]]), 1e-6
    for number in range(6):
        moved = [shapes.unknowns.copy() for _ in range(2)]
        for sign, unknowns in zip((step, -step), moved, strict=True):
            unknowns[:, number - 6] += sign
        seen = [replace(shapes, unknowns=unknowns).bases.seen(point)[:, 0] for unknowns in moved]
        shift, turn = rows[:, :3, number], rows[:, 3:, number]
        expected = -shift - np.cross(turn, shapes.bases.seen(point)[:, 0])
        assert (seen[0] - seen[1]) / (2.0 * step) == pytest.approx(expected, abs=1e-7)


def test_the_step_leads_to_the_targets_from_nearby():
    """Near the answer the cost falls by orders of magnitude in a few steps: the derivatives are right."""
    task, base = planted_base(2, leaning=LEANING)
    start = next(start_points(task, 0))
    shapes = Shapes.of(start.arm).at_places(task.places, np.random.default_rng(0))
    unknowns = shapes.unknowns.copy()
    unknowns[:, -6:-3] = start.arm.base.position + 2e-3
    unknowns[:, -3:] = np.array([start.arm.base.roll, start.arm.base.pitch, start.arm.base.yaw]) + 0.01
    refined = refine(task, replace(shapes, unknowns=unknowns), iterations=8, near=True)
    assert refined.cost[0] < 1e-12
    assert base.position == pytest.approx(task.places.pose(refined.shapes.bases.rows[0]).position, abs=0.1)


def test_the_box_of_a_leaning_workspace_holds_it():
    arm = replace(planted_arm(np.random.default_rng(3)), base=BasePose([0.1, 0.7, 0.5], roll=1.2, pitch=0.3))
    workspace = Workspace.within_limits(arm)
    low, high = workspace.bounding_box
    points = workspace.sample(2000)
    assert (points >= low).all()
    assert (points <= high).all()
    rho, height = workspace.section(5)[2]
    middle = ROBOT.joint_limits.second.middle
    x, y, z = arm.base.to_base(arm.forward_kinematics(0.0, middle))
    assert (rho, height) == pytest.approx((np.hypot(x, y), z))


def test_what_blocks_a_task_is_asked_where_its_base_stands(monkeypatch):
    asked = []

    def seen(task, *_, **__):
        asked.append(task)
        return replace(solution, designs=())

    task = noisy(0, places=BaseRange(Interval(0.0, 0.1)))
    solution = synth.solve(task, time_limit=5.0)
    assert "by algebra" not in solution.message
    monkeypatch.setattr(blocking, "follow", seen)
    explained = synth.explain(solution)
    assert all(each.places is None for each in asked)
    assert explained.task == solution.task
    assert explained.task.places == task.places
