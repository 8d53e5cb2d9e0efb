"""Files of measured shapes, `synth inspect`, its files, and the page of the published configurations."""

import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from command import invoked

from synth.errors import InputError
from synth.task.measured_file import parse_measurements

ROOT = Path(__file__).parents[1]
HEADER = "synth: 1\nlength_unit: mm\nrobot: malleable-2dof\n"
GOOD = "rounding: 1\ndistances: {d13: 500, d14: 544, d15: 562, d23: 451, d24: 494, d25: 520}\n"


@pytest.fixture
def config(tmp_path):
    def write(text):
        path = tmp_path / "config.yaml"
        path.write_text(HEADER + text)
        return path

    return write


def mistakes(text):
    with pytest.raises(InputError) as caught:
        parse_measurements(HEADER + text)
    return "\n".join(map(str, caught.value.mistakes))


def test_the_robot_gives_what_is_not_measured():
    (one,) = parse_measurements(HEADER + GOOD)
    assert one.distances["d12"] == 0.058
    assert one.distances["d45"] == 0.460
    assert set(np.array(one.distances.names)[one.distances.is_known]) == {"d12", "d34", "d35", "d45"}
    assert one.distances.upper[one.distances.names.index("d13")] == pytest.approx(0.5005)
    (other,) = parse_measurements(HEADER + GOOD.replace("{", "{d12: 59, "))
    assert other.robot.d12 == 0.059
    assert "d12" in np.array(other.distances.names)[~other.distances.is_known]


def test_a_unit_or_a_mapping_makes_no_difference():
    (text,) = parse_measurements(HEADER + GOOD)
    distances = {name: text.distances[name] for name in ("d13", "d14", "d15", "d23", "d24", "d25")}
    (mapping,) = parse_measurements(
        {"synth": 1, "length_unit": "m", "robot": "malleable-2dof", "rounding": 1e-3, "distances": distances}
    )
    assert np.allclose(mapping.distances.lower, text.distances.lower, rtol=0, atol=1e-15)


def test_markers_give_their_distances_in_any_frame():
    markers = {"P1": [5, 5, 5], "P2": [5, 5, 63], "P3": [305, 5, 205], "P4": [305, 45, 225]}
    (one,) = parse_measurements(HEADER + f"sigma: 0.5\nmarkers: {json.dumps(markers)}\n")
    assert one.distances["d12"] == pytest.approx(0.058)
    assert one.robot.d34 == pytest.approx(np.hypot(0.04, 0.02))
    assert not one.has_pose
    assert one.distances.sigma.max() == pytest.approx(0.5e-3 * np.sqrt(2))


def test_several_mistakes_are_named_at_once():
    words = mistakes(
        "rounding: 1\nsigma: 2\nconfigurations:\n"
        "  a: {intendet: puma, distances: {d13: 1, d14: x, d15: 3, d23: 4}}\n"
        "  b: {intended: pumma, markers: {P1: [0, 0], P2: [0, 0, 58], P3: [1, 2, 3]}}\n"
        "  c: {}\n"
    )
    for expected in (
        r"5: sigma: stands beside 'rounding'",
        r"7: configurations\.a\.intendet.*did you mean 'intended'",
        r"configurations\.a\.distances\.d14: must be a number",
        r"configurations\.a\.distances\.d24: is missing",
        r"configurations\.a\.distances: d15 and d25 say only together",
        r"configurations\.b\.intended.*did you mean 'puma'",
        r"configurations\.b\.markers\.P1: must be a list of 3 numbers",
        r"configurations\.b\.markers\.P4: is missing",
        r"configurations\.c: needs either 'distances' or 'markers'",
    ):
        assert re.search(expected, words), words


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (GOOD.replace("rounding: 1\n", ""), "needs 'rounding'"),
        (GOOD + "markers: {P1: [0, 0, 0]}\n", "needs either"),
        (GOOD + "configurations: {}\n", "must hold one configuration"),
        (GOOD.replace("rounding: 1", "rounding: 0"), "greater than 0"),
        (
            "sigma: 1\nmarkers: {P1: [0, 0, 0], P2: [0, 0, 0], P3: [1, 0, 0], P4: [2, 0, 0]}\n",
            "same point as P1",
        ),
        ("configurations: 3\n", "4: configurations:"),
    ],
)
def test_what_is_wrong_is_said(text, words):
    assert words in mistakes(text)


