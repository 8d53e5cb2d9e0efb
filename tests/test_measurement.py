"""Nearest realisable distances, misprints, samples, the link: laws, on planted and on published data."""

import ast
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from planted import ROBOT, planted_arm

from synth.errors import GeometryError
from synth.geometry import Invariants, SweptCircle, squared_distances
from synth.measurement import Fit, find_misprint, fit_link, inspect, nearest_realisable, sample_shapes
from synth.measurement.relaxation import consistent_interval
from synth.measurement.text import inspection_text
from synth.task.measured import MeasuredDistances, Measurement, Precision
from synth.task.measured_file import load_measurements

ROOT = Path(__file__).parents[1]
MILLIMETRE = Precision.from_rounding(1e-3)
HARDWARE = ("d12", "d34", "d35", "d45")
MEASURED = ("d13", "d14", "d15", "d23", "d24", "d25")


def named(points):
    s = np.sqrt(squared_distances(points))
    return {f"d{i + 1}{j + 1}": float(s[i, j]) for i in range(len(s)) for j in range(i + 1, len(s))}


def planted_points(seed):
    rng = np.random.default_rng(seed)
    arm = planted_arm(rng)
    return np.vstack([arm.axis_points, arm.kinematics.forward(0.0, rng.uniform(0.9, 5.4))])


def as_measured(distances, precision=MILLIMETRE):
    known = {name: value for name, value in distances.items() if name in HARDWARE}
    return MeasuredDistances.of({k: v for k, v in distances.items() if k not in HARDWARE}, precision, known)


def rounded(distances):
    return {name: value if name in HARDWARE else round(value, 3) for name, value in distances.items()}


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


def measurement_of(points, precision=MILLIMETRE, markers=None):
    robot = replace(ROBOT)
    return Measurement("planted", robot, precision, as_measured(rounded(named(points)), precision), markers)


def test_samples_keep_the_bounds_and_their_numbers_are_those_of_the_geometry():
    points = planted_points(2)
    measurement = measurement_of(points)
    samples = sample_shapes(measurement, 50, np.random.default_rng(0))
    spreads = samples.spreads()
    angles, misfits = [], samples.misfits()
    for k in range(len(samples)):
        shape = np.vstack([np.zeros(3), [0, 0, samples.d12[k]], samples.p3[k], samples.p4[k]])
        d = named(shape)
        for name, lower, upper in zip(
            measurement.distances.names, measurement.distances.lower, measurement.distances.upper, strict=True
        ):
            assert name not in d or lower - 1e-9 <= d[name] <= upper + 1e-9
        centre = samples.p3[k] + samples.centre_offset[k] * samples.axis[k]
        circle = SweptCircle(centre, samples.axis[k], float(samples.radius[k]))
        angles.append(Invariants.from_circle(circle).alpha)
        rho, z = samples.pose[k]
        assert float(circle.distance([rho, 0.0, z])) == pytest.approx(misfits[k], abs=5e-5)
    assert spreads["alpha"].least == pytest.approx(min(angles))
    assert spreads["alpha"].most == pytest.approx(max(angles))
    assert spreads["alpha"].low <= spreads["alpha"].median <= spreads["alpha"].high


def test_samples_surround_the_truth_and_shrink_with_the_rounding():
    points = planted_points(3)
    truth = Invariants.from_circle(SweptCircle.from_points(points)).alpha
    widths = []
    for step in (1e-3, 1e-4):
        measurement = measurement_of(points, Precision.from_rounding(step))
        measurement = replace(measurement, distances=as_measured(named(points), measurement.precision))
        spread = sample_shapes(measurement, 2000, np.random.default_rng(0)).spreads()["alpha"]
        assert spread.least <= truth <= spread.most
        widths.append(spread.high - spread.low)
    assert 4.0 < widths[0] / widths[1] < 25.0


def test_markers_are_sampled_as_points():
    points = planted_points(4)
    precision = Precision.from_sigma(1e-4)
    samples = sample_shapes(measurement_of(points, precision, points), 1000, np.random.default_rng(0))
    assert samples.drawn == 4000
    assert np.median(samples.misfits()) < 0.02


def test_the_link_of_a_planted_shape_is_found():
    for seed in range(6):
        points = planted_points(seed)
        distances = as_measured(rounded(named(points[:4])))
        fit = fit_link(ROBOT, distances, np.random.default_rng(seed))
        assert not fit.obstacle
        assert fit.found
        d = named(fit.arm.axis_points)
        for name, lower, upper in zip(distances.names, distances.lower, distances.upper, strict=True):
            assert lower - 1e-7 <= d[name] <= upper + 1e-7


def test_a_pose_beyond_the_link_is_proven_impossible_and_one_too_near_is_not_found():
    far = as_measured({"d12": 0.058, "d34": 0.049, "d13": 0.9, "d14": 0.91, "d23": 0.85, "d24": 0.86})
    fit = fit_link(ROBOT, far, np.random.default_rng(0))
    assert not fit.found
    assert "at most 700.0 mm" in fit.obstacle
    near = as_measured({"d12": 0.058, "d34": 0.049, "d13": 0.0, "d14": 0.049, "d23": 0.058, "d24": 0.076})
    fit = fit_link(ROBOT, near, np.random.default_rng(0))
    assert not fit.found
    assert not fit.obstacle
    assert fit.beyond > 1e-3


def test_numbers_that_make_no_sense_at_all_are_still_answered():
    distances = {"d13": 0.7, "d14": 0.01, "d23": 0.35, "d24": 1.86, "d15": 0.003, "d25": 0.05}
    hardware = {"d12": 0.058, "d34": 0.049, "d35": 0.455, "d45": 0.460}
    inspection = inspect(Measurement("nonsense", ROBOT, MILLIMETRE, as_measured({**distances, **hardware})))
    assert not inspection.is_realisable
    assert inspection.samples is None
    assert inspection.spreads == {}
    assert inspection_text(inspection)


def test_cvxpy_lives_in_one_file():
    package = ROOT / "synth"
    users = set()
    for path in package.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            if isinstance(node, ast.ImportFrom):
                names = [node.module or ""]
            if any(name.split(".")[0] == "cvxpy" for name in names):
                users.add(path.relative_to(package).as_posix())
    assert users == {"measurement/relaxation.py"}
