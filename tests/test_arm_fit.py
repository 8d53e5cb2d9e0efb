"""The arm from markers: it is found, and its uncertainty is what happens."""

import numpy as np
import pytest
from planted import ROBOT
from standing import BARS, HOLD, SIGMA, seen, standing

from synth.measurement import fit_arm
from synth.measurement.markers.standing_arm import FREEDOMS

TIP = ROBOT.tip_offset


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("names", ["P1 P2 P3 P4 P5", BARS, "P1 A1:300 A2:-150 A2:150 E:-60"])
def test_exact_markers_give_the_exact_arm(seed, names):
    wanted, true = standing(seed)
    fit = fit_arm(seen(true, names), wanted, TIP, SIGMA, base_calibrated=True)
    assert np.linalg.norm(fit.arm.end - true.end) < 1e-6
    assert np.linalg.norm(fit.arm.axis - true.axis) < 1e-6
    assert np.linalg.norm(fit.residuals, axis=1).max() < 1e-6
    assert fit.shows_axes
    assert fit.shows_roll
    assert np.linalg.norm(fit.arm.frame - true.frame) < 3e-4  # the prior on the roll pulls by so little


@pytest.mark.parametrize("names", ["P1 P2 P3 P4 P5", "P1 P2 A1:150 P3 P4 P5 A2:-150 A2:150"])
def test_errors_are_as_large_as_told(names):
    rng = np.random.default_rng(0)
    squares, chi = [], []
    for seed in range(60):
        wanted, true = standing(seed % 6)
        fit = fit_arm(seen(true, names, rng), wanted, TIP, SIGMA, base_calibrated=False)
        turn = true.frame @ fit.arm.frame.T
        spin = 0.5 * np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
        end = np.concatenate([true.end - fit.arm.end, spin])
        squares.append(end @ np.linalg.solve(fit.covariance[5:, 5:], end))
        chi.append(fit.chi_square / fit.excess)
    assert 4.8 < np.mean(squares) < 7.3  # 6 degrees of freedom
    assert 0.8 < np.mean(chi) < 1.2


def test_four_points_do_not_show_the_zero_of_joint_2():
    wanted, true = standing(0)
    fit = fit_arm(seen(true, "P1 P2 P3 P4"), wanted, TIP, SIGMA, base_calibrated=False)
    assert fit.shows_axes
    assert not fit.shows_roll


def test_a_bar_shows_the_direction_five_times_better():
    wanted, true = standing(0)
    four, bar = (
        fit_arm(seen(true, names), wanted, TIP, SIGMA, base_calibrated=True).direction_sigma
        for names in ("P1 P2 P3 P4 P5", BARS)
    )
    assert four / bar > 5.0


def test_a_turn_of_joint_1_shows_axis_1_without_a_marker_on_it():
    rng = np.random.default_rng(0)
    wanted, true = standing(2)
    true = true.displaced(np.concatenate([[0.004, -0.003, 0.0, 0.01, -0.02], np.zeros(6)]))
    turns = np.repeat(HOLD + np.radians([0.0, 60.0, 120.0, -90.0]), 5)
    names = " ".join(["P3 P4 P5 A2:-150 A2:150"] * 4)
    readings = seen(true, names, rng, np.column_stack([turns, np.full(20, np.pi)]))
    fit = fit_arm(readings, wanted, TIP, SIGMA, base_calibrated=False)
    assert np.degrees(np.arccos(np.clip(fit.arm.direction @ true.direction, -1, 1))) < 0.1
    assert np.sqrt(np.diag(fit.covariance)[3:5]).max() < 2e-3


def test_samples_have_the_covariance():
    wanted, true = standing(1)
    fit = fit_arm(seen(true, BARS), wanted, TIP, SIGMA, base_calibrated=True)
    drawn = np.cov(fit.errors(20000).T)
    scale = np.sqrt(np.outer(np.diag(fit.covariance), np.diag(fit.covariance)))
    assert drawn.shape == (FREEDOMS, FREEDOMS)
    assert np.abs((drawn - fit.covariance) / scale).max() < 0.05
