"""The malleable link: arcs, chains of arcs, and what is said about them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from synth.robot import LinkShape, arc_motion, chain_end

curvature = st.one_of(st.just(0.0), st.floats(-9.0, 9.0), st.floats(-1e-9, 1e-9))
arc_length = st.floats(0.01, 0.3)
arcs = st.lists(st.tuples(curvature, curvature, arc_length), min_size=1, max_size=6)


def shape_of(rows):
    rows = np.array(rows)
    return LinkShape(rows[:, :2], rows[:, 2])


@given(kx=curvature, ky=curvature, length=arc_length)
def test_an_arc_solves_its_differential_equation(kx, ky, length):
    # R' = R [w]x with w = (-ky, kx, 0), p' = R z.
    cross = np.array([[0.0, 0.0, kx], [0.0, 0.0, ky], [-kx, -ky, 0.0]])

    def along(_s, state):
        rotation = state[:9].reshape(3, 3)
        return np.concatenate([(rotation @ cross).ravel(), rotation[:, 2]])

    start = np.concatenate([np.eye(3).ravel(), np.zeros(3)])
    end = solve_ivp(along, (0.0, length), start, rtol=1e-10, atol=1e-12).y[:, -1]
    rotation, displacement = arc_motion([kx, ky], length)
    np.testing.assert_allclose(rotation, end[:9].reshape(3, 3), atol=1e-8)
    np.testing.assert_allclose(displacement, end[9:], atol=1e-8)


@given(rows=arcs)
def test_the_end_frame_is_a_rotation(rows):
    rotation, _ = shape_of(rows).end_frame()
    np.testing.assert_allclose(rotation.T @ rotation, np.eye(3), atol=1e-12)
    assert np.linalg.det(rotation) == pytest.approx(1.0)


@given(rows=arcs)
def test_an_arc_cut_in_two_is_the_same_arc(rows):
    halves = [(kx, ky, 0.5 * length) for kx, ky, length in rows for _ in range(2)]
    for whole, cut in zip(shape_of(rows).end_frame(), shape_of(halves).end_frame(), strict=True):
        np.testing.assert_allclose(whole, cut, atol=1e-12)


@given(rows=arcs)
def test_points_along_the_link_start_at_its_start_and_end_at_its_end(rows):
    shape = shape_of(rows)
    points = shape.centreline(0.005)
    np.testing.assert_allclose(points[0], 0.0, atol=1e-15)
    np.testing.assert_allclose(points[-1], shape.end_frame()[1], atol=1e-12)
    chords = np.linalg.norm(np.diff(points, axis=0), axis=1)
    # A chord is shorter than its arc, by at most k^2 s^3 / 24.
    spacing = shape.length / (len(points) - 1)
    assert spacing <= 0.005 + 1e-12
    assert np.all(chords <= spacing + 1e-12)
    assert np.all(chords >= spacing - shape.bends.max() ** 2 * spacing**3 / 24.0 - 1e-12)


@given(rows=arcs)
def test_the_lowest_point_is_exact(rows):
    shape = shape_of(rows)
    heights = shape.point_at(np.linspace(0.0, shape.length, 2001))[:, 2]
    lowest = shape.lowest()
    assert lowest <= heights.min() + 1e-12
    spacing = shape.length / 2000
    assert lowest >= heights.min() - shape.bends.max() * spacing**2 / 8.0 - 1e-12


def test_bend_radius_total_bend_and_energy_of_known_shapes():
    quarter_circle = LinkShape([[5.0, 0.0]], [0.1 * np.pi])
    assert quarter_circle.min_bend_radius == pytest.approx(0.2)
    assert quarter_circle.total_bend == pytest.approx(0.5 * np.pi)
    assert quarter_circle.bending_energy == pytest.approx(25.0 * 0.1 * np.pi)
    np.testing.assert_allclose(quarter_circle.end_frame()[1], [0.2, 0.0, 0.2], atol=1e-15)
    straight = LinkShape([[0.0, 0.0]], [0.6])
    assert straight.min_bend_radius == np.inf
    np.testing.assert_allclose(straight.end_frame()[1], [0.0, 0.0, 0.6])


def test_many_chains_at_once_are_the_same_as_one_by_one():
    rng = np.random.default_rng(0)
    curvatures, lengths = rng.normal(size=(7, 5, 4, 2)), rng.uniform(0.1, 0.2, (7, 5, 4))
    rotations, positions = chain_end(curvatures, lengths)
    rotation, position = chain_end(curvatures[3, 2], lengths[3, 2])
    np.testing.assert_allclose(rotations[3, 2], rotation, atol=1e-15)
    np.testing.assert_allclose(positions[3, 2], position, atol=1e-15)


def test_a_shape_cannot_be_changed():
    shape = LinkShape([[1.0, 2.0]], [0.6])
    with pytest.raises(ValueError, match="read-only"):
        shape.curvatures[0, 0] = 3.0
