"""Laws of squared distances, Cayley-Menger determinants and realisation."""

from itertools import permutations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from strategies import angles, arms, end_effector, points

from synth.errors import GeometryError
from synth.geometry import (
    cayley_menger,
    cayley_menger_bideterminant,
    realise,
    squared_distances,
)

# Points lie within a metre, so that determinants are of order 1; a 6x6 LU decomposition of entries
# of order 1 keeps about 14 digits of that.
ROUNDING = 1e-13


def some_points(count, dimension=3, seed=0):
    return np.random.default_rng(seed).uniform(-0.5, 0.5, (count, dimension))


@given(points(5))
def test_five_points_in_space_have_no_volume(p):
    assert abs(cayley_menger(squared_distances(p))) < ROUNDING


def test_five_points_beyond_space_have_one():
    assert cayley_menger(squared_distances(some_points(5, 4))) > 1e-4


@pytest.mark.parametrize("count", [2, 3, 4, 5])
def test_determinant_is_the_gram_determinant(count):
    p = some_points(count, 4)
    edges = p[1:] - p[0]
    assert_allclose(
        cayley_menger(squared_distances(p)), np.linalg.det(edges @ edges.T), rtol=0, atol=ROUNDING
    )


@pytest.mark.parametrize("count", [3, 4, 5])
def test_determinant_does_not_depend_on_the_order(count):
    s = squared_distances(some_points(count, 4))
    values = [cayley_menger(s[np.ix_(order, order)]) for order in permutations(range(count))]
    assert_allclose(values, values[0], rtol=0, atol=ROUNDING)


@pytest.mark.parametrize("count", [2, 3, 4, 5])
def test_determinant_scales_as_a_squared_volume(count):
    s = squared_distances(some_points(count, 4))
    assert_allclose(cayley_menger(4.0 * s), 2.0 ** (2 * count - 2) * cayley_menger(s), rtol=1e-9)


@given(points(4), angles(), angles())
def test_distances_do_not_see_rigid_motions(p, turn, tilt):
    c, s = np.cos([turn, tilt]), np.sin([turn, tilt])
    rotation = np.array([[c[0], -s[0], 0], [s[0], c[0], 0], [0, 0, 1]])
    rotation = rotation @ np.array([[1, 0, 0], [0, c[1], -s[1]], [0, s[1], c[1]]])
    assert_allclose(squared_distances(p @ rotation.T + [1, 2, 3]), squared_distances(p), rtol=0, atol=1e-14)


def test_leading_axes_are_batches():
    p = some_points(4 * 6).reshape(2, 3, 4, 3)
    s = squared_distances(p)
    assert s.shape == (2, 3, 4, 4)
    assert cayley_menger(s).shape == (2, 3)
    assert cayley_menger(s)[1, 2] == pytest.approx(cayley_menger(squared_distances(p[1, 2])))


def test_bideterminant_is_the_determinant_of_inner_products():
    p = some_points(8, 4)
    rows, columns = [0, 5, 2, 3], [7, 1, 3, 6]
    products = (p[rows[1:]] - p[rows[0]]) @ (p[columns[1:]] - p[columns[0]]).T
    value = cayley_menger_bideterminant(squared_distances(p), rows, columns)
    assert_allclose(value, np.linalg.det(products), rtol=0, atol=ROUNDING)


def test_the_paper_s_compact_form_is_minus_sixteen_times_the_determinant():
    s = squared_distances(some_points(5, 4))  # in four dimensions, where it is not simply 0 = 0
    s12, s13, s14, s15 = s[0, 1:]
    s23, s24, s25, s34, s35, s45 = s[1, 2], s[1, 3], s[1, 4], s[2, 3], s[2, 4], s[3, 4]
    a = np.array([[0, 1, 1], [1, 0, s34], [1, s34, 0]])
    b = np.array([[1, 1, 1], [s24, s14, s45], [s23, s13, s35]])
    c = 0.5 * np.array([
        [-s15 / (s12 * s25), 1 / s12, 1 / s25],
        [1 / s12, -s25 / (s12 * s15), 1 / s15],
        [1 / s25, 1 / s15, -s12 / (s15 * s25)],
    ])  # fmt: skip
    compact = 2 * s12 * s15 * s25 * np.linalg.det(a - b @ c @ b.T)
    assert_allclose(compact, -16 * cayley_menger(s), rtol=1e-10)


@given(points(5))
def test_points_keep_their_distances(p):
    s = squared_distances(p)
    assert_allclose(squared_distances(realise(s)), s, rtol=0, atol=1e-14)


