"""Reading tasks and robots: exact values from right files, every mistake of wrong ones, no traceback."""

import dataclasses
import json
import math
import sys

import numpy as np
import pytest
from right_tasks import INLINE, TASK, task
from task_texts import ROBOT, mistakes_in, write

from synth.robot import PRESETS, Interval, JointLimits, MalleableLink, RigidLink, Robot
from synth.task import (
    DEFAULT_TOLERANCE,
    Objective,
    Task,
    Topology,
    load_robot,
    load_task,
    parse_task,
)

AS_READ = Robot(
    name="malleable-2dof",
    d12=0.058,
    link=MalleableLink(Interval(0.55, 0.7), 0.11, diameter=0.05, max_total_bend=math.radians(270)),
    d34=0.049,
    tip_offset=0.02,
    rigid_link=RigidLink(Interval.fixed(0.455), Interval(0.455, 0.46)),
    joint_limits=JointLimits(
        Interval(math.radians(10), math.radians(350)), Interval(math.radians(53), math.radians(307))
    ),
)


class TestRightFiles:
    def test_example_of_the_interface(self, tmp_path):
        task = load_task(write(tmp_path / "crates.yaml", TASK))
        assert task.name == "two crates"
        assert task.robot == PRESETS["malleable-2dof"]
        assert task.base.position.tolist() == [0.0, 0.1, 0.0]
        assert task.base.yaw == math.pi / 2
        assert task.floor == 0.005
        assert (task.topology, task.objective) == (Topology.ANY, Objective.LEAST_SQUARES)
        pick, place = task.targets
        assert (pick.name, pick.tolerance, pick.weight) == ("pick", 0.002, 1.0)
        assert pick.position.tolist() == [0.512, 0.1405, 0.21]
        assert (place.name, place.tolerance, place.weight) == ("place", DEFAULT_TOLERANCE, 1.0)
        assert place.position.tolist() == [-0.3, 0.42, 0.18]

    def test_least_task_has_the_documented_defaults(self, tmp_path):
        task = load_task(write(tmp_path / "least.yaml", INLINE))
        assert task.name == "least"
        assert task.targets[0].name == "target 1"
        assert (task.base.position.tolist(), task.base.yaw, task.floor_height) == ([0.0, 0.0, 0.0], 0.0, 0.0)
        robot = task.robot
        assert (robot.name, robot.tip_offset, robot.joint_limits) == ("inline robot", 0.0245, JointLimits())
        assert robot.link == MalleableLink(Interval(0.55, 0.7), 0.11, diameter=0.0, max_total_bend=math.inf)

    def test_robot_file(self, tmp_path):
        assert load_robot(write(tmp_path / "robot.yaml", ROBOT)) == AS_READ

    def test_robot_file_is_found_beside_the_task(self, tmp_path):
        (tmp_path / "robots").mkdir()
        write(tmp_path / "robots" / "mine.yaml", ROBOT.replace("name: malleable-2dof\n", ""))
        task = load_task(
            write(
                tmp_path / "task.yaml", TASK.replace("malleable-2dof", "robots/mine.yaml").replace("mm", "cm")
            )
        )
        assert task.robot == dataclasses.replace(AS_READ, name="mine")  # in its own unit
        assert task.targets[0].position.tolist() == [5.12, 1.405, 2.1]

    @pytest.mark.parametrize(
        ("unit", "d12"), [("", 0.058), ("length_unit: cm", 0.58), ("length_unit: m", 58.0)]
    )
    def test_inline_robot_inherits_the_unit_unless_it_states_one(self, unit, d12):
        position = f"[{5e3 * d12}, 0, 0]"  # within the reach of a robot of this size
        content = INLINE.replace("  d12", f"  {unit}\n  d12").replace("[100, 200, 300]", position)
        assert parse_task(content).robot.d12 == d12

    @pytest.mark.parametrize(("old", "new"), [("mm", "MM"), ("any  ", "Puma"), ("minimax", "Minimax")])
    def test_fixed_words_are_read_without_regard_to_case(self, old, new):
        assert parse_task(TASK.replace(f": {old}", f": {new}", 1)).robot.name == "malleable-2dof"

    def test_characters_beyond_16_bits_may_be_escaped_as_in_json(self):
        content = json.dumps(
            {
                "synth": 1,
                "length_unit": "mm",
                "robot": "malleable-2dof",
                "targets": [{"name": "crate \U0001f4e6", "position": [400, 300, 500]}],
            }
        )
        assert "\\ud83d" in content
        assert parse_task(content).targets[0].name == "crate \U0001f4e6"

    def test_null_floor_is_no_floor(self):
        assert parse_task(TASK.replace("floor: 5", "floor: null")).floor is None

    @pytest.mark.parametrize(
        ("text", "value"),
        [
            ("1e-3", 1e-6),
            ("+2", 0.002),
            ("0o10", 0.008),
            ("0x10", 0.016),
            ("010", 0.01),
            (".5", 0.0005),
            ("5.", 0.005),
        ],
    )
    def test_numbers_are_those_of_yaml_1_2(self, text, value):
        assert parse_task(TASK.replace("tolerance: 2.0", f"tolerance: {text}")).targets[0].tolerance == value

    def test_yes_and_dates_are_text(self):
        task = parse_task(
            TASK.replace("name: two crates", "name: yes").replace("name: pick", "name: 2026-11-01")
        )
        assert (task.name, task.targets[0].name) == ("yes", "2026-11-01")

    def test_mapping_in_python(self, tmp_path):
        write(tmp_path / "mine.yaml", ROBOT)
        task = parse_task(
            {
                "synth": 1,
                "length_unit": "m",
                "robot": (tmp_path / "mine.yaml").relative_to(tmp_path),
                "topology": Topology.SCARA,
                "targets": [{"position": row, "tolerance": np.float64(1e-6)} for row in np.eye(3)]
                + [{"position": (1, 2, 3)}],
            },
            directory=tmp_path,
            name="from a planner",
        )
        assert (task.name, task.topology, task.robot) == ("from a planner", Topology.SCARA, AS_READ)
        assert task.targets[1].position.tolist() == [0.0, 1.0, 0.0]
        assert [target.name for target in task.targets] == [f"target {i}" for i in (1, 2, 3, 4)]

    def test_byte_order_mark_and_windows_line_ends(self, tmp_path):
        content = b"\xef\xbb\xbf" + TASK.replace("\n", "\r\n").encode()
        assert load_task(write(tmp_path / "task.yaml", content)).name == "two crates"

    def test_reading_takes_as_many_steps_for_each_of_many_targets_as_for_each_of_a_few(self):
        def steps(count):
            row = "  - {{position: [{0}.5, -{0}, 210.0], tolerance: 2.0, weight: 1}}\n"
            rows = "".join(row.format(i) for i in range(count))
            content, calls = TASK.replace("objective", rows + "objective"), 0

            def counted(_frame, event, _argument):
                nonlocal calls
                calls += event in {"call", "c_call"}

            before = sys.getprofile()
            sys.setprofile(counted)
            try:
                read = parse_task(content)
            finally:
                sys.setprofile(before)
            assert len(read.targets) == count + 2
            return calls

        few, some, many = steps(0), steps(100), steps(1000)
        assert (many - few) / 1000 < 1.05 * (some - few) / 100


