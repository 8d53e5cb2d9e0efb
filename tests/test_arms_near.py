"""Arms near all of many targets, from those through a few: exact ones, least squares, and what is refused."""

import numpy as np
import pytest
from exact_targets import RADIUS, random_values, targets_of

from synth.errors import GeometryError
from synth.geometry import Invariants, arms_near


def planted(seed, count):
    rng = np.random.default_rng(seed)
    values = random_values(rng, 1)
    values[:, 4] = RADIUS
    return values, targets_of(values, count, rng)[0]


def rms(values, targets):
    return float(np.sqrt(np.mean(Invariants(*values.tolist()).circle().distance(targets) ** 2)))


@pytest.mark.parametrize("seed", range(10))
def test_the_arm_through_all_is_the_nearest_known_radius_or_not(seed):
    values, targets = planted(seed, 9)
    for radius in (RADIUS, None):
        near = arms_near(targets, radius, sets=10, steps=0)
        assert near.costs[0] < 1e-18
        assert rms(near.values[0], targets) < 1e-9
    assert np.abs(arms_near(targets, RADIUS).values[0] - values[0]).max() < 1e-6


@pytest.mark.parametrize("seed", range(10))
def test_noisy_targets_have_an_arm_at_least_as_near_as_the_planted_one(seed):
    values, targets = planted(seed, 12)
    noisy = targets + np.random.default_rng([seed, 1]).normal(scale=3e-3, size=targets.shape)
    near = arms_near(noisy, RADIUS)
    assert rms(near.values[0], noisy) <= 1.01 * rms(values[0], noisy)
    assert np.sqrt(near.costs[0]) == pytest.approx(rms(near.values[0], noisy), rel=0.05)  # to first order


def test_steps_lead_downhill_and_weights_count():
    _, targets = planted(3, 12)
    noisy = targets + np.random.default_rng(1).normal(scale=5e-3, size=targets.shape)
    assert arms_near(noisy, RADIUS).costs[0] < arms_near(noisy, RADIUS, steps=0).costs[0]
    weights = np.where(np.arange(12) < 4, 0.2499, 0.0004 / 8)
    first = Invariants(*arms_near(noisy, RADIUS, weights=weights).values[0].tolist()).circle()
    assert first.distance(noisy[:4]).max() < 0.2 * first.distance(noisy[4:]).max()


def test_designs_are_distinct_sorted_and_the_same_again():
    _, targets = planted(4, 30)
    noisy = targets + np.random.default_rng(2).normal(scale=0.02, size=targets.shape)
    near, again = arms_near(noisy, RADIUS), arms_near(noisy, RADIUS)
    assert np.array_equal(near.values, again.values)
    assert (np.diff(near.costs) >= 0.0).all()
    apart = np.abs(near.values[:, None] - near.values).max(axis=-1)
    assert (apart[~np.eye(len(apart), dtype=bool)] >= 0.01).all()


def test_targets_that_no_arm_passes_leave_none():
    flat = np.random.default_rng(0).uniform(-0.5, 0.5, (8, 3)) * [1.0, 1.0, 0.0]
    near = arms_near(flat, RADIUS)  # all sets are of one plane: infinitely many arms
    assert near.values.shape == (0, 5)
    assert near.costs.shape == (0,)


@pytest.mark.parametrize(
    ("targets", "radius"), [(np.zeros((3, 3)), 0.4), (np.zeros((4, 3)), None), (np.zeros((6, 2)), 0.4)]
)
def test_too_few_targets_are_refused(targets, radius):
    with pytest.raises(GeometryError):
        arms_near(targets, radius)
