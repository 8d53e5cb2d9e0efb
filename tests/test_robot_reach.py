"""The reach of the malleable link in closed form, against links bent every which way."""

import numpy as np
import pytest
from bent_links import RADIUS, RATIOS, random_ends, reach_of, two_piece_ends
from planted import ROBOT, out_of_reach, planted_arm, planted_task

from synth.robot import Interval, LinkReach, MalleableLink
from synth.synthesis.bound.impossibility import why_impossible


@pytest.mark.parametrize("ratio", RATIOS)
def test_no_link_ends_outside(ratio):
    # A link bent to its limit all along ends on the boundary, up to the root of rounding.
    assert reach_of(ratio).margin(random_ends(ratio, 20_000, 0)).min() > -1e-9


@pytest.mark.parametrize("ratio", RATIOS)
def test_the_boundary_is_reached(ratio):
    explicit = two_piece_ends(ratio)
    for curve in reach_of(ratio).boundary(61):
        gaps = np.linalg.norm(curve[:, None] - explicit, axis=-1).min(axis=1)
        assert gaps.max() < 0.01 * ratio * RADIUS


@pytest.mark.parametrize("ratio", RATIOS)
def test_the_margin_has_the_sign_of_the_reach_and_changes_no_faster_than_the_position(ratio):
    reach, rng = reach_of(ratio), np.random.default_rng(1)
    extent = 1.2 * ratio * RADIUS
    points = rng.uniform(-extent, extent, (2000, 3))
    margins = reach.margin(points)
    assert np.array_equal(margins > 0.0, reach.contains(points))
    shifts = rng.normal(scale=0.05 * extent, size=points.shape)
    changes = np.abs(reach.margin(points + shifts) - margins)
    assert np.all(changes <= np.linalg.norm(shifts, axis=1) + 1e-9)


def test_an_interval_of_lengths_reaches_what_any_of_them_reaches():
    reach, rng = LinkReach(ROBOT.link), np.random.default_rng(2)
    points = rng.uniform(-0.75, 0.75, (4000, 3))
    lengths = np.linspace(ROBOT.link.length.lower, ROBOT.link.length.upper, 61)
    single = [LinkReach(MalleableLink(Interval.fixed(length), RADIUS)).contains(points) for length in lengths]
    by_any = np.any(single, axis=0)
    inside = reach.contains(points)
    assert np.all(inside[by_any])
    # Between the lengths tried, 2.5 mm apart, lies what only the interval reaches.
    assert np.mean(inside & ~by_any) < 0.01


def test_samples_are_in_the_reach_and_planted_links_too():
    reach = LinkReach(ROBOT.link)
    assert reach.contains(reach.sample(2000)).all()
    rng = np.random.default_rng(3)
    ends = np.array([planted_arm(rng).shape.end_frame()[1] for _ in range(100)])
    assert reach.contains(ends).all()


def test_no_planted_task_is_proven_impossible_and_every_one_out_of_reach_is():
    for seed in range(60):
        assert why_impossible(planted_task(seed)[0]) == ()
        assert why_impossible(out_of_reach(seed))
