"""Wrong files: every mistake is named with its line and key, and none twice."""

import pytest
from right_tasks import TASK, inline
from task_texts import mistakes_in, write
from wrong_tasks import WRONG

from synth.task import (
    load_robot,
    load_task,
    parse_task,
)


class TestWrongFiles:
    @pytest.mark.parametrize(("content", "key", "line", "words"), WRONG.values(), ids=WRONG)
    def test_the_only_mistake_has_its_place_and_sentence(self, tmp_path, content, key, line, words):
        path = write(tmp_path / "task.yaml", content)
        mistakes = mistakes_in(load_task, path)
        assert [(m.key, m.line, m.file) for m in mistakes] == [(key, line, str(path))]
        str(mistakes[0]).encode()  # can be printed
        for word in words.split():
            assert word in mistakes[0].message

    def test_all_mistakes_of_a_file_come_in_its_order(self):
        content = (
            TASK.replace("synth: 1 ", "synth: 3 ")
            .replace("malleable-2dof", "maleable-2dof")
            .replace("floor: 5", "floor: {}")
            .replace("tolerance: 2.0", "tolerence: 2.0")
            .replace("[-300, 420, 180]", "[-300, x, .nan]")
            .replace("name: place", "name: pick")
            .replace("objective", "objectiv")
        ) + "surface: {}\nname: again\n"
        assert [(mistake.line, mistake.key) for mistake in mistakes_in(parse_task, content)] == [
            (1, "synth"),
            (4, "robot"),
            (6, "floor"),
            (9, "targets[0].tolerence"),
            (10, "targets[1].name"),
            (10, "targets[1].position[1]"),
            (10, "targets[1].position[2]"),
            (11, "objectiv"),
            (13, "surface"),
            (14, "name"),
        ]

    def test_a_triangle_is_checked_beside_other_mistakes_of_the_robot(self):
        content = inline("d34: 49", "d34: 1000").replace("110", "0")
        keys = [mistake.key for mistake in mistakes_in(parse_task, content)]
        assert keys == ["robot.link.min_bend_radius", "robot.rigid_link"]

    def test_a_flat_triangle_is_one(self):
        metres = inline("d34: 49", "d34: 5").replace("d12", "length_unit: m\n  d12")  # 460 - 455 = 5
        parse_task(metres.replace("100, 200, 300", "1e5, 2e5, 3e5"))
        parse_task(inline("d34: 49", "d34: 0.3").replace("455", "0.1").replace("460", "0.2"))

    @pytest.mark.parametrize("make", [lambda path: path / "none.yaml", lambda path: path, lambda _: "a\0b"])
    @pytest.mark.parametrize("load", [load_task, load_robot])
    def test_what_cannot_be_opened_is_named(self, tmp_path, make, load):
        (mistake,) = mistakes_in(load, make(tmp_path))
        assert mistake.file == str(make(tmp_path))
        assert any(word in mistake.message for word in ("no such file", "directory", "cannot be read"))

    def test_unreadable_file(self, tmp_path, monkeypatch):
        def deny(*_args, **_kwargs):
            raise PermissionError(13, "Permission denied")

        monkeypatch.setattr("pathlib.Path.open", deny)
        (mistake,) = mistakes_in(load_task, tmp_path / "task.yaml")
        assert mistake.message == "cannot be read: Permission denied"

    def test_billion_laughs_cost_nothing(self):
        levels = "".join(f"b{i}: &b{i} [{', '.join([f'*b{i - 1}'] * 10)}]\n" for i in range(1, 12))
        mistakes = mistakes_in(parse_task, "b0: &b0 [ha, ha]\n" + levels)
        assert sum("aliases" in mistake.message for mistake in mistakes) == 110

    def test_numbers_that_differ_are_printed_so_that_they_differ(self):
        (mistake,) = mistakes_in(parse_task, inline("d34: 49", "d34: 4.9999999"))
        assert "at least 5, more than d34 = 4.9999999" in mistake.message


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    return tmp_path_factory.mktemp("fuzz") / "fuzz.yaml"
