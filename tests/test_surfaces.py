"""Surfaces to be covered: their cells, their files, what is found of them, and what is proven."""

from dataclasses import replace

import numpy as np
import pytest
from planted_surfaces import as_points, as_task, as_torus, patch

from synth.errors import InputError
from synth.geometry import Sphere, rotation_of
from synth.guide import make_guide
from synth.surfaces import Profile, Rectangle, Revolved, Scan, Surface, TriangleMesh
from synth.synthesis import solve, verify, what_counts
from synth.synthesis.check import between_samples, counted
from synth.synthesis.check.cell_bounds import largest_misses
from synth.synthesis.solution.message import not_of_revolution
from synth.synthesis.starts.refined import Trimmed
from synth.task import parse_task, sampled
from synth.watch import Watch

SHAPES = [
    Revolved(Profile.SPHERE, 0.3),
    Revolved(Profile.CYLINDER, 0.2, 0.5),
    Revolved(Profile.TORUS, 0.4, 0.15),
    Revolved(Profile.DISC, 0.3),
    Rectangle(np.array([0.3, 0.7])),
]
PYRAMID = np.array([[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [1, 1, 1]]) * 0.2
SIDES = TriangleMesh(PYRAMID[[[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]])


@pytest.mark.parametrize("shape", [*SHAPES, SIDES], ids=lambda shape: getattr(shape, "profile", type(shape)))
def test_cells_have_the_whole_area_and_about_one_size(shape):
    cells = shape.cells(3000)
    assert 0.6 * 3000 < len(cells) < 1.7 * 3000
    assert np.isclose(cells.areas.sum(), shape.area, rtol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(cells.normals, axis=1), 1.0)
    assert np.percentile(cells.areas, 95) < 2.5 * np.percentile(cells.areas, 5)


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: getattr(shape, "profile", type(shape)))
def test_every_point_is_within_the_radius_of_a_cell_and_bends_no_more_than_told(shape):
    coarse, fine = shape.cells(300), shape.cells(20_000)
    away = np.linalg.norm(fine.points[:, None] - coarse.points[None], axis=2)
    assert np.all((away <= coarse.radii).any(axis=1))
    nearest = np.argmin(away, axis=1)
    off = np.abs(np.einsum("ni,ni->n", fine.points - coarse.points[nearest], coarse.normals[nearest]))
    assert np.all(off <= 0.5 * coarse.curvatures[nearest] * coarse.radii[nearest] ** 2 + 1e-12)


def test_a_region_a_margin_and_a_pose_cut_and_move():
    turned = np.array([0.3, -0.2, 1.0])
    ball = Sphere(np.array([0.5, 0.0, 0.3]), 0.2)
    surface = Surface(
        "s", SHAPES[4], position=np.array([0.5, 0.1, 0.3]), rpy=turned, region=(ball,), margin=0.1
    )
    points = surface.cells(2000).points
    own = (points - surface.position) @ rotation_of(*turned)
    assert np.all(ball.distance(points) <= 0.0)
    assert np.abs(own[:, 2]).max() < 1e-12
    assert np.all(np.abs(own[:, :2]) <= 0.5 * SHAPES[4].size - 0.1)
    assert len(points) > 900


def test_the_boundary_of_a_mesh_is_of_edges_of_one_triangle():
    assert len(SIDES.boundary) == 4
    np.testing.assert_allclose(SIDES.boundary_distance(PYRAMID[4:]), np.hypot(0.2, 0.2), rtol=1e-5)
    with pytest.raises(InputError, match="no boundary of its own"):
        Surface("s", SHAPES[0], margin=0.1)


def test_what_counts_of_a_surface_is_what_is_missed_least():
    surface = Surface("s", Scan(np.arange(30.0).reshape(10, 3)), coverage=0.7)
    task = as_task("t", surface)
    misses = np.array([5, 1, 9, 2, 3, 8, 4, 7, 6, 0.0])
    assert counted(task, misses).sum() == 7
    assert misses[counted(task, misses)].max() == 6
    weights = Trimmed(task).weights(np.stack([misses, misses[::-1]]) ** 2)
    assert np.array_equal(weights > 0.0, [misses <= 6, misses[::-1] <= 6])


def test_a_scan_with_outliers_is_found_to_its_noise_and_the_answer_holds_for_points():
    task, _, inliers = as_points(0, 400, outliers=0.2)
    solution = solve(task, alternatives=0)
    (covering,) = solution.best.verification.coverings
    assert solution.found
    assert np.sqrt(np.mean(solution.robot.closest_joints(task.table.positions[inliers])[1] ** 2)) < 1e-4
    assert 0.8 <= covering.share < 0.85
    assert not covering.is_joined
    assert len(covering.uncovered) == round((1.0 - covering.share) * 400)
    assert "80 % is asked" in covering.sentence
    whole = tuple(replace(surface, coverage=1.0) for surface in task.surfaces)
    assert not verify(replace(task, surfaces=whole, targets=sampled(whole)), solution.robot).found


def test_the_share_of_a_torus_agrees_with_ten_times_the_samples():
    task = as_torus(1)
    solution = solve(task, alternatives=0)
    check, (surface,) = solution.best.verification, task.surfaces
    (covering,), (between,) = check.coverings, check.between
    cells = surface.cells(10 * len(surface.samples))
    finer = replace(surface, shape=Scan(cells.points, cells.areas), position=np.zeros(3), rpy=np.zeros(3))
    counted_again = verify(as_task("finer", finer), solution.robot).coverings[0]
    assert solution.found
    assert abs(covering.share - counted_again.share) < 0.01
    assert 0.25 <= between.share <= counted_again.share + 0.01


def test_no_point_of_a_cell_is_missed_by_more_than_its_bound():
    arm, (low, high) = patch(3)
    rng = np.random.default_rng(1)
    joints = rng.uniform(low, high, (40, 2))
    first, second = arm.kinematics.velocities(joints, arm.forward_kinematics(*joints.T))
    normals = np.cross(first, second)
    normals += 0.05 * np.linalg.norm(normals, axis=1, keepdims=True) * rng.normal(size=normals.shape)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    points = arm.forward_kinematics(*joints.T) + 1e-3 * rng.normal(size=(40, 3))
    across = np.cross(normals, rng.normal(size=normals.shape))
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    closest, misses = arm.closest_joints(points)
    for radius in (1e-3, 1e-2, 5e-2):
        cells = replace(
            Revolved(Profile.DISC, 0.1).cells(10).take(np.zeros(40, dtype=int)),
            points=points, normals=normals, radii=np.full(40, radius),
        )  # fmt: skip
        bounds = largest_misses(arm, closest, misses, cells)
        at_edge = arm.closest_joints(points + radius * across)[1]
        assert np.all(at_edge <= bounds + 1e-12)
        assert np.median(bounds - misses) < 0.3 * radius + 5.0 * radius**2


def test_what_is_between_the_samples_is_not_taken_for_covered():
    arm, (low, _) = patch(3)
    surface = Surface("s", Rectangle(np.array([0.4, 0.4])), position=arm.forward_kinematics(*low))
    told = between_samples(as_task("t", surface), arm, surface, Watch())
    assert not told.met
    assert len(told.unproven) > 0
    assert "not excluded" in told.sentence or "nothing is certain" in told.sentence


TASK = {"synth": 1, "length_unit": "mm", "robot": "malleable-2dof"}
DOME = {
    "name": "dome",
    "sphere": {"center": [150, 100, 0], "radius": 520},
    "region": [{"sphere": {"center": [410, 100, 450], "radius": 100}}],
}


PATCH = [{"sphere": {"center": [350, 50, 380], "radius": 120}}]
LEVEL = {"center": [350, 0, 300], "normal": [0, 0, 1], "along": [1, 1, 0], "size": [150, 200]}


@pytest.mark.parametrize(
    ("surface", "category"),
    [
        ({"sphere": {"center": [0, 0, 0], "radius": 520}, "region": PATCH}, "spherical"),
        ({"sphere": {"center": [0, 0, 58], "radius": 500}, "region": PATCH}, "puma"),
        ({"rectangle": LEVEL}, "scara"),
    ],
)
def test_spheres_about_p1_and_p2_and_a_plane_are_covered_and_their_category_named(surface, category):
    task = parse_task({**TASK, "surface": {**surface, "tolerance": 1}, "topology": category})
    solution = solve(task, alternatives=0)
    assert solution.found
    assert solution.robot.category.value == category
    assert solution.best.verification.coverings[0].largest < 1e-5


def test_a_dome_off_the_axis_is_refused_with_the_reason_and_covered_from_another_place():
    (reason,) = not_of_revolution(parse_task({**TASK, "surface": DOME}))
    assert "no surface of revolution about axis 1" in reason
    assert not not_of_revolution(parse_task({**TASK, "base": {"position": [150, 100, 0]}, "surface": DOME}))
    base = {"position": [[-300, 300], [-300, 300], [-300, 0]]}
    free = solve(parse_task({**TASK, "surface": DOME, "base": base, "floor": None}), alternatives=0)
    assert free.found
    np.testing.assert_allclose(free.robot.base.position[:2], [0.15, 0.1], atol=5e-3)


@pytest.mark.parametrize(
    ("surface", "words"),
    [
        ({"disc": {"center": [0, 0, 0], "normal": [0, 0, 0], "radius": 5}}, "which is no direction"),
        ({"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}, "add a region"),
        ({"sphere": {"center": [0, 0], "radius": 1}}, "surface.sphere.center: must be a list of 3"),
        ({"sphre": 3}, "did you mean 'sphere'"),
        ({}, "has no shape, but is one of"),
        ({**DOME, "side": "outer"}, "touches a surface from both sides"),
        ({**DOME, "coverage": 1.5}, "surface.coverage: must be at most 1"),
        ({**DOME, "length_unit": "m"}, "is that of a file, but no file"),
        ({**DOME, "margin": 5}, "surface.margin: this surface has no boundary"),
        ({"disc": {"center": [0.4, 0, 0.3], "normal": [0, 0, 1], "radius": 0.05}}, "1000 times as long"),
        ([DOME, DOME], "'dome' is the name of surface"),
        ([], "must hold one surface at least"),
        ("bowl.stl", "must be a mapping"),
    ],
)
def test_what_is_wrong_with_a_surface_is_told(surface, words):
    with pytest.raises(InputError, match=words.replace("[", "[[]")):
        parse_task({**TASK, "surface": surface})


def test_points_of_an_xyz_file_have_a_unit_of_their_own(tmp_path):
    (tmp_path / "scan.xyz").write_text("# a scan\n0.4 0.0 0.3 255 0 0\n0.41\t0.02 0.3\n")
    surface = {"points": "scan.xyz", "length_unit": "m", "pose": {"position": [0, 0, 100]}}
    task = parse_task({**TASK, "surface": surface}, directory=tmp_path)
    np.testing.assert_allclose(task.table.positions, [[0.4, 0.0, 0.4], [0.41, 0.02, 0.4]])


def test_meshes_of_other_programs_are_read_or_refused_with_a_reason(tmp_path):
    trimesh = pytest.importorskip("trimesh")
    bowl = trimesh.creation.icosphere(radius=100.0)
    for name in ("bowl.stl", "bowl.ply", "bowl.obj"):
        bowl.export(tmp_path / name)
        surface = {"mesh": name, "pose": {"position": [400, 0, 300]}}
        (read,) = parse_task({**TASK, "surface": surface}, directory=tmp_path).surfaces
        assert np.isclose(read.shape.area, bowl.area * 1e-6, rtol=1e-5)
    content = (tmp_path / "bowl.ply").read_bytes()
    (tmp_path / "cut.ply").write_bytes(content[: len(content) // 3])
    trimesh.PointCloud(bowl.vertices).export(tmp_path / "cloud.ply")
    (tmp_path / "empty.stl").write_bytes(b"")
    for name, words in (
        ("cut.ply", "is no PLY file that can be read|holds no triangle"),
        ("cloud.ply", "as points: FILE"),
        ("empty.stl", "is empty"),
        ("none.obj", "no such file"),
        ("scan.step", "no file of triangles"),
    ):
        with pytest.raises(InputError, match=words):
            parse_task({**TASK, "surface": {"mesh": name}}, directory=tmp_path)
    cloud = {"points": "cloud.ply", "pose": {"position": [400, 0, 300]}}
    assert len(parse_task({**TASK, "surface": cloud}, directory=tmp_path).targets) == len(bowl.vertices)


def test_without_trimesh_a_mesh_is_refused_with_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "trimesh", None)
    (tmp_path / "bowl.stl").write_text("solid")
    with pytest.raises(InputError, match="needs trimesh"):
        parse_task({**TASK, "surface": {"mesh": "bowl.stl"}}, directory=tmp_path)


def test_what_may_be_left_of_a_surface_has_no_say_in_how_precisely_a_hand_must_work():
    surface = {"sphere": {"center": [0, 0, 58], "radius": 500}, "coverage": 0.2, "tolerance": 20}
    solution = solve(parse_task({**TASK, "surface": surface}), alternatives=0)
    assert solution.found
    counting, check = what_counts(solution.task, solution.robot, solution.best.verification)
    assert 0.2 <= counting.weights.sum() / solution.task.weights.sum() < 0.21
    assert all(check.within_tolerance)
    guide = make_guide(solution.task, solution.best)
    assert guide.tolerance.position > 1e-3
    assert guide.forgiveness.expected_worst_miss < 0.1
