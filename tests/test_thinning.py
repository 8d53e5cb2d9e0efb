"""A part of many targets: how it is drawn."""

import numpy as np
from planted import planted_task

from synth.synthesis.starts.thinning import thinned
from synth.task import TargetTable


def ring(count, gap_deg):
    """A task of targets on a ring about axis 1, all but a gap of it."""
    angles = np.radians(np.linspace(0.0, 360.0 - gap_deg, count))
    points = 0.5 * np.column_stack([np.cos(angles), np.sin(angles), 0.0 * angles + 0.6])
    table = TargetTable([f"t{i}" for i in range(count)], points, np.full(count, 1e-3), np.ones(count))
    return planted_task(0, 1)[0].__class__("ring", planted_task(0, 1)[0].robot, table)


def test_the_part_shows_where_no_target_is_as_precisely_as_all_of_them_for_every_seed():
    task = ring(2000, gap_deg=25.0)
    for seed in range(20):
        part = thinned(task, 40, np.random.default_rng(seed))
        assert len(part.targets) == 40
        angles = np.sort(np.degrees(np.arctan2(*part.positions_in_base[:, 1::-1].T)) % 360.0)
        widest = np.max(np.diff(angles, append=angles[0] + 360.0))
        assert widest < 25.0 + 2.0 * 335.0 / 40.0


def test_few_targets_are_all_kept_and_none_twice():
    task = ring(30, gap_deg=90.0)
    assert thinned(task, 40, np.random.default_rng(0)) is task
    part = thinned(task, 20, np.random.default_rng(0))
    assert len(set(part.table.names)) == 20
