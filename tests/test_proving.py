"""The certificate of a search: it improves on what was found, proves the rest, and ends when it must."""

import math
from dataclasses import replace

import numpy as np
import pytest
from planted import planted_task
from sampled_shapes import noisy_task

from synth.errors import SolverError
from synth.synthesis import proving, solve, verify
from synth.synthesis.proving import Certifier
from synth.synthesis.wanted import Design
from synth.watch import Watch

TIGHTEST = 1e-3


class Found:
    """The shapes found so far, with each that the certifier puts to them."""

    def __init__(self, task, *arms):
        self.task, self.designs = task, [Design(arm, verify(task, arm)) for arm in arms]
        self.given = len(self.designs)

    def keep(self, arm, joints):
        design = Design(arm, verify(self.task, arm, joints))
        if not design.verification.violations:
            self.designs.append(design)
        return design

    def certificate(self, watch=None):
        certifier = Certifier(self.task, TIGHTEST, self.designs, self.keep, watch or Watch(), 0)
        return certifier.certificate()

    def worst(self, designs):
        weights = TIGHTEST / self.task.tolerances
        return min(float(np.max(design.verification.misses * weights)) for design in designs)


@pytest.fixture(scope="module")
def missed():
    """A task that no shape meets, and the shape of the least squared misses."""
    task = noisy_task(5)
    first, *others = task.targets
    task = replace(task, targets=(replace(first, tolerance=3e-3, weight=1e4), *others))
    return task, solve(task, alternatives=0).robot


def test_the_worst_miss_is_made_less_and_bounded_whatever_the_task_counts(missed):
    left, found = iter(range(4000)), Found(*missed)  # four times as many looks as it takes
    bound = found.certificate(Watch(stop=lambda: next(left, None) is None))
    given, polished = found.worst(found.designs[:1]), found.worst(found.designs)
    assert polished < given - 1e-5
    # By the tightest tolerance over the target's own; the weights are for the objective alone.
    assert bound.best_found == pytest.approx(polished, abs=1e-12)
    assert bound.weighted
    assert 0.0 < bound.lower_bound <= bound.best_found
    assert bound.gap <= 1e-4 + 1e-12


def test_a_shape_that_no_polishing_improved_is_bounded_as_it_is(missed, monkeypatch):
    def broken(*_):
        raise SolverError("broken")

    monkeypatch.setattr(proving, "shared_nlp", broken)
    left = iter(range(5))
    found = Found(*missed)
    bound = found.certificate(Watch(stop=lambda: next(left, None) is None))
    assert bound.best_found <= found.worst(found.designs[:1])
    assert bound.lower_bound <= bound.best_found


def test_a_certificate_for_which_there_is_no_time_proves_nothing_and_keeps_what_is_known(missed):
    found = Found(*missed)
    bound = found.certificate(Watch(stop=lambda: True))
    assert bound.lower_bound == 0.0
    assert bound.best_found == pytest.approx(found.worst(found.designs), abs=1e-12)
    assert bound.boxes == 0


def test_where_all_is_met_no_other_start_is_looked_for(monkeypatch):
    def never(*_, **__):
        raise AssertionError

    monkeypatch.setattr(proving, "start_points", never)
    task, _ = planted_task(4, 3)
    found = Found(task, solve(task, alternatives=0).robot)
    bound = found.certificate()
    assert bound.lower_bound == 0.0
    assert bound.best_found < 1e-4


def test_without_a_shape_all_that_is_known_is_the_bound(monkeypatch):
    monkeypatch.setattr(proving, "start_points", lambda *_, **__: iter(()))
    found = Found(noisy_task(2))
    left = iter(range(5))
    bound = found.certificate(Watch(stop=lambda: next(left, None) is None))
    assert math.isinf(bound.best_found)
    assert found.designs == []


def test_a_free_rigid_link_has_no_certificate(missed):
    task, arm = missed
    rigid = replace(task.robot.rigid_link, d35=[0.44, 0.47])
    robot = replace(task.robot, rigid_link=rigid)
    found = Found(replace(task, robot=robot), replace(arm, robot=robot))
    assert found.certificate(Watch(stop=lambda: True)) is None
