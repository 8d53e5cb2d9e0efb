"""The order in which shapes that reach every target are preferred, one figure at a time."""

from dataclasses import replace

import numpy as np
import pytest
from planted import planted_task

from synth.synthesis import verify
from synth.synthesis.wanted.design import Design
from synth.synthesis.wanted.judging import judged
from synth.synthesis.wanted.ranking import STEPS, best_of, preferences, preferred

GOOD = {
    "ways_missing": 0,
    "shortfall": 0.0,
    "largest_swing": 1.0,
    "expected_worst_miss": 8e-3,
    "travel": 2.0,
    "bend": 5.0,
}
# Each is worse than all that follow could make good.
WORSE = [
    {"ways_missing": 1},
    {"shortfall": 0.4},
    {"largest_swing": 3.0},
    {"expected_worst_miss": 9e-3},
    {"travel": 2.5},
    {"bend": 6.0},
]
BETTER_IN_ALL = {"largest_swing": 0.5, "expected_worst_miss": 5e-3, "travel": 1.0, "bend": 1.0}


def first(*shapes):
    return preferred(np.array([preferences(**(GOOD | shape)) for shape in shapes]))[0]


@pytest.mark.parametrize("place", range(6))
def test_what_matters_more_decides_whatever_the_rest(place):
    later = {key: value for key, value in BETTER_IN_ALL.items() if key in list(GOOD)[place + 1 :]}
    assert first(WORSE[place] | later, {}) == 1
    assert first({}, WORSE[place] | later) == 0


def test_less_than_a_step_leaves_the_decision_to_what_follows():
    assert first({"expected_worst_miss": 8.4e-3, "travel": 1.0}, {}) == 0
    assert first({"expected_worst_miss": 8.6e-3, "travel": 1.0}, {}) == 1
    # The steps count from the best, not from multiples of the step.
    assert first({"expected_worst_miss": 4.77e-3, "bend": 1.0}, {"expected_worst_miss": 4.74e-3}) == 0


def test_two_swings_that_are_calm_are_as_good():
    assert first({"largest_swing": np.radians(119), "bend": 1.0}, {"largest_swing": np.radians(20)}) == 0
    assert first({"largest_swing": np.radians(121), "bend": 1.0}, {"largest_swing": np.radians(20)}) == 1


def test_a_swing_is_better_than_what_no_hand_can_hold():
    swings = {"largest_swing": np.radians(149)}
    assert first(swings | {"expected_worst_miss": 5e-3}, {"expected_worst_miss": 22e-3}) == 0
    assert first(swings | {"expected_worst_miss": 5e-3}, {"expected_worst_miss": 14e-3}) == 1


def test_the_order_is_a_permutation_and_does_not_depend_on_the_order_given():
    rng = np.random.default_rng(0)
    table = rng.uniform(size=(60, len(STEPS))) * STEPS * 4
    table[:, -1] = rng.uniform(size=60)  # no two bends are alike
    order = preferred(table)
    assert sorted(order) == list(range(60))
    shuffled = rng.permutation(60)
    assert np.array_equal(table[shuffled][preferred(table[shuffled])], table[order])


def test_a_shape_without_a_way_stands_behind_and_not_beside():
    task, arm = planted_task(5, 3)
    good = judged(task, Design(arm, verify(task, arm)))
    assert good.figures.ways_missing == 0
    other = replace(arm, shape=replace(arm.shape, curvatures=-arm.shape.curvatures))
    closed = replace(good, arm=other, figures=replace(good.figures, ways_missing=1, bend=0.0))
    assert best_of(task, [closed, good]) == (good,)
    assert best_of(task, [closed]) == (closed,)
