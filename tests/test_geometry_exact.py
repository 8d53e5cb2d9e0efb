"""Laws of exact synthesis: what was planted is found, what is found passes its targets."""

import math
from dataclasses import astuple

import numpy as np
import pytest
import sympy as sp
from exact_targets import RADIUS, errors, half_ball, random_values, targets_of, through
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from planted import planted_arm
from strategies import LONG, arms, end_effector

from synth.errors import GeometryError
from synth.geometry import (
    Invariants,
    SweptCircle,
    arms_through_five,
    arms_through_four,
    circle_through,
    cognate,
    planes_through,
    sample_exact_arms,
    spheres_through,
)

FEW = st.integers(0, 2**32 - 1)


def surface(invariants):
    q = invariants.circle().surface(1.0, 2.0).q
    return q / q[0]


KINDS = pytest.mark.parametrize(("count", "radius"), [(5, None), (4, RADIUS)])


class TestPlantedDesigns:
    @KINDS
    def test_are_found(self, count, radius):
        rng = np.random.default_rng(1)
        planted = random_values(rng, 2000)
        planted[:, 4] = radius or planted[:, 4]
        found = errors(through(targets_of(planted, count, rng), radius), planted)
        # Near circles that meet axis 1, targets rounded to 1e-16 m hold no better answer.
        assert np.mean(found < 1e-9) >= 0.999
        assert np.max(found) < 1e-6

    @KINDS
    def test_of_the_prototype_are_found(self, count, radius):
        rng = np.random.default_rng(2)
        robots = [planted_arm(rng) for _ in range(200)]
        planted = np.array([astuple(robot.invariants) for robot in robots])
        found = errors(
            through(targets_of(planted, count, rng), radius and planted[:, 4]),
            planted,
        )
        assert np.mean(found < 1e-9) >= 0.99
        assert np.max(found) < 1e-6

    @KINDS
    @pytest.mark.parametrize(("place", "value"), [(0, 1e-3), (1, 1e-2), (1, np.pi / 2), (3, 1e-3)])
    def test_close_to_a_special_kind_are_found_as_well_as_targets_hold_them(
        self, count, radius, place, value
    ):
        rng = np.random.default_rng(3)
        planted = random_values(rng, 1000)
        planted[:, place] = value
        planted[:, 4] = radius or planted[:, 4]
        found = errors(through(targets_of(planted, count, rng), radius), planted)
        assert np.median(found) < 1e-11
        assert np.mean(found < 1e-6) >= 0.995

    @given(arms(families=["skew"]), FEW)
    def test_are_the_arms_whose_forward_kinematics_gave_the_targets(self, arm, seed):
        theta = np.random.default_rng(seed).uniform(0, 2 * np.pi, (2, 5))
        assume(np.min(np.abs(np.sin((theta[1][:, None] - theta[1])[np.triu_indices(5, 1)] / 2))) > 0.1)
        planted = Invariants.from_circle(arm.circle)
        # The circle meets axis 1 where the cognates do: see the docstring of `cognate`.
        assume(abs(cognate(planted).R - planted.R) > 0.02)
        answers = arms_through_five(end_effector(arm.circle, *theta)).of()
        apart = [abs(surface(answer) - surface(planted)).max() for answer in answers]
        assert len(answers) == 2
        assert max(apart) < 1e-7
        assert min(abs(answer.a - planted.a) for answer in answers) < 1e-7

    def test_come_from_their_distances_and_give_them_back(self):
        rng = np.random.default_rng(4)
        planted = random_values(rng, 20)
        targets = targets_of(planted, 5, rng)
        designs = arms_through_five(targets)
        for index in range(20):
            for design in designs.of(index):
                for chirality in (1, -1):
                    distances = design.circle(chirality).squared_distances(**LONG)
                    again = Invariants.from_squared_distances(distances)
                    assert_allclose(astuple(again), astuple(design), rtol=0, atol=1e-9)
                    circle = SweptCircle.from_squared_distances(distances, chirality=chirality)
                    assert np.max(circle.distance(targets[index])) < 1e-9


