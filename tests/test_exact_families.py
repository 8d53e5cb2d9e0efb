"""Families of exact arms: cognates, spheres and planes, samples of what is left free, refusals."""

import math
from dataclasses import astuple

import numpy as np
import pytest
from exact_targets import RADIUS, half_ball, random_values, targets_of
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from searched_arms import FEW, surface, well_conditioned
from strategies import LONG, arms, end_effector

from synth.errors import GeometryError
from synth.geometry import (
    Invariants,
    arms_through_five,
    arms_through_four,
    circle_through,
    cognate,
    planes_through,
    sample_exact_arms,
    spheres_through,
)


class TestCognates:
    @given(arms(baselines=[LONG]))
    def test_have_the_same_surface_and_are_mutual(self, arm):
        design = Invariants.from_circle(arm.circle)
        other = cognate(design)
        q, q_other = (item.circle().surface(1.0, 2.0).q for item in (design, other))
        if arm.family in {"skew", "mirror", "at P1", "at P2", "meeting"}:
            # Gamma is defined up to its factor sin^2(alpha); there is none for parallel axes.
            assert_allclose(q_other / q_other[0], q / q[0], rtol=0, atol=1e-9)
        # Where the two are one, each root is known to half the digits.
        tolerance = 1e-7 if abs(other.R - design.R) < 1e-3 else 1e-9
        turned = design.alpha > np.pi / 2
        representative = (
            design.a,
            min(design.alpha, np.pi - design.alpha),
            design.z0,
            -design.h if turned else design.h,
            design.R,
        )
        again = astuple(cognate(other))
        assert_allclose(again, representative, rtol=0, atol=tolerance)

    @given(FEW)
    def test_are_the_two_answers_of_five_targets(self, seed):
        rng = np.random.default_rng(seed)
        targets = targets_of(random_values(rng, 1), 5, rng)[0]
        designs = arms_through_five(targets)
        assume(well_conditioned(targets, None, designs))
        one, other = designs.of()
        assert max(abs(np.subtract(astuple(one), astuple(other)))) > 1e-4
        assert_allclose(astuple(cognate(one)), astuple(other), rtol=0, atol=1e-6)
        assert_allclose(surface(one), surface(other), rtol=0, atol=1e-9 * max(abs(surface(one))))

    def test_of_parallel_axes_swap_the_links_and_of_meeting_axes_the_angles(self):
        assert_allclose(astuple(cognate(Invariants(0.3, 0.0, 0.1, 0.0, 0.4))), [0.4, 0.0, 0.1, 0.0, 0.3])
        r, alpha, delta = 0.5, 0.7, 1.2
        meeting = Invariants(0.0, alpha, 0.1, r * math.cos(delta), r * math.sin(delta))
        swapped = [0.0, delta, 0.1, r * math.cos(alpha), r * math.sin(alpha)]
        assert_allclose(astuple(cognate(meeting)), swapped, atol=1e-15)
        assert_allclose(astuple(cognate(Invariants(0.0, 0.0, 0.1, 0.0, 0.4))), [0.4, 0.0, 0.1, 0.0, 0.0])

    @given(st.floats(0.2, 1.4), st.floats(0.1, 3.0))
    def test_are_the_arm_itself_where_its_circle_meets_axis_1(self, alpha, t):
        a, h = -RADIUS * math.cos(t), -RADIUS * math.sin(t) / math.tan(alpha)
        design = Invariants(abs(a), alpha, 0.1, h, RADIUS)
        assert (
            design.circle().distance(
                [0.0, 0.0, 0.1 + h * math.cos(alpha) - RADIUS * math.sin(alpha) * math.sin(t)]
            )
            < 1e-7
        )
        assert_allclose(astuple(cognate(design)), astuple(design), rtol=0, atol=1e-6)


class TestFamilies:
    @settings(max_examples=40)  # the exact distance takes a millisecond for each
    @given(arms(families=["parallel"]), FEW)
    def test_targets_in_a_plane_have_arms_with_parallel_axes(self, arm, seed):
        rng = np.random.default_rng(seed)
        targets = end_effector(arm.circle, *rng.uniform(0, 2 * np.pi, (2, 5)))
        family = planes_through(targets)
        lower, upper = family.a_range(arm.circle.radius)
        assert lower - 1e-9 <= arm.a <= upper + 1e-9
        for radius in (family.smallest_radius, arm.circle.radius, 2.0):
            for share in (0.0, 0.5, 1.0):
                lower, upper = family.a_range(radius)
                design = family.design(radius, lower + share * (upper - lower))
                assert np.max(design.circle().distance(targets)) < 1e-7
        with pytest.raises(GeometryError):
            family.design(0.2 + family.smallest_radius, 0.21 + family.smallest_radius + family.inner)
        with pytest.raises(GeometryError):
            family.a_range(family.smallest_radius - 1e-6)
        assert not arms_through_five(targets).found.any()

    @settings(max_examples=40)
    @given(arms(families=["meeting", "at P1", "at P2"]), FEW, st.booleans())
    def test_targets_on_a_sphere_have_arms_whose_axes_meet(self, arm, seed, known):
        rng = np.random.default_rng(seed)
        targets = end_effector(arm.circle, *rng.uniform(0, 2 * np.pi, (2, 5)))
        assume(np.ptp(targets[:, 2]) > 1e-2)
        family = spheres_through(targets, centre=arm.z0 if known else None)
        r = math.hypot(arm.h, arm.circle.radius)
        assert_allclose([family.z0, family.sphere_radius], [arm.z0, r], rtol=0, atol=1e-10)
        openings = family.openings(arm.circle.radius)
        alpha = min(arm.alpha, math.pi - arm.alpha)
        ranges = [family.alpha_range(opening) for opening in openings]
        # R = r sin(delta) leaves half the digits of delta at pi/2.
        assert any(lower - 1e-7 <= alpha <= upper + 1e-7 for lower, upper in ranges)
        for opening in (*openings, *family.opening_range, np.mean(family.opening_range)):
            lower, upper = family.alpha_range(opening)
            for share in (0.0, 0.5, 1.0):
                design = family.design(opening, lower + share * (upper - lower))
                # The rim of the band is a double root of the distance.
                assert np.max(design.circle().distance(targets)) < 1e-7
        with pytest.raises(GeometryError):
            family.design(family.opening_range[1] + 0.1, 0.5)
        assert not arms_through_four(targets[:4], arm.circle.radius).found.any()

    def test_targets_on_a_circle_have_coincident_axes(self):
        targets = [[0.3, 0.0, 0.2], [0.0, 0.3, 0.2], [0.0, -0.3, 0.2]]
        assert astuple(circle_through(targets)) == pytest.approx((0.0, 0.0, 0.2, 0.0, 0.3))
        assert np.max(circle_through(targets).circle().distance(targets)) < 1e-9
        assert planes_through(targets).smallest_radius == pytest.approx(0.0)
        assert spheres_through(targets) is None  # infinitely many; of a given centre there is one
        assert spheres_through(targets, centre=0.0).sphere_radius == pytest.approx(math.hypot(0.3, 0.2))

    def test_generic_targets_have_no_family(self):
        targets = half_ball(np.random.default_rng(11), 1, 5)[0]
        assert planes_through(targets) is None
        assert spheres_through(targets) is None
        assert circle_through(targets) is None


