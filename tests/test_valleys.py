"""The search among valleys: that it finds better ones, knows when it is enough, and repeats itself."""

import sys
from dataclasses import replace

import numpy as np
import pytest
from planted import ROBOT, noisy, planted_task

from synth.synthesis.shapes.shapes import Shapes
from synth.synthesis.starts.refined import Refined
from synth.synthesis.starts.refinement import refine
from synth.synthesis.starts.start_points import start_points
from synth.synthesis.starts.valleys import Valleys
from synth.task import Objective
from synth.watch import Watch


def drawn(seed, count=40):
    return Shapes.sample(ROBOT, count, np.random.default_rng(seed))


def explored(task, seed, stop=None, count=40):
    rng = np.random.default_rng(seed)
    fresh = refine(task, drawn(seed, count))
    valleys = replace(Valleys.of(task, fresh, None, Watch()), watch=Watch(stop=stop))
    return valleys, valleys.explored(lambda: Shapes.sample(ROBOT, 40, rng), rng)


def valleys_of(*costs, drawn, led=()):
    """Valleys in which fresh shapes, and those that algebra led, ended with these misses, m."""
    count = len(costs) + len(led)
    shapes = Shapes.sample(ROBOT, count, np.random.default_rng(0))
    refined = Refined(shapes, np.zeros((count, 1, 2)), np.square([*costs, *led]))
    return Valleys(noisy(0, count=1), Watch(), refined, np.square(costs), drawn, np.square(led))


def test_valleys_are_agreed_upon_when_a_share_of_the_fresh_shapes_ended_in_the_best():
    same = [0.02] * 10
    assert valleys_of(*same, *[0.03] * 190, drawn=200).agreed
    assert not valleys_of(*same, *[0.03] * 90, drawn=100).agreed  # too few were drawn to know
    assert not valleys_of(*same, *[0.03] * 190, drawn=400).agreed
    assert not valleys_of(0.019, *same, *[0.03] * 189, drawn=200).agreed
    assert valleys_of(*[1e-7] * 5, *[0.03] * 95, drawn=1000).agreed
    # Where hardly anything is missed there may be another sheet on which nothing is.
    assert not valleys_of(*[1e-3] * 100, drawn=100).agreed


def test_fewer_fresh_shapes_are_enough_where_algebra_leads_there_too():
    fresh = [0.02] * 6 + [0.03] * 34
    assert not valleys_of(*fresh, drawn=40).agreed
    assert not valleys_of(*fresh, drawn=40, led=[0.02, 0.03]).agreed
    assert valleys_of(*fresh, drawn=40, led=[0.02, 0.02, 0.03]).agreed
    assert not valleys_of(*fresh, drawn=40, led=[0.02, 0.02, 0.019]).agreed
    by_worst = replace(valleys_of(*fresh, drawn=40, led=[0.02] * 2), task=by_the_worst(noisy(0, count=1)))
    assert not by_worst.agreed  # there refined costs are only near those in the end


def by_the_worst(task):
    return replace(task, objective=Objective.MINIMAX)


@pytest.mark.parametrize("seed", range(3))
def test_exploring_never_loses_the_best_and_is_the_same_again(seed):
    task = noisy(seed, count=10)
    before, after = explored(task, seed)
    assert after.best.cost.min() <= before.best.cost.min()
    assert after.drawn >= before.drawn
    assert np.array_equal(explored(task, seed)[1].best.cost, after.best.cost)


def test_exploring_finds_better_valleys_than_a_few_shapes_do():
    ratios = []
    for seed in range(4):
        before, after = explored(noisy(seed, count=14, noise=0.08), seed, count=10)
        ratios.append(np.sqrt(after.best.cost.min() / before.best.cost.min()))
    assert np.mean(ratios) < 0.97


def test_exploring_ends_when_it_is_told_to():
    before, after = explored(noisy(0, count=14), 0, stop=lambda: True)
    assert after.drawn == before.drawn
    assert after.best.cost.min() == before.best.cost.min()


def test_starts_are_distinct_and_the_best_of_the_first_step_comes_first():
    task = noisy(1, count=12)
    first, found = list(start_points(task, 0, quick=True)), list(start_points(task, 0))
    costs = [start.cost for start in first]
    assert costs == sorted(costs)
    assert min(start.cost for start in found) <= costs[0] * (1.0 + 1e-9)
    assert len({start.arm.shape.curvatures.tobytes() for start in found}) == len(found)
    misses = [np.mean(start.arm.closest_joints(task.positions_in_base)[1] ** 2) for start in found]
    assert np.all(np.array([start.cost for start in found]) >= np.array(misses) * (1.0 - 1e-6))


def test_starts_of_many_targets_state_their_cost_for_all_of_them():
    task = noisy(2, count=60)
    start = next(start_points(task, 0))
    assert start.joints.shape == (60, 2)
    assert np.isclose(
        start.cost, np.mean(start.arm.closest_joints(task.positions_in_base)[1] ** 2), rtol=1e-9
    )


@pytest.mark.parametrize("count", [1, 6, 8])
def test_the_first_start_of_a_planted_task_is_an_answer_that_few_shapes_were_led_to(count, monkeypatch):
    led = []

    def counted(task, shapes, *args, **kwargs):
        led.append(len(shapes.length))
        return refine(task, shapes, *args, **kwargs)

    monkeypatch.setattr(sys.modules[start_points.__module__], "refine", counted)
    task = planted_task(3, count)[0]
    start = next(start_points(task, 0))
    assert (start.misses(task) <= 5e-3 * task.tolerances).all()
    assert sum(led) <= 80
