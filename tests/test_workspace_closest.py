"""Laws of the closest point of the swept surface, and of the sign of the distance to it."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from strategies import FAMILIES, angles, arms, end_effector, make_arm

from synth.geometry import SweptCircle, WorkspaceSurface, critical_angles, sampling_angles

ANYWHERE = np.random.default_rng(4).uniform(-1.0, 1.0, (60, 3))
ROUNDING = 2e-15  # m, of distances of a metre or two


def torus(a, radius, height=0.0):
    """Axis 2 along y at (a, 0, height): the circle lies in a plane with axis 1."""
    return SweptCircle(np.array([a, 0.0, height]), np.array([0.0, 1.0, 0.0]), radius)


def from_tube(points, a, radius):
    """Signed distance to a ring torus about z, or to the outer part of a spindle torus."""
    return np.hypot(np.hypot(points[:, 0], points[:, 1]) - a, points[:, 2]) - radius


def test_the_distance_to_a_torus_has_a_closed_form():
    assert_allclose(
        torus(0.5, 0.2).signed_distance(ANYWHERE), from_tube(ANYWHERE, 0.5, 0.2), rtol=0, atol=ROUNDING
    )


def test_what_a_spindle_torus_encloses_about_axis_1_is_outside():
    # Seen from the half-plane the circle folds over at the axis: a second circle about (-a, 0), with a < R.
    a, radius = 0.2, 0.5
    rho = np.hypot(ANYWHERE[:, 0], ANYWHERE[:, 1])
    to_outer = from_tube(ANYWHERE, a, radius)
    to_inner = np.hypot(rho + a, ANYWHERE[:, 2]) - radius
    # Where the fold is sharp, the nearest point of either circle may lie on the half that is not there.
    tip = np.hypot(rho, np.abs(ANYWHERE[:, 2]) - np.sqrt(radius**2 - a**2))
    outer_is_there = a + radius * (rho - a) / (to_outer + radius) >= 0
    inner_is_there = -a + radius * (rho + a) / (to_inner + radius) >= 0
    expected = np.minimum(
        np.where(outer_is_there, np.abs(to_outer), tip), np.where(inner_is_there, np.abs(to_inner), tip)
    )
    signed = torus(a, radius).signed_distance(ANYWHERE)
    assert_allclose(np.abs(signed), expected, rtol=0, atol=ROUNDING)
    assert np.array_equal(signed < 0, (to_outer < 0) & (to_inner > 0))
    assert torus(a, radius).signed_distance([0.0, 0.0, 0.0]) == pytest.approx(radius - a)


@given(arms(), angles(), st.floats(1e-9, 0.5), st.integers(0, 2**32))
def test_the_closest_point_is_on_the_surface_in_the_half_plane_of_its_point(arm, theta2, away, seed):
    direction = np.random.default_rng(seed).normal(size=(8, 3))
    p = np.concatenate([ANYWHERE[:12], end_effector(arm.circle, 0.3, theta2) + away * direction])
    closest = arm.circle.closest_point(p)
    assert np.all(arm.circle.distance(closest) < ROUNDING)
    if arm.family != "coincident":
        assert np.all(WorkspaceSurface.from_squared_distances(arm.distances).residual(closest) < 1e-10)
    assert_allclose(closest[:, 0] * p[:, 1], closest[:, 1] * p[:, 0], rtol=0, atol=1e-15)
    assert np.all(np.sum(closest[:, :2] * p[:, :2], axis=-1) >= 0)


@given(arms())
@settings(max_examples=40)
def test_no_point_of_the_surface_is_closer(arm):
    poses = end_effector(arm.circle, 0.0, np.linspace(-np.pi, np.pi, 4001))
    section = np.stack([np.hypot(poses[:, 0], poses[:, 1]), poses[:, 2]], axis=-1)
    points = np.concatenate([ANYWHERE, arm.circle.centre[None], [[0, 0, 0.1], [0, 0, arm.z0]]])
    meridian = np.stack([np.hypot(points[:, 0], points[:, 1]), points[:, 2]], axis=-1)
    nearest = np.min(np.linalg.norm(meridian[:, None] - section, axis=-1), axis=1)
    assert np.all(arm.circle.distance(points) <= nearest + ROUNDING)


@given(arms())
def test_on_the_way_to_the_closest_point_it_stays_the_closest(arm):
    found = arm.circle.closest_point(ANYWHERE)
    for share in (0.1, 0.9):
        between = found + share * (ANYWHERE - found)
        expected = share * np.linalg.norm(ANYWHERE - found, axis=-1)
        assert_allclose(arm.circle.distance(between), expected, rtol=0, atol=ROUNDING)
        assert_allclose(arm.circle.closest_point(between), found, rtol=0, atol=1e-6)


@pytest.mark.parametrize("family", FAMILIES)
def test_the_signed_distance_has_a_gradient_of_length_1(family):
    circle, step = make_arm(family).circle, 1e-6
    ahead, behind = (circle.signed_distance(ANYWHERE[:, None] + s * np.eye(3)) for s in (step, -step))
    length = np.linalg.norm(ahead - behind, axis=-1) / (2 * step)
    # None of these points happens to be on the medial axis, where two points are equally close.
    assert_allclose(length, 1.0, rtol=0, atol=1e-6)


@given(arms())
def test_the_sign_is_that_of_gamma(arm):
    signed = arm.circle.signed_distance(ANYWHERE)
    gamma = WorkspaceSurface.from_squared_distances(arm.distances).value(ANYWHERE)
    # Hardware baselines leave rounding of 1e-15 in Gamma, see test_geometry_gamma.
    clear = np.abs(gamma) > 1e-13
    assert np.array_equal((signed < 0)[clear], (gamma > 0)[clear])
    if arm.family not in {"skew", "mirror"}:
        assert np.all(signed >= 0)


def test_a_point_of_axis_1_has_one_of_its_circle_of_closest_points():
    closest = torus(0.5, 0.2).closest_point([[0.0, 0.0, 0.0], [-0.0, -0.0, 0.0]])
    assert_allclose(closest, [[0.3, 0, 0], [0.3, 0, 0]], rtol=0, atol=1e-15)


@pytest.mark.parametrize("axis", [[0, 0, 1.0], [0, 0.6, 0.8]])
def test_a_circle_without_radius_sweeps_a_circle(axis):
    circle = SweptCircle(np.array([0.3, 0.0, 0.1]), np.array(axis), 0.0)
    assert_allclose(circle.closest_point([0.0, -0.9, 0.9]), [0, -0.3, 0.1], rtol=0, atol=1e-15)
    assert circle.signed_distance([0.0, -0.9, 0.9]) == pytest.approx(1.0)


# Found by random search: minima as close together as 1e-5 rad, of which one is lower by nanometres.
@pytest.mark.parametrize("a", [0.01, 3e-4, 1e-6, 2e-7, 0.0])
@pytest.mark.parametrize("alpha", [np.pi / 2, 0.13])
@pytest.mark.parametrize("h", [0.0, -0.31])
def test_neighbouring_minima_are_told_apart(a, alpha, h):
    circle = make_arm("skew", a=a, alpha=alpha, h=h, radius=0.2).circle
    x, y, _ = np.moveaxis(circle.points(sampling_angles(4)), -1, 0)
    ahead = circle.points(sampling_angles(4) + np.pi / 2) - circle.centre
    shear = x * ahead[:, 0] + y * ahead[:, 1]
    turning = np.concatenate(
        [
            critical_angles(shear**2 + (x**2 + y**2) * ahead[:, 2] ** 2),
            critical_angles((x**2 + y**2)[::2]),
        ]
    )
    beside = np.concatenate([[0.0], np.geomspace(1e-9, 1e-2, 30)])
    on = circle.points(np.concatenate([np.add.outer(turning, s * beside).ravel() for s in (1, -1)]))
    assert np.all(circle.distance(on) < ROUNDING)


def test_shapes_pass_through_and_no_points_are_no_mistake():
    circle = make_arm("skew").circle
    points = ANYWHERE.reshape(5, 4, 3, 3)
    assert_allclose(circle.closest_point(points)[2, 1, 0], circle.closest_point(points[2, 1, 0]))
    assert circle.distance(points).shape == (5, 4, 3)
    assert circle.closest_point(np.empty((0, 3))).shape == (0, 3)