def test_a_rigid_link_that_the_robot_leaves_open_must_be_measured():
    link = "link: {length: 600, min_bend_radius: 110}, rigid_link: {d35: [400, 500], d45: 460}"
    text = f"synth: 1\nlength_unit: mm\nrobot: {{d12: 58, d34: 49, {link}}}\n{GOOD}"
    with pytest.raises(InputError, match="d35 is"):
        parse_measurements(text)
    (one,) = parse_measurements(text.replace("{d13", "{d35: 455, d13"))
    assert one.robot.rigid_link.is_fixed


def test_a_realisable_shape_exits_with_0_and_prints_text_or_json(config):
    answer = invoked("inspect", config(GOOD), "--samples", "50")
    assert answer.exit_code == 0
    assert "config: realisable" in answer.stdout
    data = json.loads(invoked("inspect", config(GOOD), "--samples", "50", "--json").stdout)
    assert data["schema"] == "synth.inspection/1"
    assert data["realisable"] is True
    assert data["configurations"][0]["link"]["found"] is True
    assert data["configurations"][0]["with_end_effector"]["fit"] == "within_bounds"


def test_an_impossible_number_exits_with_1_and_is_named(config):
    answer = invoked("inspect", config(GOOD.replace("520", "5200")), "--samples", "50")
    assert answer.exit_code == 1
    assert "d25 = 5200 mm is impossible" in answer.stdout
    assert "it is 520 mm" in answer.stdout


def test_wrong_input_exits_with_2(config, tmp_path):
    answer = invoked("inspect", config("distances: {d13: 1}\n"))
    assert answer.exit_code == 2
    assert "config.yaml:4: distances.d14: is missing" in answer.stderr
    assert answer.stdout == ""
    assert invoked("inspect", tmp_path / "none.yaml").exit_code == 2
    (tmp_path / "file").write_text("")
    assert invoked("inspect", config(GOOD), "-o", tmp_path / "file" / "out").exit_code == 2


def test_files_are_written_and_are_the_same_each_time(config, tmp_path):
    path = config(f"name: a/b $x$\n{GOOD}")
    contents = []
    for directory in ("one", "two"):
        assert invoked("inspect", path, "--samples", "50", "-o", tmp_path / directory).exit_code == 0
        files = sorted((tmp_path / directory).iterdir())
        assert [file.name for file in files] == ["inspect.json", "workspace-1.pdf"]
        contents.append([file.read_bytes() for file in files])
    assert contents[0] == contents[1]
    assert contents[0][1].startswith(b"%PDF")


def test_help_needs_no_heavy_library():
    program = (
        "import sys; from synth.cli import main\n"
        "try: main(['inspect', '--help'], standalone_mode=False)\n"
        "finally: print(sorted({m.split('.')[0] for m in sys.modules}))"
    )
    answer = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert "CONFIG.yaml" in answer.stdout
    for library in ("numpy", "cvxpy", "scipy", "matplotlib", "pydantic"):
        assert f"'{library}'" not in answer.stdout


def test_the_table_of_the_published_configurations_is_what_the_program_prints():
    page = (ROOT / "docs" / "published-configurations.md").read_text()
    (table,) = re.findall(r"<!-- table -->\n(.*?)<!-- end of table -->", page, re.DOTALL)
    answer = invoked("inspect", ROOT / "problems" / "clark2020.yaml", "--markdown")
    assert answer.exit_code == 1  # (b) holds a misprint, (l) fits no points
    assert answer.stdout == table


def test_the_example_of_the_page_is_a_valid_file():
    page = (ROOT / "docs" / "published-configurations.md").read_text()
    (example,) = re.findall(r"```yaml\n(.*?)```", page, re.DOTALL)
    assert parse_measurements(example)[0].has_pose
