"""Exact arms through points, and what tells those that rounding spares."""

import numpy as np
from exact_targets import through
from hypothesis import strategies as st

FEW = st.integers(0, 2**32 - 1)


def surface(invariants):
    q = invariants.circle().surface(1.0, 2.0).q
    return q / q[0]


def well_conditioned(targets, radius, designs):
    """Whether the designs move by no more than 1e5 times what the targets are moved by."""
    nudged = through(targets + 1e-12 * np.sin(np.arange(targets.size)).reshape(targets.shape), radius)
    change = np.abs(nudged.values - designs.values)
    return np.array_equal(nudged.found, designs.found) and np.nanmax(change) < 1e-7
