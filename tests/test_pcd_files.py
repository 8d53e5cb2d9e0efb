"""Surfaces given by the points of a PCD file, of the three codings and of several programs."""

import numpy as np
import pytest
from pcd_files import packed_by_lzf, pcd_file

from synth.errors import InputError
from synth.surfaces import read_points
from synth.surfaces.pcd_file import unpack_lzf
from synth.task import parse_task

CODINGS = ["ascii", "binary", "binary_compressed"]
RNG = np.random.default_rng(12)
POINTS = RNG.uniform(-500.0, 500.0, (300, 3))
XYZ = [(name, "f8", POINTS[:, axis]) for axis, name in enumerate("xyz")]
ONES = np.ones(len(POINTS))


def read(tmp_path, content):
    (tmp_path / "scan.pcd").write_bytes(content)
    return read_points(tmp_path / "scan.pcd")


@pytest.mark.parametrize("coding", CODINGS)
@pytest.mark.parametrize(
    "columns",
    [
        XYZ,
        [*XYZ, ("rgb", "f4", 4.2e6 * ONES), ("normal_x", "f4", RNG.normal(size=300))],
        [("label", "u1", 7 * ONES), XYZ[2], ("histogram", "f4", RNG.normal(size=(300, 5))), XYZ[0], XYZ[1]],
    ],
    ids=["alone", "with more", "among others"],
)
def test_x_y_and_z_are_read_wherever_they_stand(tmp_path, coding, columns):
    np.testing.assert_array_equal(read(tmp_path, pcd_file(columns, coding)), POINTS)


@pytest.mark.parametrize("coding", CODINGS)
@pytest.mark.parametrize("kind", ["f4", "i2", "i8", "u4"])
def test_numbers_of_any_type_are_read(tmp_path, coding, kind):
    points = np.abs(POINTS).astype(kind)
    columns = [(name, kind, points[:, axis]) for axis, name in enumerate("xyz")]
    np.testing.assert_array_equal(read(tmp_path, pcd_file(columns, coding)).astype(kind), points)


@pytest.mark.parametrize("coding", CODINGS)
def test_pixels_of_an_organised_scan_without_a_return_are_passed_over(tmp_path, coding):
    holes = POINTS.copy()
    holes[::3, :] = np.nan
    holes[1, 2] = np.inf
    columns = [(name, "f8", holes[:, axis]) for axis, name in enumerate("xyz")]
    content = pcd_file(columns, coding, WIDTH=20, HEIGHT=15)
    np.testing.assert_array_equal(read(tmp_path, content), POINTS[np.isfinite(holes).all(axis=1)])
    nothing = [(name, "f8", np.nan * ONES) for name in "xyz"]
    with pytest.raises(InputError, match="holds no points"):
        read(tmp_path, pcd_file(nothing, coding))


def test_headers_of_older_and_other_programs_are_read(tmp_path):
    lean = pcd_file(XYZ, COUNT=None, VIEWPOINT=None, HEIGHT=None, WIDTH=None, SIZE="4 4 4")
    older = pcd_file(XYZ).replace(b"VERSION .7", b"VERSION .5").replace(b"FIELDS", b"COLUMNS")
    spaced = pcd_file(XYZ).replace(b" ", b" \t ").replace(b"\n", b" \r\n")
    unsaid = pcd_file(XYZ, POINTS=None, before="\n# a scan\n# x y z\n")
    for content in (lean, older, spaced, unsaid):
        np.testing.assert_array_equal(read(tmp_path, content), POINTS)
    filled = pcd_file(XYZ, "binary") + bytes(4096)
    np.testing.assert_array_equal(read(tmp_path, filled), POINTS)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"POINTS": 301, "WIDTH": 301}, "301 points"),
        ({"POINTS": 299, "WIDTH": 299}, "299 points"),
        ({"POINTS": 4_000_000_000, "WIDTH": 4_000_000_000}, "4000000000 points"),
        ({"WIDTH": 65536, "HEIGHT": 65536}, "WIDTH times HEIGHT is 4294967296, POINTS is 300"),
        ({"POINTS": -3}, "'-3' where a whole number"),
        ({"COUNT": "1 1 x"}, "'x' where a whole number"),
        ({"COUNT": "1 1 4000000000"}, "one field z, of one number"),
        ({"FIELDS": "x y intensity"}, "one field z"),
        ({"FIELDS": "x x z"}, "one field x"),
        ({"FIELDS": "x y z rgb"}, "SIZE speaks of 3 fields, FIELDS of 4"),
        ({"SIZE": "4 4 3"}, "'F3'"),
        ({"TYPE": "F F Q"}, "'Q8'"),
    ],
)
@pytest.mark.parametrize("coding", CODINGS)
def test_a_header_that_cannot_be_true_is_refused_with_what_is_wrong(tmp_path, coding, changes, words):
    with pytest.raises(InputError, match="is no PCD file that can be read") as caught:
        read(tmp_path, pcd_file(XYZ, coding, **changes))
    assert words in str(caught.value)