class TestRobotFiles:
    def test_mistakes_carry_the_name_and_line_of_the_robot_file(self, tmp_path):
        robot = write(tmp_path / "mine.yaml", ROBOT.replace("d12: 58", "d12: -1").replace("d45", "d46"))
        path = write(
            tmp_path / "task.yaml", task("malleable-2dof", "mine.yaml").replace("floor: 5", "floor: low")
        )
        assert [(m.file, m.line, m.key) for m in mistakes_in(load_task, path)] == [
            (str(robot), 3, "d12"),
            (str(robot), 7, "rigid_link.d46"),
            (str(path), 6, "floor"),
        ]

    def test_unit_is_stated(self, tmp_path):
        robot = write(tmp_path / "mine.yaml", ROBOT.replace("length_unit: mm\n", ""))
        (mistake,) = mistakes_in(load_robot, robot)
        assert (mistake.key, mistake.line) == ("length_unit", 1)

    def test_syntax(self, tmp_path):
        robot = write(tmp_path / "mine.yaml", ROBOT + "a: [\n")
        (mistake,) = mistakes_in(parse_task, task("malleable-2dof", "mine.yaml"), directory=tmp_path)
        assert (mistake.file, mistake.line) == (str(robot), 10)

    def test_a_task_is_no_robot_so_nothing_recurs(self, tmp_path):
        path = write(tmp_path / "task.yaml", task("malleable-2dof", "task.yaml"))
        (mistake,) = mistakes_in(load_task, path)
        assert "is a task file" in mistake.message

    def test_a_robot_names_no_robot(self, tmp_path):
        path = write(tmp_path / "mine.yaml", ROBOT + "robot: mine.yaml\n")
        (mistake,) = mistakes_in(load_robot, path)
        assert (mistake.key, mistake.line) == ("robot", 9)


class TestMappings:
    def test_mistakes_have_keys_but_no_file_and_no_line(self):
        mapping = {
            "synth": 1,
            "length_unit": "m",
            "robot": "malleable-2dof",
            "targets": [{"position": (1, 2)}],
            3: 4,
        }
        found = mistakes_in(parse_task, mapping)
        assert [(m.file, m.line, m.key) for m in found] == [
            (None, None, ""),
            (None, None, "targets[0].position"),
        ]

    @pytest.mark.parametrize(
        "value", [10**400, -(10**400), math.nan, np.array(1j), object(), b"1", {1}, Task]
    )
    def test_no_value_gives_another_error(self, value):
        (mistake,) = mistakes_in(
            parse_task,
            {
                "synth": 1,
                "length_unit": "m",
                "robot": "malleable-2dof",
                "targets": [{"position": [0, 0, value]}],
            },
        )
        assert mistake.key == "targets[0].position[2]"

    def test_a_mapping_inside_itself(self):
        mapping = {"synth": 1}
        mapping["base"] = mapping
        assert any("nested" in mistake.message for mistake in mistakes_in(parse_task, mapping))


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    return tmp_path_factory.mktemp("fuzz") / "fuzz.yaml"
