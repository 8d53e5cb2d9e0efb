"""What of a surface is covered where a part may be left, and outliers lie near."""

import numpy as np
import pytest
from planted_surfaces import as_points, as_torus

from synth.synthesis import solve


def test_few_outliers_near_a_surface_do_not_hold_the_shape():
    # Two of 120 lie near; steps on all that is covered best end a third of a millimetre off.
    task, _, inliers = as_points(1, outliers=0.2, tolerance=1e-4)
    solution = solve(task)
    assert solution.found
    assert np.max(solution.best.arm.closest_joints(task.table.positions[inliers])[1]) < 1e-4


def test_the_covered_share_is_told_finer_than_by_the_samples():
    task = as_torus(16)
    solution = solve(task, alternatives=0)
    (surface,) = task.surfaces
    cells = surface.cells(40 * len(surface.samples))
    misses = solution.robot.closest_joints(cells.points)[1]
    share = cells.areas[misses <= surface.tolerance].sum() / cells.areas.sum()
    assert solution.best.verification.coverings[0].share == pytest.approx(share, abs=0.005)