@pytest.mark.parametrize("coding", CODINGS)
def test_a_file_that_ends_too_early_is_refused(tmp_path, coding):
    whole = pcd_file(XYZ, coding)
    for end in (0, 30, whole.index(b"DATA") + 6, len(whole) // 2, len(whole) - 30):
        with pytest.raises(InputError, match="no PCD file"):
            read(tmp_path, whole[:end])


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (b"DATA ascii", b"DATA zipped", "'zipped', not one of ascii, binary"),
        (b"VIEWPOINT", b"VIEWPOINT" + b"\n#" * 200, "no DATA line"),
        (b"0 0 0 1 0 0 0", b"\xff\xfe\x00", None),
        (b"ascii\n", b"ascii\n1 2 3 4\n", "301 lines follow"),
    ],
)
def test_what_stands_in_a_text_file_by_mistake_is_told(tmp_path, old, new, words):
    content = pcd_file(XYZ).replace(old, new)
    if words is None:
        return np.testing.assert_array_equal(read(tmp_path, content), POINTS)
    with pytest.raises(InputError) as caught:
        read(tmp_path, content)
    assert words in str(caught.value)
    return None


def test_a_line_of_too_few_numbers_or_of_words_is_refused(tmp_path):
    lines = pcd_file(XYZ).splitlines(keepends=True)
    for line in (b"1 2\n", b"1 2 3 4\n", b"1 two 3\n"):
        with pytest.raises(InputError, match="no PCD file"):
            read(tmp_path, b"".join([*lines[:-1], line]))


@pytest.mark.parametrize(
    "content",
    [b"", b"a", b"abc" * 500, bytes(1000), RNG.bytes(700), RNG.bytes(40) + b"xy" * 8 + RNG.bytes(9000) * 2],
    ids=["nothing", "a byte", "repeated", "zeros", "noise", "far apart"],
)
def test_what_was_packed_is_unpacked_and_nothing_more_is_made(content):
    packed = packed_by_lzf(content)
    assert unpack_lzf(packed, len(content)) == content
    for damaged, size in ((packed, len(content) + 1), (packed + b"\x05", len(content)), (b"\x20\x05", 3)):
        with pytest.raises(ValueError, match="damaged"):
            unpack_lzf(damaged, size)
    if len(content) > 600:
        with pytest.raises(ValueError, match="damaged"):
            unpack_lzf(packed, 100)


def test_a_pcd_scan_is_a_surface_of_a_task_in_the_unit_of_its_own(tmp_path):
    points = np.array([[0.4, 0.0, 0.3], [np.nan, 0.0, 0.0], [0.41, 0.02, 0.3]])
    columns = [(name, "f8", points[:, axis]) for axis, name in enumerate("xyz")]
    (tmp_path / "scan.pcd").write_bytes(pcd_file(columns, "binary_compressed"))
    surface = {"points": "scan.pcd", "length_unit": "m"}
    task = {"synth": 1, "length_unit": "mm", "robot": "malleable-2dof", "surface": surface}
    read_task = parse_task(task, directory=tmp_path)
    np.testing.assert_allclose(read_task.table.positions, points[[0, 2]])
