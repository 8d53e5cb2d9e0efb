"""Laws of the five invariants, of axis 2 with its circle, and of the ways between them."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from strategies import HARDWARE, LONG, angles, arms, end_effector, make_arm

from synth.errors import GeometryError
from synth.geometry import ArmDistances, Invariants, SweptCircle, realise, squared_distances

# Distances of half a metre are rounded at 1e-16; over the hardware's baselines of 50 mm an axis half
# a metre off turns that into 1e-16 * 0.5^2 / 0.05^2 = 1e-14 rad, and into some 1e-13 m after division by
# the sine of the angle between the axes (17 deg at least).
FROM_DISTANCES = 1e-11
FROM_POINTS = 1e-14


def numbers(invariants):
    return np.array([invariants.a, invariants.alpha, invariants.z0, invariants.h, invariants.R])


def expected(arm):
    """The numbers the arm was made from; parallel axes have their common normal at the centre."""
    if math.sin(arm.alpha) < 1e-9:
        return np.array([arm.a, arm.alpha, arm.circle.centre[2], 0.0, arm.circle.radius])
    return np.array([arm.a, arm.alpha, arm.z0, arm.h, arm.circle.radius])


class TestInvariants:
    @given(arms())
    def test_are_the_numbers_that_the_arm_was_made_from(self, arm):
        assert_allclose(numbers(Invariants.from_circle(arm.circle)), expected(arm), rtol=0, atol=FROM_POINTS)

    @given(arms())
    def test_follow_from_distances(self, arm):
        found = Invariants.from_squared_distances(arm.distances)
        # Axes that meet have D(1,2,3,4) = 0, and a is the root of its rounding: see the docstring.
        height = 1e-6 if arm.family in {"at P1", "at P2", "meeting"} else FROM_DISTANCES
        assert_allclose(numbers(found)[0], arm.a, rtol=0, atol=height)
        assert_allclose(numbers(found)[1:], expected(arm)[1:], rtol=0, atol=FROM_DISTANCES)

    @given(arms(), st.floats(-1.0, 1.0), st.floats(0.05, 1.0), st.floats(0.05, 1.0))
    def test_do_not_change_when_axis_points_slide(self, arm, offset, d34, d12):
        assume(arm.family not in {"at P1", "at P2", "meeting"})  # as above
        slid = arm.circle.squared_distances(d12, d34, offset)
        assert_allclose(
            numbers(Invariants.from_squared_distances(slid)), expected(arm), rtol=0, atol=10 * FROM_DISTANCES
        )

    @given(arms(), st.sampled_from([1, -1]))
    def test_round_trip_through_the_circle(self, arm, chirality):
        invariants = Invariants.from_circle(arm.circle)
        circle = invariants.circle(chirality)
        assert circle.centre[0] >= 0
        assert circle.centre[1] == 0
        assert_allclose(circle.moment, chirality * arm.a * math.sin(arm.alpha), rtol=0, atol=FROM_POINTS)
        assert_allclose(numbers(Invariants.from_circle(circle)), numbers(invariants), rtol=0, atol=1e-13)

    @given(arms())
    def test_mirror_images_have_the_same_surface(self, arm):
        invariants = Invariants.from_circle(arm.circle)
        q = arm.circle.surface(arm.d12, arm.d34).q
        for chirality in (1, -1):
            assert_allclose(invariants.circle(chirality).surface(arm.d12, arm.d34).q, q, rtol=0, atol=1e-14)

    @given(arms(families=["skew"]))
    def test_turning_axis_2_round_leaves_the_surface_alone(self, arm):
        turned = SweptCircle(arm.circle.centre, -arm.circle.axis, arm.circle.radius)
        a, alpha, z0, h, radius = numbers(Invariants.from_circle(arm.circle))
        assert_allclose(
            numbers(Invariants.from_circle(turned)), [a, math.pi - alpha, z0, -h, radius], rtol=0, atol=1e-14
        )
        assert_allclose(turned.surface(1.0, 2.0).q, arm.circle.surface(1.0, 2.0).q, rtol=0, atol=1e-14)

    @pytest.mark.parametrize("tilt", [1e-3, 1e-5, 1e-7, 1e-9, 1e-11])
    def test_nearly_parallel_axes_keep_their_circle(self, tilt):
        # The common normal runs off to 0.5 m / tilt; the circle must be found again all the same.
        circle = SweptCircle(np.array([0.4, 0.0, 0.3]), np.array([0.6 * tilt, 0.8 * tilt, 1.0]), 0.45)
        again = Invariants.from_circle(circle).circle()
        assert_allclose(again.centre, circle.centre, rtol=0, atol=2e-8)
        assert_allclose(again.axis, circle.axis, rtol=0, atol=2e-8)

    @pytest.mark.parametrize(
        "wrong",
        [{"a": -1.0}, {"alpha": -0.1}, {"alpha": 3.2}, {"R": -1.0}, {"z0": math.nan}, {"h": math.inf}],
    )
    def test_impossible_ones_are_refused(self, wrong):
        with pytest.raises(GeometryError):
            Invariants(**{"a": 0.1, "alpha": 1.0, "z0": 0.0, "h": 0.0, "R": 0.4, **wrong})


class TestSweptCircle:
    @given(arms(), angles())
    def test_round_trip_through_points(self, arm, theta2):
        p = np.vstack([arm.axis_points, end_effector(arm.circle, 0.0, theta2)])
        circle = SweptCircle.from_points(p)
        # The centre is read off a line through two points 49 mm apart, up to 0.2 m away.
        assert_allclose(circle.centre, arm.circle.centre, rtol=0, atol=1e-13)
        assert_allclose(circle.axis, arm.circle.axis, rtol=0, atol=1e-13)
        assert_allclose(circle.radius, arm.circle.radius, rtol=0, atol=1e-13)

    @given(arms(), angles())
    def test_distances_are_those_of_the_points(self, arm, theta2):
        p = np.vstack([arm.axis_points, end_effector(arm.circle, 0.0, theta2)])
        s = squared_distances(p)
        assert_allclose(arm.distances.matrix(s[0, 4], s[1, 4]), s, rtol=0, atol=1e-14)
        assert_allclose(arm.distances.axis_matrix, s[:4, :4], rtol=0, atol=1e-14)

    @given(arms(), st.sampled_from([1, -1]))
    def test_round_trip_through_distances(self, arm, chirality):
        circle = SweptCircle.from_squared_distances(arm.distances, chirality=chirality)
        again = circle.squared_distances(arm.d12, arm.d34, arm.offset)
        assert_allclose(again, arm.distances, rtol=0, atol=1e-13)
        if arm.family in {"skew", "mirror"}:
            assert math.copysign(1, circle.moment) == chirality
        p3, p4 = realise(arm.distances.axis_matrix, chirality=chirality)[2:]
        assert_allclose(circle.axis_points(arm.d34, arm.offset), [p3, p4], rtol=0, atol=1e-12)

    @pytest.mark.parametrize("baselines", [HARDWARE, LONG])
    def test_points_are_the_circle(self, baselines):
        circle = make_arm("skew", baselines=baselines).circle
        from_centre = circle.points(np.linspace(0, 6, 7).reshape(7, 1)) - circle.centre
        assert from_centre.shape == (7, 1, 3)
        assert_allclose(np.linalg.norm(from_centre, axis=-1), circle.radius)
        assert_allclose(from_centre @ circle.axis, 0, rtol=0, atol=1e-15)

    def test_values_cannot_be_changed(self):
        circle = make_arm("skew").circle
        with pytest.raises(ValueError, match="read-only"):
            circle.centre[0] = 1.0

    def test_distances_that_fit_nothing_are_refused(self):
        good = make_arm("skew").distances
        for wrong in ({"s12": 0.0}, {"s34": 0.0}, {"s45": 4.0}, {"s14": 4.0}, {"s14": good.s14 + 1e-2}):
            with pytest.raises(GeometryError):
                SweptCircle.from_squared_distances(ArmDistances(**{**good._asdict(), **wrong}))

    @pytest.mark.parametrize(("axis", "radius"), [([0, 0, 0], 1.0), ([0, 0, 1], -1.0), ([0, 0, 1], math.nan)])
    def test_impossible_ones_are_refused(self, axis, radius):
        with pytest.raises(GeometryError):
            SweptCircle(np.zeros(3), np.array(axis), radius)
