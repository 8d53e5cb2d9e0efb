"""Nearest realisable distances, misprints, samples, the link: laws, on planted and on published data."""

from pathlib import Path

import numpy as np
import pytest
from planted_distances import HARDWARE, MILLIMETRE, as_measured, named, planted_points, rounded

from synth.errors import GeometryError
from synth.measurement import Fit, find_misprint, inspect, nearest_realisable
from synth.measurement.distances.measured import MeasuredDistances, Precision
from synth.measurement.distances.reading import load_measurements
from synth.measurement.distances.relaxation import consistent_interval

ROOT = Path(__file__).parents[1]
MEASURED = ("d13", "d14", "d15", "d23", "d24", "d25")


@pytest.fixture(scope="module")
def published():
    return {one.name: one for one in load_measurements(ROOT / "problems" / "clark2020.yaml")}


@pytest.mark.parametrize("count", [4, 5])
@pytest.mark.parametrize("seed", range(4))
def test_exact_distances_stay_as_they_are(seed, count):
    nearest = nearest_realisable(as_measured(named(planted_points(seed)[:count])))
    assert nearest.fit is Fit.AS_GIVEN
    assert np.abs(nearest.residuals).max() < 1e-8
    assert np.allclose(list(named(nearest.points).values()), nearest.distances, rtol=0, atol=1e-12)


@pytest.mark.parametrize("seed", range(6))
def test_rounded_distances_of_planted_points_are_realisable_and_no_farther_than_the_planted_ones(seed):
    truth = named(planted_points(seed))
    measured = as_measured(rounded(truth))
    nearest = nearest_realisable(measured)
    assert nearest.is_realisable
    assert nearest.within.all()
    planted = np.array([truth[name] for name in measured.names]) - measured.values
    assert np.linalg.norm(nearest.residuals) <= np.linalg.norm(planted) + 1e-9


@pytest.mark.parametrize("seed", range(3))
def test_noisy_distances_come_back_realisable_within_a_few_sigma(seed):
    truth, rng = named(planted_points(seed)), np.random.default_rng(seed)
    noisy = {name: d if name in HARDWARE else d + rng.normal(0.0, 5e-4) for name, d in truth.items()}
    nearest = nearest_realisable(as_measured(noisy, Precision.from_sigma(5e-4)))
    assert nearest.is_realisable
    assert np.abs(nearest.residuals).max() < 3 * 5e-4
    assert np.abs(nearest.residuals[nearest.measured.is_known]).max() < 1e-8


def test_only_the_ratio_of_the_weights_matters():
    # A flat triangle that is too long by 3 mm: the change goes where the numbers are worth least.
    pairs, values = [[0, 1], [0, 2], [1, 2]], [0.2, 0.503, 0.3]
    changes = []
    for sigma in ([1e-3, 1e-3, 1e-3], [5e-4, 5e-4, 5e-4], [1e-5, 1e-5, 1e-3]):
        nearest = nearest_realisable(MeasuredDistances(pairs, values, sigma, 0.0, np.inf))
        changes.append(nearest.residuals)
    assert np.allclose(changes[0], [1e-3, -1e-3, 1e-3], rtol=0, atol=1e-7)
    assert np.allclose(changes[1], changes[0], rtol=0, atol=1e-7)
    assert np.allclose(changes[2], [0, 0, 3e-3], rtol=0, atol=2e-6)


def test_bounds_are_kept_where_they_can_be_and_a_no_is_said_where_not():
    pairs, values, sigma = [[0, 1], [0, 2], [1, 2]], np.array([0.2, 0.503, 0.3]), 1e-3
    bound = np.array([2e-3, 2e-4, 2e-3])
    nearest = nearest_realisable(MeasuredDistances(pairs, values, sigma, values - bound, values + bound))
    assert nearest.fit is Fit.WITHIN_BOUNDS
    assert np.allclose(nearest.residuals, [1.4e-3, -2e-4, 1.4e-3], rtol=0, atol=1e-6)
    tight = nearest_realisable(MeasuredDistances(pairs, values, sigma, values - 5e-4, values + 5e-4))
    assert tight.fit is Fit.IMPOSSIBLE
    assert not tight.is_realisable
    assert np.allclose(tight.residuals, [1e-3, -1e-3, 1e-3], rtol=0, atol=1e-6)
    assert np.allclose(tight.beyond, 5e-4, rtol=0, atol=1e-6)


