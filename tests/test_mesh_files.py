"""Surfaces given by triangles in files of other programs, in the layouts these write."""

import numpy as np
import pytest
from mesh_files import AREA, BASE, CORNERS, SIDES, TRIANGLES, obj, ply, stl_bytes, stl_text

from synth.errors import InputError
from synth.surfaces import Surface, TriangleMesh, read_corners, read_points

pytest.importorskip("trimesh")
NORMALS = [("float", name, np.zeros(5)) for name in ("nx", "ny", "nz")]
COLOURS = [("uchar", name, np.arange(5)) for name in ("red", "green", "blue", "alpha")]
SEAM = [("float", "s", np.arange(5.0)), ("float", "t", np.arange(5.0))]
FOLDED = [[0, 0, 0], [4, 0, 0], [4, 4, 0], [2, 1, 0], [0, 4, 0]]  # a square with a notch to its middle
NOTCHED = 16.0 - 6.0


def written(tmp_path, name, content):
    (tmp_path / name).write_bytes(content if isinstance(content, bytes) else content.encode())
    return tmp_path / name


def area(corners):
    return TriangleMesh(corners).area


@pytest.mark.parametrize("coding", ["ascii", "binary_little_endian", "binary_big_endian"])
@pytest.mark.parametrize(
    "given",
    [
        {},
        {"extra": NORMALS + COLOURS, "remark": "made by Gehäuse"},
        {"vertices": [*CORNERS, [9, 9, 9], [np.nan, 0, 0]]},
        {"vertices": [*CORNERS, *CORNERS], "faces": [*SIDES, [5, 8, 7], [5, 7, 6]]},
        {"extra": SEAM, "remark": "TextureFile wood.png"},
        {"faces": [[0, 1, 2, 3]], "vertices": CORNERS * np.sqrt(AREA / 4.0)},
    ],
    ids=["plain", "normals and colours", "not all in use", "twice", "texture", "quads"],
)
def test_ply_files_are_read_whole(tmp_path, caplog, coding, given):
    path = written(tmp_path, "part.ply", ply(coding, **given))
    corners = read_corners(path)
    assert np.isclose(area(corners), AREA)
    assert len(corners) == (2 if len(given.get("faces", SIDES)) == 1 else 6)
    vertices = np.asarray(given.get("vertices", CORNERS), dtype=float)
    assert np.array_equal(read_points(path), vertices[np.isfinite(vertices).all(axis=1)])
    assert not caplog.records  # a picture that a remark names is not looked for


def test_the_corners_of_an_obj_file_are_points_where_there_are_no_faces(tmp_path):
    path = written(tmp_path, "scan.obj", obj([*CORNERS, [np.nan, 0, 0]], faces=[]))
    assert np.array_equal(read_points(path), CORNERS)


def test_a_point_at_a_seam_of_a_texture_is_one_point(tmp_path):
    content = ply("ascii", faces=SIDES).decode()
    content = content.replace("end_header", "property list uchar float texcoord\nend_header")
    for number, side in enumerate(SIDES):
        line = " ".join(map(str, (3, *side)))
        content = content.replace(f"{line}\n", f"{line} 6 {number} 0 0 {number} 0 0\n")
    path = written(tmp_path, "part.ply", content)
    assert np.array_equal(read_points(path), CORNERS)
    assert np.isclose(area(read_corners(path)), AREA - 4.0)


@pytest.mark.parametrize(
    "content",
    [
        stl_bytes(),
        stl_bytes(header=b"\xe4\xff by another program"),
        stl_text(),
        stl_text(end="\r\n").upper(),
        stl_text(name="Gehäuse"),
        stl_text(SIDES) + stl_text(TRIANGLES[4:], "second") + stl_text([], "empty"),
        stl_text([*TRIANGLES, [0, 0, 1]]),
        stl_text().replace(b"normal 0 0 0", b"normal -nan(ind) 0 0"),
    ],
    ids=["binary", "any header", "text", "capitals", "name", "bodies", "no area", "no normals"],
)
def test_stl_files_are_read_whole(tmp_path, caplog, content):
    corners = read_corners(written(tmp_path, "part.STL", content))
    assert (len(corners), pytest.approx(AREA)) == (6, area(corners))
    assert np.isclose(Surface("part", TriangleMesh(corners)).samples.areas.sum(), AREA)
    assert not caplog.records


