"""A surface is looked at finely enough to prove what is covered, and coarsely where that is known."""

from dataclasses import replace

import numpy as np
import pytest
from planted import ROBOT
from planted_surfaces import as_mesh, as_task, patch

from synth.errors import InputError
from synth.geometry import Sphere
from synth.robot import Arm, Interval, JointLimits
from synth.surfaces import Profile, Revolved, Surface, TriangleMesh
from synth.synthesis.check import between_samples, verify
from synth.synthesis.check.cell_bounds import largest_misses
from synth.watch import Watch

FOLDED = (42, 51, 57, 66, 71)  # where both joints move P5 nearly alike: the triangles are slivers


def looked_at(monkeypatch, task, arm):
    """Return what is proven of a task's surface, and at how many points the arm was looked at for that."""
    asked, closest_joints = [], Arm.closest_joints
    monkeypatch.setattr(
        Arm, "closest_joints", lambda self, points: asked.append(len(points)) or closest_joints(self, points)
    )
    return between_samples(task, arm, task.surfaces[0], Watch()), sum(asked)


@pytest.mark.parametrize("seed", [4, *FOLDED])
def test_a_mesh_of_thousands_of_triangles_is_proven_covered_by_the_arm_that_it_was_made_of(monkeypatch, seed):
    """Its triangles lie at an angle to what they were taken from, but all their corners on it."""
    task, arm = as_mesh(seed, tolerance=5e-4)
    told, asked = looked_at(monkeypatch, task, arm)
    assert told.met
    assert np.isclose(told.share, 1.0)
    assert asked == told.cells < 1.2 * len(task.surfaces[0].samples)


def test_of_finer_cells_those_are_looked_at_of_which_nothing_is_known(monkeypatch):
    """Of large triangles the middles are missed most: what is within the tolerance there is soon known."""
    task, arm = as_mesh(4, 20, tolerance=1.0)
    finest = task.surfaces[0].cells(64 * len(task.surfaces[0].samples)).points
    worst = float(arm.closest_joints(finest)[1].max())
    task, _ = as_mesh(4, 20, tolerance=1.1 * worst)
    told, asked = looked_at(monkeypatch, task, arm)
    assert told.met
    assert worst <= told.largest <= 1.1 * worst
    assert len(task.surfaces[0].samples) < asked < 0.25 * len(finest)


@pytest.mark.parametrize("seed", FOLDED)
def test_no_point_of_a_triangle_is_missed_by_more_than_its_bound(seed):
    """Of slivers, of triangles at random near the workspace, and of those about a singular posture."""
    rng = np.random.default_rng(seed)
    arm, (low, high) = patch(seed)
    theta2 = np.linspace(low[1], high[1], 2000)
    first, second = arm.kinematics.velocities(
        np.column_stack([0 * theta2, theta2]), arm.forward_kinematics(0.0, theta2)
    )
    angle = np.linalg.norm(np.cross(first, second), axis=1)
    joints = np.concatenate(
        [
            rng.uniform(low, high, (100, 2)),
            np.column_stack([rng.uniform(low[0], high[0], 100), np.full(100, theta2[np.argmin(angle)])]),
        ]
    )
    middles = arm.forward_kinematics(joints[:, 0], joints[:, 1])
    thin = rng.choice([0.02, 1.0], (200, 3, 1))
    for size in (2e-3, 2e-2):
        corners = middles[:, None] + size * thin * rng.normal(size=(200, 3, 3))
        cells = TriangleMesh(corners).cells(1)
        closest, misses = arm.closest_joints(cells.points)
        bounds = largest_misses(arm, closest, misses, cells)
        within = np.einsum("sc,ncx->nsx", rng.dirichlet(np.full(3, 0.5), 100), cells.corners)
        reached = arm.closest_joints(within.reshape(-1, 3))[1].reshape(200, 100)
        assert np.all(reached.max(axis=1) <= bounds + 1e-12)
        assert np.median(bounds) < 3.0 * size


def test_the_corners_of_cells_are_those_of_their_triangles_and_of_nothing_else():
    task, _ = as_mesh(4, 3)
    shape = task.surfaces[0].shape
    cells = shape.cells(500)
    assert len(cells) > 2 * len(shape.corners)
    doubled = np.cross(cells.corners[:, 1] - cells.corners[:, 0], cells.corners[:, 2] - cells.corners[:, 0])
    np.testing.assert_allclose(doubled, 2.0 * cells.areas[:, None] * cells.normals, atol=1e-12)
    np.testing.assert_allclose(cells.corners.mean(axis=1), cells.points, atol=1e-12)
    away = np.linalg.norm(cells.corners - cells.points[:, None], axis=2).max(axis=1)
    assert np.all(away <= cells.radii * (1.0 + 1e-12))


def test_where_joint_1_begins_to_count_its_turn_a_surface_is_covered_too():
    """A band about axis 1 that only joints of a whole turn cover: cells lie across the seam."""
    arm, _ = patch(4)
    theta2 = np.linspace(2.0, 2.2, 9)
    points = arm.forward_kinematics(0.0, theta2)
    limits = JointLimits(Interval(-np.pi, np.pi), ROBOT.joint_limits.second)
    free = replace(arm, robot=replace(ROBOT, joint_limits=limits))
    rho, z = np.hypot(points[:, 0], points[:, 1]), points[:, 2]
    theta1 = np.linspace(0.0, 2.0 * np.pi, 121)
    grid = np.stack(
        [np.outer(np.cos(theta1), rho), np.outer(np.sin(theta1), rho), np.tile(z, (121, 1))], axis=-1
    )
    a, b, c, d = grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]
    corners = np.concatenate([np.stack([a, b, c], axis=2), np.stack([a, c, d], axis=2)]).reshape(-1, 3, 3)
    band = Surface("band", TriangleMesh(corners), tolerance=1e-3)
    task = replace(as_task("band", band), robot=free.robot)
    assert between_samples(task, free, band, Watch()).met


@pytest.mark.parametrize("size", [3e-3, 5e-3])
@pytest.mark.parametrize("coverage", [0.6, 1.0])
def test_of_a_part_for_which_there_are_no_finer_cells_what_is_known_is_told(size, coverage):
    """A spot of a whole sphere, of which few cells have their points in it: with others there may be none."""
    arm, (low, high) = patch(4)
    spot = arm.forward_kinematics(*(0.5 * (low + high)))
    sphere = Revolved(Profile.SPHERE, float(np.linalg.norm(spot)))
    surface = Surface("spot", sphere, tolerance=1e-2, coverage=coverage, region=(Sphere(spot, size),))
    assert 0 < len(surface.samples) < 100
    assert verify(as_task("spot", surface), arm).found


def test_a_part_smaller_than_any_cell_is_refused_with_that_reason():
    sphere = Revolved(Profile.SPHERE, 0.8)
    with pytest.raises(InputError, match="leaves nothing of the surface, or a part smaller than one of its"):
        Surface("spot", sphere, region=(Sphere(0.8 * np.array([0.6, 0.0, 0.8]), 1e-5),))
