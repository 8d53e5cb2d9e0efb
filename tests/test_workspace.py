"""Laws of the workspace of an arm: area, bounding box, section, mesh, samples."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from planted import ROBOT, planted_arm
from scipy.integrate import quad
from strategies import FAMILIES, arms, make_arm

from synth.geometry import SweptCircle
from synth.robot import Arm, BasePose, Interval, JointLimits, LinkShape, Workspace
from synth.task import Topology

TOPOLOGIES = [Topology.ANY, Topology.SPHERICAL, Topology.PUMA, Topology.SCARA]
STRAIGHT = LinkShape([[0.0, 0.0]], [0.6])


def arm_about(circle, base=BasePose()):  # noqa: B008 - frozen
    """An arm that moves P5 on any circle: the link is not asked how it would get there."""
    arm = Arm(ROBOT, STRAIGHT, 0.455, 0.46, base)
    across = np.linalg.svd(circle.axis[None])[2][1]
    frame = np.column_stack([circle.axis, np.cross(across, circle.axis), across])
    arm.__dict__.update(circle=circle, end_frame=(frame, circle.centre))
    return arm


@pytest.fixture(params=TOPOLOGIES, ids=lambda topology: topology.value, scope="module")
def workspace(request):
    arm = planted_arm(np.random.default_rng(7), request.param)
    return Workspace.within_limits(replace(arm, base=BasePose([0.3, -0.2, 0.1], 0.7)))


def grid(workspace, count=721):
    limits = workspace.limits
    theta1 = np.linspace(limits.base.lower, limits.base.upper, count)[:, None]
    theta2 = np.linspace(limits.second.lower, limits.second.upper, count)
    return workspace.arm.forward_kinematics(theta1, theta2).reshape(-1, 3)


class TestArea:
    @pytest.mark.parametrize(("a", "radius"), [(0.5, 0.2), (0.5, 0.5)])
    def test_of_a_ring_torus(self, a, radius):
        circle = SweptCircle(np.array([0.0, a, 0.3]), np.array([1.0, 0.0, 0.0]), radius)
        assert Workspace.unlimited(arm_about(circle)).area == pytest.approx(
            4 * np.pi**2 * a * radius, rel=1e-13
        )

    def test_of_a_spherical_zone_counts_both_sheets(self):
        # Axis 2 is tilted by 0.5 rad at P1 and the circle h along it: a zone 2 R sin(0.5) high.
        axis, h, radius = np.array([np.sin(0.5), 0, np.cos(0.5)]), 0.3, 0.4
        workspace = Workspace.unlimited(arm_about(SweptCircle(h * axis, axis, radius)))
        zone = 2 * np.pi * math.hypot(h, radius) * 2 * radius * np.sin(0.5)
        assert workspace.area == pytest.approx(2 * zone, rel=1e-13)

    def test_of_a_plane_annulus_counts_both_sheets(self):
        circle = SweptCircle(np.array([0.5, 0.0, 0.2]), np.array([0.0, 0.0, 1.0]), 0.3)
        workspace = Workspace.unlimited(arm_about(circle))
        assert workspace.area == pytest.approx(2 * np.pi * (0.8**2 - 0.2**2), rel=1e-13)

    def test_of_coincident_axes_is_none(self):
        circle = SweptCircle(np.array([0.0, 0.0, 0.2]), np.array([0.0, 0.0, 1.0]), 0.3)
        workspace = Workspace.unlimited(arm_about(circle))
        assert workspace.area == pytest.approx(0.0, abs=1e-14)
        assert np.hypot(*workspace.sample(5)[:, :2].T) == pytest.approx(0.3)

    @pytest.mark.parametrize("a", [1e-3, 1e-6, 1e-9])
    @pytest.mark.parametrize("family", ["skew", "mirror"])
    def test_is_right_where_the_tube_is_all_but_flat(self, family, a):
        workspace = Workspace.unlimited(arm_about(make_arm(family, a=a).circle))
        kinks = np.sort(workspace._stretches)
        pieces = [
            quad(workspace.area_element, lower, upper, epsabs=1e-13, epsrel=1e-13, limit=200)[0]
            for lower, upper in pairwise(kinks)
            if upper > lower
        ]
        assert workspace.area == pytest.approx(2 * np.pi * sum(pieces), rel=1e-11)

    def test_adds_up_over_limits(self, workspace):
        base, second = workspace.limits.base, workspace.limits.second
        parts = [
            replace(workspace, limits=JointLimits(base, Interval(*ends))).area
            for ends in [(second.lower, 2.0), (2.0, second.upper)]
        ]
        assert workspace.area == pytest.approx(sum(parts), rel=1e-12)
        half = JointLimits(Interval(base.lower, base.middle), second)
        assert workspace.area == pytest.approx(2 * replace(workspace, limits=half).area, rel=1e-12)
        assert workspace.area < Workspace.unlimited(workspace.arm).area

    def test_limits_beyond_a_turn_count_one_turn(self, workspace):
        wide = JointLimits(Interval(-7.0, 7.0), Interval(1.0, 9.0))
        assert replace(workspace, limits=wide).area == pytest.approx(
            Workspace.unlimited(workspace.arm).area, rel=1e-12
        )


class TestBoundingBox:
    def test_of_a_ring_torus(self):
        base = BasePose([1.0, 2.0, 3.0], 0.4)
        circle = SweptCircle(np.array([0.5, 0.0, 0.3]), np.array([0.0, -1.0, 0.0]), 0.2)
        box = Workspace.unlimited(arm_about(circle, base)).bounding_box
        assert_allclose(box, [[0.3, 1.3, 3.1], [1.7, 2.7, 3.5]], rtol=0, atol=1e-15)

    @given(arms(), st.data())
    def test_holds_all_points_and_is_touched(self, arm, data):
        lower, width = st.floats(-3.0, 3.0), st.floats(0.0, 2 * np.pi)
        limits = JointLimits(*(Interval(low := data.draw(lower), low + data.draw(width)) for _ in range(2)))
        base = BasePose([0.1, 0.2, 0.3], data.draw(lower))
        workspace = Workspace(arm_about(arm.circle, base), limits)
        box, points = workspace.bounding_box, grid(workspace, 181)
        lowest, highest = points.min(axis=0), points.max(axis=0)
        assert np.all(box[0] <= lowest + 1e-14)
        assert np.all(box[1] >= highest - 1e-14)
        # Between points of the grid at most half a step (pi / 180) from a crest: (pi / 180)^2 / 2 of 2 m.
        assert_allclose(box, [lowest, highest], rtol=0, atol=7e-4)

    def test_shrinks_with_the_limits(self, workspace):
        box, whole = workspace.bounding_box, Workspace.unlimited(workspace.arm).bounding_box
        assert np.all(whole[0] <= box[0] + 1e-15)
        assert np.all(whole[1] >= box[1] - 1e-15)

    def test_of_one_posture_is_a_point(self, workspace):
        still = replace(workspace, limits=JointLimits(Interval.fixed(1.0), Interval.fixed(2.0)))
        expected = workspace.arm.forward_kinematics(1.0, 2.0)
        assert_allclose(still.bounding_box, [expected, expected], rtol=0, atol=1e-15)


class TestMesh:
    @pytest.mark.parametrize("family", ["skew", "mirror"])
    def test_of_a_tube_is_closed_and_seen_from_outside(self, family):
        arm = arm_about(make_arm(family, a=0.4, h=0.1, radius=0.2).circle, BasePose([5.0, 0.0, 0.0], 1.0))
        workspace = Workspace(arm, ROBOT.joint_limits)
        mesh = workspace.mesh(math.radians(6))
        edges = np.concatenate([mesh.faces[:, [i, (i + 1) % 3]] for i in range(3)])
        # Each edge runs once in either direction; V - E + F = 0 is a torus.
        assert len(np.unique(edges, axis=0)) == len(edges)
        assert np.array_equal(np.unique(edges, axis=0), np.unique(edges[:, ::-1], axis=0))
        assert len(mesh.vertices) - len(edges) // 2 + len(mesh.faces) == 0
        corners = mesh.vertices[mesh.faces]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
        outwards = arm.base.to_base(corners.mean(axis=1) + 0.01 * normals)
        assert arm.circle.signed_distance(outwards).min() > 0.005

    def test_area_converges_to_that_of_the_surface(self, workspace):
        limited, whole = workspace.area, Workspace.unlimited(workspace.arm).area
        errors = []
        for spacing in (0.1, 0.025):
            mesh = workspace.mesh(spacing)
            errors.append(abs(mesh.face_areas[mesh.reachable].sum() / limited - 1))
            assert mesh.face_areas.sum() == pytest.approx(whole, rel=0.02)
        assert errors[0] < 0.02
        assert errors[1] < 0.2 * errors[0]

    def test_vertices_are_on_the_surface_and_reachable_ones_within_the_limits(self, workspace):
        mesh, arm = workspace.mesh(0.2), workspace.arm
        assert arm.circle.distance(arm.base.to_base(mesh.vertices)).max() < 1e-14
        _, misses = arm.closest_joints(mesh.vertices[np.unique(mesh.faces[mesh.reachable])])
        assert misses.max() < 1e-6  # beside a limit `closest_joints` ends within 1e-5 rad of it
        assert np.all(Workspace.unlimited(arm).mesh(0.2).reachable)

    def test_what_is_below_the_floor_is_not_reachable(self, workspace):
        mesh = workspace.mesh(0.1, floor=0.35)
        kept = mesh.vertices[mesh.faces[mesh.reachable]]
        assert np.all(kept[..., 2] >= 0.35 + workspace.arm.base.position[2] - 1e-8)
        free = workspace.mesh(0.1).reachable
        assert np.all(free[mesh.reachable])
        if workspace.arm.category.value != "scara":
            assert 0 < mesh.reachable.sum() < free.sum()

    def test_of_every_family_is_closed(self):
        for family in FAMILIES:
            mesh = Workspace(arm_about(make_arm(family).circle), ROBOT.joint_limits).mesh(3.0)
            edges = np.concatenate([mesh.faces[:, [i, (i + 1) % 3]] for i in range(3)])
            assert len(np.unique(np.sort(edges, axis=-1), axis=0)) == len(edges) / 2

    @given(arms())
    @settings(max_examples=20)
    def test_none_of_its_vertices_is_closer_than_the_closest_point(self, arm):
        mesh = Workspace.unlimited(arm_about(arm.circle)).mesh(0.3)
        points = np.random.default_rng(2).uniform(-1, 1, (20, 3))
        nearest = np.linalg.norm(points[:, None] - mesh.vertices, axis=-1).min(axis=1)
        assert np.all(arm.circle.distance(points) <= nearest + 1e-15)


class TestSampleAndSection:
    def test_samples_are_uniform_by_area(self, workspace):
        # The share of the samples in a part of the limits is that part's share of the area.
        base, second = workspace.limits.base, workspace.limits.second
        count = 20_000
        points = workspace.sample(count, seed=3)
        assert workspace.arm.closest_joints(points[:50])[1].max() < 1e-7
        # Heights and distances from axis 1 are functions of theta2 alone: compare their means.
        theta2, weights = np.polynomial.legendre.leggauss(400)
        theta2 = second.middle + 0.5 * (second.upper - second.lower) * theta2
        weights = weights * workspace.area_element(theta2)
        local = workspace.arm.base.to_base(points)
        for of in (lambda p: np.hypot(p[:, 0], p[:, 1]), lambda p: p[:, 2]):
            values = of(workspace.arm.kinematics.forward(0.0, theta2))
            mean = np.sum(weights * values) / np.sum(weights)
            spread = np.sqrt(np.sum(weights * (values - mean) ** 2) / np.sum(weights))
            assert abs(of(local).mean() - mean) <= 4 * spread / math.sqrt(count) + 1e-9
        assert base.upper - base.lower < 2 * np.pi  # and the dead zone of joint 1 is left out

    def test_samples_follow_the_seed(self, workspace):
        assert np.array_equal(workspace.sample(10, seed=1), workspace.sample(10, seed=1))
        assert not np.array_equal(workspace.sample(10, seed=1), workspace.sample(10, seed=2))

    def test_the_section_is_that_of_the_samples(self, workspace):
        section = workspace.section(2001)
        assert section.shape == (2001, 2)
        points = workspace.sample(20)
        local = workspace.arm.base.to_base(points)
        found = np.column_stack([np.hypot(local[:, 0], local[:, 1]), points[:, 2]])
        assert np.linalg.norm(found[:, None] - section, axis=-1).min(axis=1).max() < 2e-3

    def test_the_base_pose_moves_everything_alike(self, workspace):
        at_home = replace(workspace, arm=replace(workspace.arm, base=BasePose()))
        base = workspace.arm.base
        assert workspace.area == at_home.area
        assert_allclose(workspace.sample(10), base.to_task(at_home.sample(10)), rtol=0, atol=1e-15)
        assert_allclose(workspace.section(), at_home.section() + [0.0, 0.1], rtol=0, atol=1e-15)
        mesh, home_mesh = workspace.mesh(0.5, floor=0.2), at_home.mesh(0.5, floor=0.2)
        assert_allclose(mesh.vertices, base.to_task(home_mesh.vertices), rtol=0, atol=1e-15)
        assert np.array_equal(mesh.reachable, home_mesh.reachable)