@pytest.mark.parametrize(
    "content",
    [
        obj(),
        obj(faces=[*SIDES, BASE]),
        obj(told="{1}", end="\r\n"),
        obj(told="{0}//1", before="# by hand\nmtllib none.mtl\nvn 0 0 1\n"),
        obj(told="{0}/1/1", before="o part one\nvt 0 0\nvn 0 0 1\nusemtl Holz_braun\ns off\n"),
        "\ufeff" + obj(),
        obj(before="# Gehäuse\n").encode("latin-1"),
        obj().encode("utf-16"),
        obj(faces=SIDES) + "o other\n" + "".join(f"v {x} {y} {z}\n" for x, y, z in CORNERS) + "f 6 9 8 7\n",
        obj(faces=[*SIDES, BASE]).replace("v ", "\tv\t").replace("f 1 ", " f  1 \\\n")
        + "l 1 2\nf\n# f 1 2 9",
        obj(faces=[*TRIANGLES, [0, 1]]).replace(" 1.0\n", " 1.0 0.5 0.5 0.5\n"),
    ],
    ids=[
        "plain",
        "quads",
        "behind",
        "normals",
        "texture",
        "mark",
        "latin",
        "wide",
        "bodies",
        "spaces",
        "colours",
    ],
)
def test_obj_files_are_read_whole(tmp_path, content):
    corners = read_corners(written(tmp_path, "part.obj", content))
    assert (len(corners), pytest.approx(AREA)) == (6, area(corners))


@pytest.mark.parametrize("name", ["notched.obj", "notched.ply"])
@pytest.mark.parametrize("first", range(5))
def test_a_face_that_is_not_convex_is_divided_rightly_or_refused(tmp_path, name, first):
    around = np.roll(np.arange(5), -first).tolist()
    content = obj(FOLDED, [around]) if name.endswith("obj") else ply("ascii", FOLDED, [around])
    path = written(tmp_path, name, content)
    if first == 3:  # a fan about the notch
        assert np.isclose(area(read_corners(path)), NOTCHED)
    else:
        with pytest.raises(InputError, match="that are not convex"):
            read_corners(path)


@pytest.mark.parametrize("first", range(4))
def test_a_dart_of_four_corners_is_divided_rightly_or_refused(tmp_path, first):
    dart = [[0, 0, 0], [4, 0, 0], [1, 1, 0], [0, 4, 0]]
    path = written(tmp_path, "dart.obj", obj(dart, [np.roll(np.arange(4), first).tolist()]))
    if first % 2:
        with pytest.raises(InputError, match="that are not convex"):
            read_corners(path)
    else:
        assert np.isclose(area(read_corners(path)), 4.0)


def test_sheets_of_two_sides_and_folds_of_triangles_are_no_faces_divided_wrongly(tmp_path):
    both = obj(faces=[BASE, BASE[::-1], *SIDES, *(side[::-1] for side in SIDES)])
    assert np.isclose(area(read_corners(written(tmp_path, "sheet.obj", both))), 2.0 * AREA)
    folded = obj([*CORNERS, [0, -2, 0], [1, 0, 0]], [[0, 1, 2], [2, 0, 6], [0, 2, 3]])
    assert len(read_corners(written(tmp_path, "folded.obj", folded))) == 3


