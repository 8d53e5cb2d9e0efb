"""The set of files: meshes, where they come from, what the command writes, all or nothing."""

import json
import struct
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from command import invoked
from robot_files import (
    Urdf,
    about,
    arms,
    exported_arm,
    matrix,
    mjcf,
    numbers,
    random_joints,
    solution_with,
)

import synth
from synth.errors import InputError, SynthError
from synth.export.planners.rotations import quaternion
from synth.geometry import Box, Capsule, Sphere, roll_pitch_yaw
from synth.synthesis import Design, NotFoundError, Status, verify
from synth.task import Obstacle, TargetTable, Task

ARMS = arms()
exported = pytest.fixture(scope="module", params=ARMS)(exported_arm)


def obj(path):
    lines = [line.split() for line in path.read_text().splitlines()]
    vertices = np.array([[float(part) for part in line[1:]] for line in lines if line[0] == "v"])
    return vertices, np.array([[int(part) - 1 for part in line[1:]] for line in lines if line[0] == "f"])


def volume(vertices, faces):
    a, b, c = np.moveaxis(vertices[faces], 1, 0)
    return np.sum(a * np.cross(b, c)) / 6.0


def is_closed(faces):
    """Whether each edge is passed once in each direction."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    there, back = {tuple(edge) for edge in edges.tolist()}, {tuple(edge) for edge in edges[:, ::-1].tolist()}
    return there == back and len(there) == len(edges)


def test_the_tube_that_is_shown_is_closed_and_of_the_right_volume(exported):
    arm, folder = exported
    vertices, faces = obj(folder / "malleable_link.obj")
    assert is_closed(faces)
    radius = max(0.5 * arm.robot.link.diameter, 1e-3)
    assert volume(vertices, faces) == pytest.approx(np.pi * radius**2 * arm.shape.length, rel=0.02)
    meshes = [m.get("filename") for m in Urdf(folder / "robot.urdf").root.iter("mesh")]
    assert meshes == ["malleable_link.obj"]


def test_the_workspace_is_the_same_in_all_formats(exported):
    arm, folder = exported
    mesh = synth.Workspace.within_limits(arm).mesh(np.radians(3.0), -1.0)
    stl = (folder / "workspace.stl").read_bytes()
    assert not stl.startswith(b"solid")
    assert struct.unpack("<I", stl[80:84])[0] == len(mesh.faces)
    kind = [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")]
    corners = np.frombuffer(stl[84:], dtype=kind)["corners"]
    np.testing.assert_allclose(corners, mesh.vertices[mesh.faces], atol=1e-6)
    reachable = (folder / "workspace_reachable.stl").read_bytes()
    assert struct.unpack("<I", reachable[80:84])[0] == mesh.reachable.sum()
    header, _, body = (folder / "workspace.ply").read_bytes().partition(b"end_header\n")
    assert f"element face {len(mesh.faces)}".encode() in header
    points = np.frombuffer(body, "<f8", 3 * len(mesh.vertices)).reshape(-1, 3)
    np.testing.assert_array_equal(points, mesh.vertices)
    glb = (folder / "workspace.glb").read_bytes()
    assert struct.unpack("<4sII", glb[:12]) == (b"glTF", 2, len(glb))
    size = struct.unpack("<I", glb[12:16])[0]
    content = json.loads(glb[20 : 20 + size])
    assert sum(a["count"] for a in content["accessors"] if a["type"] == "SCALAR") == mesh.faces.size


@pytest.mark.parametrize(
    "name", ["robot.urdf", "robot.srdf", "robot.xml", "robot.xrdf", "dh.json", "kinematics.c"]
)
def test_every_file_says_where_it_comes_from_and_its_units(exported, name):
    text = (exported[1] / name).read_text()
    assert "metres, radians" in text
    assert "seed 7" in text
    assert "shape 1" in text


def test_binary_files_say_it_too(exported):
    for name in ("workspace.stl", "workspace.ply", "workspace.glb", "malleable_link.obj"):
        assert b"two & <crates>" in (exported[1] / name).read_bytes()[:1200], name


def test_obstacles_stand_in_the_mjcf(tmp_path):
    obstacles = (
        Obstacle("shelf", Box([3.0, 0.2, 0.5], [0.1, 0.4, 0.2], 0.3)),
        Obstacle("ball", Sphere([-3.0, 0.2, 0.5], 0.05)),
        Obstacle("pipe", Capsule([[0.0, 3.0, 0.0], [0.0, 3.0, 1.0]], 0.04)),
        Obstacle("knob", Capsule([[0.0, 4.0, 0.0], [0.0, 4.0, 0.0]], 0.04)),
    )
    solution_with(ARMS["elsewhere"], -0.2, obstacles).export(tmp_path, "mjcf")
    geoms = {each.get("name"): each.attrib for each in mjcf(tmp_path).findall("worldbody/geom")}
    assert geoms["floor"]["type"] == "plane"
    np.testing.assert_allclose(numbers(geoms["floor"]["pos"]), [0.4, -0.3, -0.2])
    np.testing.assert_allclose(numbers(geoms["obstacle_1_shelf"]["size"]), [0.05, 0.2, 0.1])
    assert [geoms[name]["type"] for name in list(geoms)[:4]] == ["box", "sphere", "capsule", "sphere"]
    assert [path.name for path in tmp_path.iterdir()] == ["robot.xml"]


def test_of_many_targets_the_first_are_named(tmp_path):
    arm = ARMS["general"]
    joints = random_joints(arm, 1500)
    points = arm.forward_kinematics(*joints.T)
    table = TargetTable([f"t {i}" for i in range(1500)], points, np.full(1500, 1e-3), np.ones(1500))
    task = Task("scan", arm.robot, table, arm.base, floor=None)
    few = solution_with(arm)
    many = replace(few, task=task, designs=(Design(arm, verify(task, arm)),))
    names = {path.name for path in many.export(tmp_path)}
    assert "trajectory.csv" not in names
    states = ET.parse(tmp_path / "robot.srdf").getroot().findall("group_state")
    assert [state.get("name") for state in states] == [f"t_{i}" for i in range(1000)]
    assert len(mjcf(tmp_path).findall("keyframe/key")) == 1000


def test_rotations_are_written_and_read_back_wherever_they_stand():
    rng = np.random.default_rng(0)
    angles = [*rng.uniform(-np.pi, np.pi, (200, 3)), [0.3, np.pi / 2, 0.7], [1.0, -np.pi / 2, 2.0]]
    angles += [[0.0, 0.0, np.pi], [np.pi, 0.0, 0.0], [0.0, np.pi, 0.0], [0.0, 0.0, 0.0]]
    for roll, pitch, yaw in angles:
        rotation = about(2, yaw) @ about(1, pitch) @ about(0, roll)
        r, p, y = roll_pitch_yaw(rotation)
        np.testing.assert_allclose(about(2, y) @ about(1, p) @ about(0, r), rotation, atol=1e-14)
        w, *xyz = quaternion(rotation)
        assert w >= 0.0
        element = ET.Element("body", quat=" ".join(map(repr, map(float, [w, *xyz]))))
        np.testing.assert_allclose(matrix(element)[:3, :3], rotation, atol=1e-14)


def test_the_command_writes_what_is_asked_for(tmp_path):
    solution = synth.solve("problems/two-crates/task.yaml")
    synth.write_files(solution, tmp_path)
    out = tmp_path / "out"
    result = invoked("export", tmp_path / "solution.json", "--urdf", "--srdf", "-o", out)
    assert result.exit_code == 0, result.output
    assert sorted(path.name for path in out.iterdir()) == ["malleable_link.obj", "robot.srdf", "robot.urdf"]
    result = invoked("export", tmp_path / "solution.json", "--shape", 2, "-o", out)
    assert result.exit_code == 0, result.output
    assert "shape 2" in (out / "robot.xml").read_text()
    assert len(list(out.iterdir())) == 13


def test_a_wrong_solution_or_kind_writes_nothing(tmp_path):
    (tmp_path / "solution.json").write_text("{}")
    result = invoked("export", tmp_path / "solution.json", "-o", tmp_path / "out")
    assert result.exit_code == 2
    assert not (tmp_path / "out").exists()
    solution = solution_with(ARMS["general"])
    with pytest.raises(InputError, match=r"usd: is no kind of file; known are urdf, srdf"):
        solution.export(tmp_path / "out", "urdf", "usd")
    assert not (tmp_path / "out").exists()


def test_a_solution_without_a_shape_exports_nothing(tmp_path):
    empty = replace(solution_with(ARMS["general"]), designs=(), status=Status.FAILED)
    with pytest.raises(NotFoundError):
        empty.export(tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_everything_is_written_or_nothing(tmp_path, monkeypatch):
    solution = solution_with(ARMS["general"])
    solution.export(tmp_path, "urdf")
    before = (tmp_path / "robot.urdf").read_bytes()
    move = Path.replace

    def full(self, target):
        if Path(target).name == "robot.srdf":
            raise OSError(28, "No space left on device")
        return move(self, target)

    monkeypatch.setattr(Path, "replace", full)
    other = solution_with(ARMS["straight"])
    with pytest.raises(SynthError, match="No space left"):
        other.export(tmp_path, "urdf", "srdf")
    assert (tmp_path / "robot.urdf").read_bytes() == before
    assert not (tmp_path / "robot.srdf").exists()
