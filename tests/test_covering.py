"""What of a surface is covered where a part may be left, and outliers lie near."""

import numpy as np
from planted_surfaces import as_points

from synth.synthesis import solve


def test_few_outliers_near_a_surface_do_not_hold_the_shape():
    # Two of 120 lie near; steps on all that is covered best end a third of a millimetre off.
    task, _, inliers = as_points(1, outliers=0.2, tolerance=1e-4)
    solution = solve(task)
    assert solution.found
    assert np.max(solution.best.arm.closest_joints(task.table.positions[inliers])[1]) < 1e-4