ASCII, BINARY = ply("ascii", faces=[*SIDES, BASE]), ply("binary_little_endian")
PLY_OF_STRIPS = ply("ascii", faces=[[0, 1, 4, 2]]).replace(b"element face", b"element tristrips")


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("a.stl", b"", "is empty"),
        ("a.stl", stl_text()[:-300], "ends too early"),
        ("a.stl", stl_bytes()[:-30], "ends too early"),
        ("a.stl", stl_text([]), "no triangle"),
        ("a.stl", stl_text().replace(b"vertex 1.0", b"vertex nan "), "holds|STL"),
        ("a.ply", ASCII[: ASCII.index(b"3 1 2")], "ends too early: its header says 10 lines, but 6 follow"),
        ("a.ply", BINARY[:-20], "ends too early"),
        ("a.ply", BINARY.replace(b"face 6", b"face 4000000000"), "its length is not what its header says"),
        ("a.ply", ASCII.replace(b"face 5", b"face 4000000000"), "its header says 4000000005 lines"),
        ("a.ply", ply("binary_little_endian", faces=[*SIDES, BASE]), "differing numbers of corners"),
        ("a.ply", ply("ascii", [*CORNERS[:4], [np.nan] * 3]), "4 triangles with a corner that is not"),
        ("a.ply", ply("ascii", CORNERS * 1e7), "2e.07: 1e.06 is the largest; a survey must be moved"),
        ("a.ply", PLY_OF_STRIPS, "triangles in strips"),
        ("a.ply", ply("ascii", faces=None), "points: FILE"),
        ("a.ply", ply("ascii", faces=[[0, 1, 7]]), "corners it does not hold"),
        ("a.ply", ply("ascii", faces=[BASE, [0, 1, 2, 65536]]), "corners it does not hold"),
        ("a.ply", ply("binary_big_endian", faces=[[0, 1, -1, 2]]), "corners it does not hold"),
        ("a.stl", stl_text().replace(b"1.0", b"1,0", 1), "STL"),
        ("a.ply", ASCII.replace(b"1.0 1.0 1.0", b"1.0 1;0 1.0"), "PLY"),
        ("a.obj", obj(CORNERS[:3]), "a face has the corner 5, but there are 3"),
        ("a.obj", obj().replace("v 2.0 2.0 0.0", "v 2.0 2.0"), "a.obj:3: a corner must have three numbers"),
        ("a.obj", obj().replace("v 2.0 2.0 0.0", "v 2.0 2_0 0.0"), "a.obj:3: a corner must have three"),
        ("a.obj", obj().replace("v 2.0 2.0 0.0", "v 2.0 2,0 0.0"), "a.obj:3: a corner must have three"),
        ("a.obj", obj().replace("f 1 2 5", "f 1 2 1.5"), "a.obj:6: a face must have whole numbers"),
        ("a.obj", obj().replace("f 1 2 5", "f 1 2 0"), "a.obj:6: a face has the corner 0, but there are 5"),
        ("a.obj", obj().replace("f 1 2 5", "f 1 2 -6"), "a.obj:6: a face has the corner -6"),
        ("a.obj", obj(faces=[]), "points: FILE"),
        ("a.obj", "<html>not found</html>", "no triangle"),
    ],
)  # fmt: skip
def test_what_would_be_read_wrongly_is_refused_with_the_reason(tmp_path, name, content, words):
    with pytest.raises(InputError, match=words):
        read_corners(written(tmp_path, name, content))


@pytest.mark.parametrize("name", ["a.stl", "b.stl", "a.ply", "b.ply"])
def test_no_beginning_of_a_file_is_taken_for_the_whole(tmp_path, name):
    contents = {"a.stl": stl_text(), "b.stl": stl_bytes(), "a.ply": ply("ascii"), "b.ply": BINARY}
    content = contents[name].rstrip(b"\n")
    for end in range(1, len(content) - 8, 7):
        with pytest.raises(InputError):
            read_corners(written(tmp_path, name, content[:end]))