class TestSamples:
    @pytest.mark.parametrize(
        ("given_count", "radius"), [*((n, None) for n in (1, 2, 3, 4)), *((n, RADIUS) for n in (1, 2, 3))]
    )
    def test_pass_the_targets(self, given_count, radius):
        rng = np.random.default_rng(12)
        planted = random_values(rng, 1)
        planted[:, 4] = RADIUS
        targets = targets_of(planted, given_count, rng)[0]
        sample = sample_exact_arms(targets, 40, reach=1.0, radius=radius, seed=1)
        assert sample.values.shape == (40, 5)
        for design in sample.of():
            assert np.max(design.circle().distance(targets)) < 1e-9
            assert radius in {None, design.R}
        assert np.ptp(sample.values[:, 0]) > 1e-2
        again = sample_exact_arms(targets, 40, reach=1.0, radius=radius, seed=1)
        assert np.array_equal(again.values, sample.values)

    def test_count_targets_on_one_circle_once(self):
        targets = [[0.4, 0.0, 0.3], [0.0, 0.4, 0.3], [0.5, 0.0, 0.1], [0.0, -0.5, 0.1], [0.2, 0.2, 0.5]]
        assert not arms_through_five(targets).found.any()
        sample = sample_exact_arms(targets, 5, reach=1.0)
        assert np.max([design.circle().distance(targets) for design in sample.of()]) < 1e-9

    def test_are_empty_where_there_is_no_design(self):
        # Two points at one height as far apart as no circle of this radius reaches.
        sample = sample_exact_arms([[2.0, 0.0, 0.1], [0.0, 0.0, 0.1]], 3, reach=1.0, radius=0.1)
        assert sample.of() == ()


class TestRefusals:
    @pytest.mark.parametrize("wrong", [np.zeros((4, 3)), np.zeros((5, 2)), np.full((5, 3), np.nan)])
    def test_wrong_targets(self, wrong):
        with pytest.raises(GeometryError):
            arms_through_five(wrong)

    @pytest.mark.parametrize("radius", [0.0, -1.0, np.nan])
    def test_wrong_radii(self, radius):
        with pytest.raises(GeometryError):
            arms_through_four(np.eye(4, 3), radius)

    @pytest.mark.parametrize("function", [planes_through, spheres_through, circle_through])
    @pytest.mark.parametrize("wrong", [np.zeros((0, 3)), np.zeros(3), np.full((2, 3), np.inf)])
    def test_wrong_targets_of_families(self, function, wrong):
        with pytest.raises(GeometryError):
            function(wrong)

    def test_samples_of_too_many_or_no_targets(self):
        for targets, radius in ((np.zeros((0, 3)), None), (np.eye(5, 3) + np.arange(5)[:, None], None)):
            with pytest.raises(GeometryError):
                sample_exact_arms(targets, 1, reach=1.0, radius=radius)

    def test_many_sets_need_an_index(self):
        designs = arms_through_five(half_ball(np.random.default_rng(13), 2, 5))
        with pytest.raises(GeometryError):
            designs.of()
        with pytest.raises(ValueError, match="read-only"):
            designs.values[0] = 0.0

    @pytest.mark.parametrize(
        "targets", [np.zeros((5, 3)), np.ones((5, 3)), np.outer(np.arange(5), [0, 0, 1])]
    )
    def test_sets_without_extent_have_no_answer(self, targets):
        assert arms_through_five(targets).of() == ()
        assert arms_through_four(targets[:4], RADIUS).of() == ()

    def test_a_target_out_of_reach_of_any_circle_has_no_answer(self):
        # The conic through these is a hyperbola: the middle one lies on the wrong side.
        rho = np.array([0.5, 0.5, 0.5, 0.5, 0.1])
        z = np.array([-0.3, -0.1, 0.1, 0.3, 0.0])
        assert arms_through_five(np.stack([rho, 0 * rho, z], axis=-1)).of() == ()
