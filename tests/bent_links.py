"""Ends of links of one length, bent every which way, as ratios of length over bend radius."""

import numpy as np

from synth.robot import Interval, LinkReach, MalleableLink, chain_end

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