@given(arms(), angles(), angles())
def test_arms_keep_their_distances_in_every_family(arm, theta1, theta2):
    p = np.vstack([arm.axis_points, end_effector(arm.circle, theta1, theta2)])
    s = squared_distances(p)
    assert_allclose(squared_distances(realise(s)), s, rtol=0, atol=1e-14)


@given(st.floats(0.058, 0.5), st.floats(0.1, 0.7), st.floats(-0.5, 0.5), points(2), st.sampled_from([1, -1]))
def test_points_in_the_base_frame_are_found_again(d12, x3, z3, rest, chirality):
    # Off axis and plane by at least 0.1 m; over a baseline of 58 mm distances of up to 1 m lose
    # (1 / 0.058)^2 = 300 times the rounding of 1e-16.
    rest[0, 1] = chirality * (abs(rest[0, 1]) + 0.1)
    p = np.vstack([[0, 0, 0], [0, 0, d12], [x3, 0, z3], rest])
    assert_allclose(realise(squared_distances(p), chirality=chirality), p, rtol=0, atol=1e-11)


@given(points(6))
def test_realised_points_stand_in_the_base_frame(p):
    s = squared_distances(p)
    left, right = realise(s, chirality=-1), realise(s)
    assert_allclose(left, right * [1, -1, 1], rtol=0, atol=0)
    assert not np.any(right[0])
    for inner, positive in (([], 2), ([2], 0), ([0, 2], 1)):
        outer = np.delete(right, inner, axis=1)
        for first in right[np.any(np.abs(outer) > 1e-6, axis=1)][:1]:
            assert first[positive] > 0
            assert_allclose(np.delete(first, [*inner, positive]), 0, rtol=0, atol=1e-9)


@pytest.mark.parametrize(
    "p",
    [
        [[0, 0, 0]],
        [[0, 0, 0], [0, 0, 0.058]],
        [[0, 0, 0], [0, 0, 0], [0, 0, 0]],
        [[0, 0, 0], [0, 0, 0.058], [0, 0, 0.3], [0, 0, -0.4]],
        [[0, 0, 0], [0, 0, 0.058], [0, 0, 0.3], [0.4, 0, 0.3]],
        [[0, 0, 0], [0, 0, 0.058], [0, 0, 0.3], [0.4, 0, 0.3], [0.1, 0.5, 0]],
        [[0, 0, 0], [0, 0, 0], [0, 0, 0.3], [0.4, 0, 0.3], [0.1, 0.5, 0]],
        [[0, 0, 0], [0, 0, 0.058], [0.2, 0, 0.3], [-0.4, 0, 0.3]],
    ],
    ids=["one", "two", "all the same", "in line", "P3 on axis 1", "the same, in space", "P1 = P2", "planar"],
)
def test_degenerate_points_are_found_again(p):
    assert_allclose(realise(squared_distances(p)), p, rtol=0, atol=1e-14)


@pytest.mark.parametrize("n", [3, 4, 5])
def test_the_reason_names_what_fits_nothing(n):
    # A regular simplex of edge 1 exists up to four points. One edge is then drawn out.
    s = 1.0 - np.eye(n)
    edge, reason = {
        3: (2.1, r"d12 = 2\.1 m is longer than d13 \+ d23 = 2 m"),
        4: (1.8, r"D\(1,2,3,4\) = -.* is negative"),
        5: (1.0, r"fourth dimension: D\(1,2,3,4,5\) = .* is not 0"),
    }[n]
    s[0, 1] = s[1, 0] = edge**2
    with pytest.raises(GeometryError, match=reason):
        realise(s)


@pytest.mark.parametrize(
    "s", [[[0, 1], [2, 0]], [[1, 1], [1, 0]], [[0, -1], [-1, 0]], [[0, np.nan], [np.nan, 0]], [[0, 1, 2]]]
)
def test_what_is_no_matrix_of_squared_distances_is_refused(s):
    with pytest.raises(GeometryError, match="Squared distances must be"):
        realise(s)


def test_a_tolerance_finds_nearby_points():
    s = squared_distances([[0, 0, 0], [0, 0, 1], [1, 0, 0], [1, 0, 1]])
    s[0, 3] = s[3, 0] = 2.001  # one diagonal of the square too long
    with pytest.raises(GeometryError):
        realise(s)
    assert_allclose(squared_distances(realise(s, tolerance=1e-3)), s, rtol=0, atol=2e-3)
