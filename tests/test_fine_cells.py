"""A surface is looked at finely enough to prove what is covered, and coarsely where that is known."""

import numpy as np
from planted_surfaces import as_mesh

from synth.robot import Arm
from synth.synthesis.check import between_samples
from synth.watch import Watch


def test_a_mesh_of_thousands_of_triangles_is_proven_covered_by_the_arm_that_it_was_made_of(monkeypatch):
    """Triangles lie at an angle to what they were taken from: only 64 times as many cells are fine enough."""
    task, arm = as_mesh(4, tolerance=5e-4)
    (surface,) = task.surfaces
    asked, closest_joints = [], Arm.closest_joints
    monkeypatch.setattr(
        Arm, "closest_joints", lambda self, points: asked.append(len(points)) or closest_joints(self, points)
    )
    told = between_samples(task, arm, surface, Watch())
    assert told.met
    assert np.isclose(told.share, 1.0)
    whole = len(surface.cells(64 * len(surface.samples)))
    assert sum(asked) < 0.25 * whole