class TestAnswers:
    @KINDS
    def test_pass_their_targets_by_the_exact_distance(self, count, radius):
        targets = half_ball(np.random.default_rng(5), 150, count)
        designs = through(targets, radius)
        assert np.any(designs.found)
        assert np.nanmax(designs.misses) < 1e-12
        for index in np.flatnonzero(designs.found.any(axis=-1)):
            for design in designs.of(index):
                assert np.max(design.circle().distance(targets[index])) < 1e-9

    @KINDS
    def test_come_in_pairs_and_in_one_representative(self, count, radius):
        designs = through(half_ball(np.random.default_rng(6), 3000, count), radius)
        assert set(np.unique(designs.found.sum(axis=-1))) <= ({0, 2} if radius is None else {0, 2, 4, 6})
        values = designs.values[designs.found]
        assert np.all(values[:, [0, 4]] > 0.0)
        assert np.all((values[:, 1] > 0.0) & (values[:, 1] <= np.pi / 2))
        assert np.all(np.diff(designs.values[..., 0], axis=-1)[designs.found[..., 1:]] > 0.0)
        if radius is not None:
            assert np.all(values[:, 4] == radius)

    @pytest.mark.parametrize(("count", "radius", "share"), [(5, None, 0.13), (4, RADIUS, 0.38)])
    def test_of_random_targets_are_as_rare_as_measured(self, count, radius, share):
        sets = 3000
        found = through(half_ball(np.random.default_rng(7), sets, count), radius).found.any(axis=-1)
        assert abs(found.mean() - share) < 0.01 + 4 * math.sqrt(share / sets)

    def test_of_four_targets_are_all_that_a_search_finds(self):
        # Newton's method from all over the place, with a Jacobian by differences: it shares no formula.
        rng = np.random.default_rng(8)
        targets = half_ball(rng, 12, 4, reach=0.8)
        for index, designs in enumerate(arms_through_four(targets, RADIUS).values):
            known = designs[~np.isnan(designs[:, 0])]
            for values in searched(targets[index], rng):
                assert np.min(np.max(np.abs(known - values), axis=-1)) < 1e-5


def test_a_pencil_of_conics_has_six_arms_of_a_radius():
    # The equation that `Conics.radius_defect` clears of its denominators, on a pencil of integers.
    s, half = sp.Symbol("s"), sp.Rational(1, 2)
    q0, q1, q2, q3, q4, q5 = (
        n + s * k for n, k in zip([2, 3, -1, 5, 1, -4], [7, -2, 3, 1, -6, 2], strict=True)
    )
    z0, e = -half * q1 / q0, q3 / q0
    big_a = q2 / q0 / 4 - (q1 / q0) ** 2 / 4
    centre = -(q4 / q0 + 2 * z0 * e) / (4 * big_a)
    p, k, m = (e**2 + 4 * big_a * centre**2 - q5 / q0) / 4, z0**2 - e, centre - z0
    r2 = sp.Rational(1, 4)
    equation = p**2 - (big_a + k) * p * r2 + (p + k * big_a - big_a * m**2) * r2**2 - big_a * r2**3
    numerator = sp.fraction(sp.together(equation))[0]
    factors = {sp.degree(f, s): (f, power) for f, power in sp.factor_list(numerator)[1]}
    assert sorted((degree, power) for degree, (_, power) in factors.items()) == [(1, 2), (6, 1)]
    assert sp.simplify(factors[1][0] / q0).is_number


