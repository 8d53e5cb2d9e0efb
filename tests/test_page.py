"""The guide as a page: one file, true to the kinematics, with instructions only where they are meant."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest
from click.testing import CliRunner
from sheets import GUIDE, NOTHING, SOLUTION, make_solution
from solutions import write_solution

from synth.cli import main
from synth.errors import SynthError
from synth.export import page_content, write_files, write_page
from synth.export.page import draw_page
from synth.export.sheet import headline_told
from synth.geometry import Box, Capsule
from synth.guide import base_sentence, instructions, make_guide
from synth.robot import Workspace
from synth.synthesis import verify
from synth.task import Obstacle

MISSED = make_solution(offset=0.05)


def page(solution=SOLUTION):
    guide = make_guide(solution.task, solution.best) if solution.designs else None
    return draw_page(solution, guide).decode()


def content(text):
    return json.loads(
        re.search(r'<script id="content" type="application/json">(.*?)</script>', text, re.DOTALL)[1]
    )


def turn(axis, angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array({"x": [[1, 0, 0], [0, c, -s], [0, s, c]], "z": [[c, -s, 0], [s, c, 0], [0, 0, 1]]}[axis])


def placed(arm, joints, point):
    """Return where the page has a point of the rigid link: by its two transforms and nothing else."""
    first, second = arm["joint1"], arm["joint2"]
    inner = np.array(second["rotation"]) @ turn("x", joints[1]) @ point + second["origin"]
    return np.array(first["rotation"]) @ turn("z", joints[0]) @ inner + first["origin"]


def test_the_page_asks_no_network_for_anything():
    text = page()
    text = text.replace("http://www.w3.org/2000/svg", "")  # the name of a language, no address
    assert not re.findall(r"https?://|//\w+\.|@import|\bsrc=|<link(?! rel=\"icon\" href=\"data:)|url\(", text)
    assert "default-src 'none'" in text
    assert "connect-src 'none'" in text
    assert "EventSource" not in text
    assert "{{" not in text.replace("{{ rotation", "")


def test_the_arm_of_the_page_moves_as_the_kinematics_say():
    shape = content(page())["shapes"][0]
    arm, robot = shape["arm"], SOLUTION.robot
    for joints, target in zip(shape["joints"], SOLUTION.targets, strict=True):
        assert joints == pytest.approx(target.joints)
        assert np.linalg.norm(placed(arm, joints, arm["p5"]) - target.reached) < 1e-6
    for joints in np.random.default_rng(3).uniform(-7.0, 7.0, (20, 2)):
        assert np.linalg.norm(placed(arm, joints, arm["p5"]) - robot.forward_kinematics(*joints)) < 1e-9
        ends = [placed(arm, joints, point) for point in arm["axis2"]]
        expected = robot.base.to_task(robot.axis_points[2:] @ turn("z", joints[0]).T)
        np.testing.assert_allclose(ends, expected, atol=1e-9)
        end = robot.base.to_task(turn("z", joints[0]) @ robot.end_frame[1])
        np.testing.assert_allclose(placed(arm, joints, arm["link_end"]), end, atol=1e-9)
    assert arm["limits"] == [[each.lower, each.upper] for each in vars(robot.robot.joint_limits).values()]


def test_the_surface_that_the_page_sweeps_is_the_workspace():
    arm = content(page())["shapes"][0]["arm"]
    mesh = Workspace.within_limits(SOLUTION.robot).mesh(0.5)
    surface = SOLUTION.robot.surface
    swept = [placed(arm, joints, arm["p5"]) for joints in np.random.default_rng(1).uniform(0.0, 6.3, (50, 2))]
    assert np.abs(surface.residual(SOLUTION.robot.base.to_base(swept))).max() < 1e-9
    lowest, highest = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    assert np.all(swept >= lowest - 0.05)
    assert np.all(swept <= highest + 0.05)


def test_the_words_are_those_of_the_sheet():
    told = content(page())
    assert told["headline"] == headline_told(SOLUTION) == "Found: every target is within its tolerance."
    assert told["instructions"]["steps"] == list(instructions(GUIDE))
    assert told["instructions"]["base"] == base_sentence(GUIDE)
    points = {point["name"]: point["position"] for point in told["instructions"]["points"]}
    assert list(points) == list(GUIDE.points(GUIDE.hold))
    assert points["P3"] == pytest.approx(GUIDE.hold.markers[2])
    assert told["why"] == told["help"] == []


def test_of_a_task_that_is_missed_there_is_nothing_to_do():
    told = content(page(MISSED))
    assert told["headline"].startswith("NOT FOUND: ")
    assert told["instructions"] is None
    assert told["help"]
    (shape,) = told["shapes"]
    assert not shape["found"]
    assert not shape["arm"]["markers"]
    assert shape["ways"] == []
    assert False in shape["within"]


def test_without_a_shape_the_page_says_why_and_draws_the_targets():
    told = content(page(NOTHING))
    assert told["shapes"] == told["compared"] == []
    assert told["instructions"] is None
    assert told["why"] == ["ran out of luck"]
    assert len(told["targets"]["positions"]) == 3


def test_many_targets_are_thinned_and_those_of_the_table_stay():
    many = content(page(make_solution(count=2500)))
    targets, shape = many["targets"], many["shapes"][0]
    assert targets["count"] == 2500
    assert 800 < len(targets["positions"]) == len(shape["within"]) == len(shape["joints"]) < 1010
    for listed in targets["listed"]:
        expected = make_solution(count=2500).task.table.positions[listed["number"] - 1]
        assert targets["positions"][listed["drawn"]] == pytest.approx(expected, abs=1e-6)


def test_obstacles_stand_where_they_are():
    box = Obstacle("shelf", Box([0.9, 0.1, 0.2], [0.3, 0.2, 0.1], 0.4))
    post = Obstacle("post", Capsule([[1.5, 0, 0], [1.5, 0, 1]], 0.05))
    task = replace(SOLUTION.task, obstacles=(box, post))
    design = replace(SOLUTION.best, verification=verify(task, SOLUTION.robot))
    told = content(page(replace(SOLUTION, task=task, designs=(design,))))
    assert told["obstacles"][0]["axes"] == box.solid.axes.tolist()
    assert told["obstacles"][1] == {"name": "post", "ends": [[1.5, 0, 0], [1.5, 0, 1]], "radius": 0.05}
    assert all(" mm" in clear for clear in told["shapes"][0]["clear"])


@pytest.mark.parametrize("name", ["</script><b>", "<!-- {{DATA}} {{TITLE}}", "a & b"])
def test_a_name_of_any_signs_breaks_nothing(name):
    solution = replace(SOLUTION, task=replace(SOLUTION.task, name=name))
    text = draw_page(solution, GUIDE).decode("utf-8")
    assert content(text)["name"] == name
    assert text.count("</script>") == page().count("</script>")
    assert "<b>" not in text


def test_shapes_are_compared_side_by_side():
    other = make_solution(length=0.6).best
    told = page_content(replace(SOLUTION, designs=(SOLUTION.best, other)), GUIDE)
    rows = {row["name"]: row["values"] for row in told["compared"]}
    assert rows["link length, mm"] == ["630.0", "600.0"]
    assert [shape["number"] for shape in told["shapes"]] == [1, 2]


def test_the_page_is_written_beside_the_sheet_and_an_old_one_goes_if_it_cannot_be(tmp_path, monkeypatch):
    written = {path.name: path for path in write_files(SOLUTION, tmp_path)}
    assert content(written["guide.html"].read_text(encoding="utf-8"))["name"] == "two crates"

    def broken(_solution, _guide):
        raise ValueError("no page")

    monkeypatch.setattr("synth.export.files.draw_page", broken)
    with pytest.raises(SynthError, match=r"guide.html could not be made: .*no page"):
        write_files(SOLUTION, tmp_path)
    assert not (tmp_path / "guide.html").exists()
    assert (tmp_path / "solution.json").exists()


def test_a_page_that_cannot_be_written_leaves_the_old_one(tmp_path, monkeypatch):
    (path,) = write_page(NOTHING, tmp_path)
    old = path.read_bytes()

    def full(_self, _content):
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr("pathlib.Path.write_bytes", full)
        with pytest.raises(SynthError, match="No space left"):
            write_page(SOLUTION, tmp_path)
    assert path.read_bytes() == old
    assert [each.name for each in tmp_path.iterdir()] == ["guide.html"]


def test_the_command_writes_the_page_of_a_shape_beside_the_solution(tmp_path):
    other = make_solution(length=0.6).best
    file = write_solution(tmp_path / "solution.json", SOLUTION.task, [SOLUTION.best, other])
    answer = CliRunner().invoke(main, ["guide", str(file), "--shape", "2"])
    assert (answer.exit_code, answer.stdout) == (0, "")
    told = content((tmp_path / "guide.html").read_text(encoding="utf-8"))
    assert [shape["number"] for shape in told["shapes"]] == [2, 1]
    answer = CliRunner().invoke(main, ["guide", str(file), "-o", str(tmp_path / "out")])
    assert (tmp_path / "out" / "guide.html").exists()
    answer = CliRunner().invoke(main, ["guide", str(tmp_path / "none.json")])
    assert answer.exit_code == 2
