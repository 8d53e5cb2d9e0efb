"""The files: what they hold, and that there is never half of one."""

import csv
import io
import json
import math
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from sheets import GUIDE, NOTHING, SOLUTION

from synth.errors import SynthError
from synth.export import markers_csv, prepare_directory, write_files

NAMES = ["solution.json", "guide.pdf", "guide.html", "markers.csv"]


def test_the_csv_holds_the_points_at_the_angle_to_hold():
    rows = list(csv.DictReader(io.StringIO(markers_csv(GUIDE))))
    assert list(rows[0]) == ["marker", "x_mm", "y_mm", "z_mm", "joint1_deg"]
    expected = GUIDE.points(GUIDE.hold)
    assert [row["marker"] for row in rows] == list(expected)
    for row in rows:
        point = [float(row[column]) for column in ("x_mm", "y_mm", "z_mm")]
        np.testing.assert_allclose(point, 1e3 * expected[row["marker"]], atol=1e-4)
        assert float(row["joint1_deg"]) == pytest.approx(180.0)
    assert markers_csv(None) == "marker,x_mm,y_mm,z_mm,joint1_deg\n"


def test_files_are_written_and_the_same_each_time(tmp_path):
    first = write_files(SOLUTION, tmp_path / "new" / "directory")
    second = write_files(SOLUTION, str(tmp_path / "other"))
    assert [path.name for path in first] == [path.name for path in second] == NAMES
    for one, other in zip(first, second, strict=True):
        assert one.read_bytes() == other.read_bytes()
    assert sorted(path.name for path in first[0].parent.iterdir()) == sorted(NAMES)
    assert json.loads(first[0].read_text(encoding="utf-8"))["guide"]["hold"]["joint1"] == pytest.approx(
        math.pi
    )
    write_files(NOTHING, tmp_path / "other")
    assert json.loads(second[0].read_text(encoding="utf-8"))["guide"] is None


@pytest.mark.parametrize("broken", ["write_bytes", "replace"])
def test_a_failure_leaves_the_old_files_and_no_others(tmp_path, monkeypatch, broken):
    old = {path: path.read_bytes() for path in write_files(NOTHING, tmp_path)}
    original = getattr(Path, broken)

    def fail(self, *args):
        if broken == "replace" or "guide.pdf" in self.name:
            raise OSError(28, "No space left on device")
        return original(self, *args)

    with monkeypatch.context() as patch:
        patch.setattr(Path, broken, fail)
        with pytest.raises(SynthError, match="No space left on device"):
            write_files(SOLUTION, tmp_path)
    assert {path: path.read_bytes() for path in tmp_path.iterdir()} == old


@pytest.mark.parametrize("write", [prepare_directory, lambda directory: write_files(SOLUTION, directory)])
def test_a_directory_that_is_a_file_is_named_in_the_error(tmp_path, write):
    (tmp_path / "taken").write_text("")
    with pytest.raises(SynthError, match=r"cannot write to .*taken"):
        write(tmp_path / "taken")


def test_a_directory_is_prepared_and_left_empty(tmp_path):
    prepare_directory(tmp_path / "a" / "b")
    prepare_directory(str(tmp_path / "a" / "b"))
    assert list((tmp_path / "a" / "b").iterdir()) == []


def test_to_draw_a_sheet_loads_no_more_than_it_takes():
    """To cut fonts to size, which no sheet does, takes a library that is as slow to load as all others."""
    told = (
        "import sys; from sheets import GUIDE, SOLUTION; from synth.export.sheet import draw_sheet; "
        "draw_sheet(SOLUTION, GUIDE); "
        "print([name for name in ('fontTools.varLib', 'matplotlib.pyplot') if name in sys.modules])"
    )
    answer = subprocess.run(
        [sys.executable, "-c", told], capture_output=True, text=True, check=True, cwd=Path(__file__).parent
    )
    assert answer.stdout == "[]\n"