def test_five_points_that_need_a_fourth_dimension_are_brought_back_to_space():
    simplex = MeasuredDistances([[i, j] for i in range(5) for j in range(i)], 0.5, 1e-3, 0.499, 0.501)
    nearest = nearest_realisable(simplex)
    assert nearest.fit is Fit.NOT_FOUND
    assert nearest.points.shape == (5, 3)
    assert np.abs(nearest.residuals).max() > 1e-2


def test_pairs_may_be_missing_but_no_point_may_be_without_one():
    distances = named(planted_points(0))
    del distances["d14"]
    assert nearest_realisable(as_measured(distances)).is_realisable
    with pytest.raises(GeometryError, match="Every point"):
        nearest_realisable(MeasuredDistances([[0, 2]], 0.3, 1e-3, 0.2, 0.4))


def test_the_consistent_interval_holds_the_true_distance():
    for seed in range(3):
        truth = named(planted_points(seed))
        lower, upper = consistent_interval(as_measured(rounded(truth)), "d25")
        assert lower - 1e-6 <= truth["d25"] <= upper + 1e-6


def test_a_decimal_point_moved_is_found_and_a_clean_set_raises_no_alarm():
    rng, right, readings, total = np.random.default_rng(0), 0, 0, 40
    for seed in range(total):
        truth = rounded(named(planted_points(seed)))
        assert find_misprint(as_measured(truth)) is None
        name, factor = rng.choice(MEASURED), rng.choice([0.1, 10.0])
        misprint = find_misprint(as_measured({**truth, name: factor * truth[name]}))
        assert misprint is not None
        assert name in {suspect.name for suspect in misprint.suspects}
        if misprint.named is not None:
            right += misprint.named.name == name
            readings += misprint.named.reading == pytest.approx(truth[name], abs=1e-9)
    assert right >= 0.9 * total
    assert readings == right


def test_two_wrong_numbers_are_not_blamed_on_one():
    truth = rounded(named(planted_points(1)))
    misprint = find_misprint(as_measured({**truth, "d13": 10 * truth["d13"], "d25": 10 * truth["d25"]}))
    assert misprint.suspects == ()
    assert misprint.named is None


def test_of_the_published_numbers_only_d25_of_b_is_a_misprint(published):
    misprints = {name: find_misprint(one.distances) for name, one in published.items()}
    assert {name for name, misprint in misprints.items() if misprint} == {"b"}
    found = misprints["b"].named
    assert (found.name, found.value) == ("d25", pytest.approx(3.647))
    assert found.lower < 0.3647 < found.upper
    assert found.reading == pytest.approx(0.3647)


def test_the_published_axes_become_realisable_within_their_rounding(published):
    fits = {name: nearest_realisable(one.distances.among(4)).fit for name, one in published.items()}
    assert {name for name, fit in fits.items() if fit is Fit.WITHIN_BOUNDS} == {"i", "j"}
    assert set(fits.values()) == {Fit.AS_GIVEN, Fit.WITHIN_BOUNDS}


def test_l_is_impossible_unless_the_hardware_is_rounded_too(published):
    given = published["l"].distances
    assert nearest_realisable(given).fit is Fit.IMPOSSIBLE
    values = dict(zip(given.names, given.values.tolist(), strict=True))
    assert nearest_realisable(MeasuredDistances.of(values, MILLIMETRE)).is_realisable


def test_the_recorded_pose_tells_parallel_axes_from_others(published):
    for name in "ghi":
        assert inspect(published[name], samples=10).category_distances.scara < np.radians(5.0)
    for name in "def":
        assert inspect(published[name], samples=10).invariants.a < 0.03
    for name, least, most in (("j", 0.03, 0.04), ("k", 0.08, 0.09)):
        assert least < inspect(published[name], samples=10).category_distances.spherical < most
