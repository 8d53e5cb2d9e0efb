"""Laws of exact synthesis: what was planted is found, what is found passes its targets."""

import math
from dataclasses import astuple

import numpy as np
import pytest
import sympy as sp
from exact_targets import RADIUS, errors, half_ball, random_values, targets_of, through
from hypothesis import assume, given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from planted import planted_arm
from searched_arms import FEW, surface, well_conditioned
from strategies import LONG, arms, end_effector

from synth.geometry import (
    Invariants,
    SweptCircle,
    arms_through_five,
    arms_through_four,
    cognate,
)

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
