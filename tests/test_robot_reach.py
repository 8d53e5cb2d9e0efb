"""The reach of the malleable link in closed form, against links bent every which way."""

import numpy as np
import pytest
from planted import ROBOT, out_of_reach, planted_arm, planted_task

from synth.robot import Interval, LinkReach, MalleableLink, chain_end
from synth.synthesis.impossibility import why_impossible

RADIUS = 0.11
RATIOS = [1.5, 2.5, 3.5, 5.0, 6.2]


def reach_of(ratio):
    return LinkReach(MalleableLink(Interval.fixed(ratio * RADIUS), RADIUS))


def random_ends(ratio, count, seed):
    """Return ends of links of eight arcs, many of them straight, bent to the limit, or in one plane."""
    rng = np.random.default_rng(seed)
    bends = np.where(rng.uniform(size=(count, 8)) < 0.5, 1.0, np.sqrt(rng.uniform(size=(count, 8))))
    bends *= rng.uniform(size=(count, 8)) > 0.25
    plane = rng.choice([0.0, np.pi], (count, 8))
    turns = np.where(rng.uniform(size=(count, 1)) < 0.5, plane, rng.uniform(0.0, 2.0 * np.pi, (count, 8)))
    curvatures = bends[..., None] * np.stack([np.cos(turns), np.sin(turns)], axis=-1) / RADIUS
    return chain_end(curvatures, rng.dirichlet(np.ones(8), count) * ratio * RADIUS)[1]


def two_piece_ends(ratio):
    """Return ends of an arc with a straight, and of two opposite arcs, as (rho, height)."""
    turns = np.linspace(0.0, ratio, 2001)
    pieces = np.stack([turns, ratio - turns], axis=-1) * RADIUS
    ends = []
    for second in (0.0, -1.0, 1.0):
        curvatures = np.zeros((len(turns), 2, 2))
        curvatures[:, :, 0] = np.array([1.0, second]) / RADIUS
        ends.append(chain_end(curvatures, pieces)[1])
    points = np.concatenate(ends)
    return np.column_stack([np.hypot(points[:, 0], points[:, 1]), points[:, 2]])


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