def searched(targets, rng, starts=600):
    """Return designs (a, alpha, z0, h, RADIUS) that a search over Gamma / q0 ends at."""
    n, z = np.sum(targets**2, axis=-1), targets[:, 2]

    def gamma(p):
        a, alpha, z0, h = np.moveaxis(p[:, None], -1, 0)
        k = a**2 + h**2 + RADIUS**2
        centred = np.sin(alpha) * (n - 2 * z0 * z + z0**2 - k)
        return centred**2 + 4 * a**2 * ((z - z0 - h * np.cos(alpha)) ** 2 - (RADIUS * np.sin(alpha)) ** 2)

    p = rng.uniform([0.02, 0.05, -1, -1], [1, np.pi / 2, 1, 1], (starts, 4))
    for _ in range(40):
        steps = 1e-6 * np.eye(4)
        jacobian = np.stack([(gamma(p + e) - gamma(p - e)) / 2e-6 for e in steps], axis=-1)
        change = np.linalg.solve(jacobian + 1e-14 * np.eye(4), gamma(p)[..., None])[..., 0]
        p -= change * np.minimum(1, 0.3 / np.max(np.abs(change), axis=-1, keepdims=True))
    a, alpha, z0, h = p.T
    h, alpha = np.where(np.cos(alpha) < 0, -h, h), np.arcsin(np.abs(np.sin(alpha)))
    sound = (np.max(np.abs(gamma(p)), axis=-1) < 1e-13) & (np.abs(a) > 0.01) & (alpha > 0.03)
    ends = np.stack([np.abs(a), alpha, z0, h, np.full_like(a, RADIUS)], axis=-1)
    return ends[sound]


class TestLaws:
    @KINDS
    @given(seed=FEW)
    def test_order_and_turns_of_the_targets_do_not_matter(self, count, radius, seed):
        targets, designs, rng = self.planted(count, radius, seed)
        angle = rng.uniform(0, 2 * np.pi, count)
        c, s, (x, y, z) = np.cos(angle), np.sin(angle), targets.T
        turned = np.stack([c * x - s * y, s * x + c * y, z], axis=-1)
        for others in (targets[rng.permutation(count)], turned, targets * [1, -1, 1]):
            self.assert_same(through(others, radius), designs.values)

    @KINDS
    @given(seed=FEW, factor=st.floats(0.1, 10), shift=st.floats(-2, 2))
    def test_scale_height_and_reflection_in_z_act_on_the_designs(self, count, radius, seed, factor, shift):
        targets, designs, _ = self.planted(count, radius, seed)
        scaled = designs.values * [factor, 1, factor, factor, factor]
        self.assert_same(through(factor * targets, radius and factor * radius), scaled)
        self.assert_same(through(targets + [0, 0, shift], radius), designs.values + [0, 0, shift, 0, 0])
        self.assert_same(through(targets * [1, 1, -1], radius), designs.values * [1, 1, -1, -1, 1])

    @staticmethod
    def planted(count, radius, seed):
        rng = np.random.default_rng(seed)
        values = random_values(rng, 1)
        values[:, 4] = radius or values[:, 4]
        targets = targets_of(values, count, rng)[0]
        designs = through(targets, radius)
        assume(well_conditioned(targets, radius, designs))
        return targets, designs, rng

    @staticmethod
    def assert_same(designs, values):
        assert_allclose(designs.values, values, rtol=1e-6, atol=1e-6)

    @KINDS
    def test_sets_are_answered_alike_alone_and_together(self, count, radius):
        targets = half_ball(np.random.default_rng(9), 60, count).reshape(3, 20, count, 3)
        together = through(targets, radius)
        assert together.misses.shape == (3, 20, 2 if radius is None else 6)
        for index in np.ndindex(3, 20):
            alone = through(targets[index], radius)
            assert_allclose(alone.values, together.values[index], rtol=1e-9)
            assert len(alone.of()) == len(together.of(*index)) == np.sum(alone.found)

    def test_each_set_may_have_its_own_radius(self):
        rng = np.random.default_rng(10)
        planted = random_values(rng, 50)
        assert (
            np.median(errors(arms_through_four(targets_of(planted, 4, rng), planted[:, 4]), planted)) < 1e-12
        )


def well_conditioned(targets, radius, designs):
    """Whether the designs move by no more than 1e5 times what the targets are moved by."""
    nudged = through(targets + 1e-12 * np.sin(np.arange(targets.size)).reshape(targets.shape), radius)
    change = np.abs(nudged.values - designs.values)
    return np.array_equal(nudged.found, designs.found) and np.nanmax(change) < 1e-7


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
