"""The bound is a theorem: no shape may contradict it, and it must be worth something."""

import json
from dataclasses import replace

import numpy as np
import pytest
from planted import ROBOT, planted_task
from sampled_shapes import boxes_at, contradictions, noisy_task, parameters, shapes_about, task_about
from scipy.optimize import linprog

from synth.export import solution_to_json
from synth.robot import Interval, LinkReach
from synth.synthesis import Status, solve, verify
from synth.synthesis.bound import Bound, prove
from synth.synthesis.bound.boxes import Boxes
from synth.synthesis.bound.limits import Limits, ReachTable
from synth.synthesis.bound.linear import combined, multipliers
from synth.synthesis.population import Population


def never():
    return False


@pytest.mark.parametrize("seed", range(6))
def test_no_shape_contradicts_the_bound_of_a_box_around_it(seed):
    rng = np.random.default_rng(seed)
    population = shapes_about(ROBOT, 250, rng)
    wrong, asked, ratios = contradictions(task_about(population, 1 + seed, rng), population, rng)
    assert wrong == 0
    assert asked > 350
    # A bound that is nothing, or far below the misses, would not be contradicted either.
    assert len(ratios) > asked / 4
    assert ratios.max() > 0.99


def test_every_direction_and_its_mirror_image_is_in_a_chart():
    rng = np.random.default_rng(0)
    population = Population.sample(ROBOT, 2000, rng)
    chart, where = parameters(population)
    cover = Boxes.cover(1.0, (-1.0, 1.0))
    off = np.abs(where - cover.middle[chart]) - cover.half[chart]
    assert off.max() < 1e-12
    assert set(chart) == set(range(len(cover)))


def test_the_derivatives_of_the_frame_are_turns_about_e2_and_the_axis_of_beta():
    rng = np.random.default_rng(0)
    chart, middle = np.arange(5), rng.uniform(-0.7, 0.7, (5, 5))
    boxes, step = boxes_at(chart, middle, np.zeros((5, 5))), 1e-6
    beta_axis = np.einsum("ib,ibj->bj", boxes.beta_axis, np.stack(boxes.frame[:2]))
    for side, axis in ((2, boxes.frame[2]), (3, beta_axis)):
        shift = step * np.eye(5)[side]
        after, before = (boxes_at(chart, middle + s * shift, np.zeros((5, 5))).frame for s in (1.0, -1.0))
        for vector, plus, minus in zip(boxes.frame, after, before, strict=True):
            assert np.allclose((plus - minus) / (2.0 * step), np.cross(axis, vector), atol=1e-9)
    for vector in (*boxes.frame, beta_axis):
        assert np.allclose(np.linalg.norm(vector, axis=1), 1.0)


def test_halves_make_up_their_box():
    boxes = Boxes.cover(1.0, (0.0, 1.0))
    halves = boxes.halved(np.arange(5) % 5)
    lower, upper = halves.take(slice(None, 5)), halves.take(slice(5, None))
    assert np.allclose(
        np.minimum(lower.middle - lower.half, upper.middle - upper.half), boxes.middle - boxes.half
    )
    assert np.allclose(
        np.maximum(lower.middle + lower.half, upper.middle + upper.half), boxes.middle + boxes.half
    )
    assert np.isclose(np.prod(halves.half, axis=1).sum(), np.prod(boxes.half, axis=1).sum())


def test_no_limit_forbids_a_shape_that_the_link_can_take():
    task, _ = planted_task(0, 4)
    task, limits = replace(task, floor=None), Limits.of(replace(task, floor=None))
    chart, where = parameters(Population.sample(ROBOT, 4000, np.random.default_rng(1)))
    boxes = boxes_at(chart, where, np.full(where.shape, 1e-9))
    assert limits.allow_end(boxes).all()
    value, _, known = limits.length_cut(boxes)
    assert known.any()
    assert (value[known] <= 1e-9).all()
    assert limits.allow_direction(boxes, where[:, 4:], 1e-9).all()
    # And it forbids something: directions that the same ends cannot have.
    assert np.mean(~limits.allow_direction(boxes, where[:, 4:] + np.pi, 1e-9)) > 0.05


def test_the_least_length_to_an_end_is_convex_and_has_the_slopes_it_says():
    limits = Limits.of(planted_task(0, 4)[0])
    rng = np.random.default_rng(0)
    where = np.zeros((3000, 5))
    where[:, 0], where[:, 1] = rng.uniform(0.0, 0.7, 3000), rng.uniform(-0.4, 0.7, 3000)
    half = np.full(where.shape, 0.02)
    value, slopes, known = limits.length_cut(boxes_at(np.zeros(3000, dtype=int), where, half))
    for _ in range(5):
        step = np.zeros_like(where)
        step[:, :2] = rng.uniform(-0.02, 0.02, (3000, 2))
        there = np.maximum(where + step, [0.0, -np.inf, -np.inf, -np.inf, -np.inf])
        after, _, _ = limits.length_cut(boxes_at(np.zeros(3000, dtype=int), there, 0.0 * half))
        linear = value + np.einsum("bi,bi->b", slopes, (there - where)[:, :2])
        assert (after - linear)[known].min() > -1e-12
        assert (after - linear)[known].max() < 0.02
    assert known.mean() > 0.3


def test_the_table_of_the_reach_never_says_less_than_the_margin():
    reach = LinkReach(ROBOT.link)
    rng = np.random.default_rng(0)
    points = np.column_stack([rng.uniform(0.0, 0.7, 500), np.zeros(500), rng.uniform(-0.7, 0.7, 500)])
    upper = ReachTable.of(reach).upper_bound(points[:, 0], points[:, 2])
    curves = np.concatenate(reach.boundary(20_001))
    distance = np.array([np.hypot(*(curves - point[[0, 2]]).T).min() for point in points])
    margin = np.where(reach.contains(points), distance, -distance)
    assert (upper - margin).min() > 0.0
    assert (upper - margin).max() < 0.04


def test_the_multipliers_are_those_of_the_linear_program():
    rng = np.random.default_rng(0)
    values, slopes = rng.normal(size=(60, 12)), rng.normal(size=(60, 12, 5))
    cuts, cut_slopes = rng.normal(size=(60, 1)) - 1.0, rng.normal(size=(60, 1, 5))
    weights = multipliers(values, slopes, cuts, cut_slopes)
    assert min(weights[0].min(), weights[1].min()) >= 0.0
    assert np.allclose(weights[0].sum(axis=1), 1.0)
    _, _, least = combined(values, slopes, cuts, cut_slopes, *weights)
    for i in range(60):
        rows = np.vstack([np.column_stack([slopes[i], -np.ones(12)]), np.append(cut_slopes[i], 0.0)])
        sides = [(-1.0, 1.0)] * 5 + [(None, None)]
        best = linprog(np.eye(6)[5], rows, np.append(-values[i], -cuts[i]), bounds=sides)
        if best.status == 0:
            assert least[i] == pytest.approx(best.fun, abs=1e-9)


def test_a_task_that_misses_is_proven_impossible_and_the_gap_is_small():
    solution = solve(noisy_task(2), prove=True)
    bound = solution.bound
    assert solution.status is Status.PROVEN_IMPOSSIBLE
    assert bound.sentence in solution.message
    assert bound.lower_bound > 1e-3
    assert 0.0 <= bound.gap <= 1e-4 + 1e-12
    worst = min(design.verification.misses.max() for design in solution.designs)
    assert bound.lower_bound < bound.best_found <= worst
    assert json.loads(json.dumps(solution_to_json(solution)))["bound"] == {
        "lower_bound": bound.lower_bound,
        "gap": bound.gap,
    }


def test_a_planted_shape_is_never_below_the_bound():
    for seed in (5, 6):
        task, arm = planted_task(seed, 6)
        # Nothing better than a centimetre is known, so the proof has all room to be wrong.
        looks = iter(range(40))
        bound = prove(
            task, 0.01, np.zeros(6), tightest=0.5e-3, stop=lambda looks=looks: next(looks, None) is None
        )
        assert verify(task, arm).found
        assert bound.lower_bound <= verify(task, arm).misses.max() + 1e-12


def test_where_the_targets_are_met_there_is_nothing_to_prove():
    task, _ = planted_task(4, 3)
    solution = solve(task, prove=True)
    assert solution.status is Status.FOUND
    assert solution.bound.lower_bound == 0.0
    assert solution.bound.gap < 1e-4
    assert solution.bound.boxes == 0


def test_tolerances_scale_the_bound():
    task = noisy_task(5)
    wide = replace(task, targets=tuple(replace(t, tolerance=4e-3) for t in task.targets))
    misses = np.zeros(len(task.targets))
    tight = prove(task, 1.7e-3, misses, tightest=1e-3, stop=never)
    same = prove(wide, 1.7e-3, misses, tightest=4e-3, stop=never)
    assert tight.lower_bound == same.lower_bound
    assert tight.excludes
    assert not same.excludes
    # A target with four times the tolerance of the others counts a quarter of its miss.
    first = replace(task.targets[0], tolerance=4e-3)
    mixed = prove(
        replace(task, targets=(first, *task.targets[1:])), 1.7e-3, misses, tightest=1e-3, stop=never
    )
    assert mixed.lower_bound <= tight.lower_bound


def test_no_bound_is_better_than_a_false_one():
    task = noisy_task(2)
    rigid = replace(ROBOT.rigid_link, d35=Interval(0.4, 0.5))
    free = replace(task, robot=replace(ROBOT, rigid_link=rigid))
    assert prove(free, 0.01, np.zeros(7), tightest=1e-3, stop=never) is None


def test_a_proof_that_is_stopped_keeps_its_bound():
    task, bounds = noisy_task(5), []
    whole = prove(task, 1.7e-3, np.zeros(5), tightest=1e-3, stop=never, progress=bounds.append)
    assert bounds == sorted(bounds)
    for steps in (0, len(bounds) // 2, len(bounds) - 1):
        looks = iter(range(steps))
        part = prove(
            task, 1.7e-3, np.zeros(5), tightest=1e-3, stop=lambda looks=looks: next(looks, None) is None
        )
        assert part.lower_bound <= whole.lower_bound


def test_a_bound_has_a_sentence_where_nothing_was_found():
    assert (
        Bound(2.0e-3, np.inf, 1e-3, 7).sentence
        == "proven: every shape misses some target by at least 2.000 mm"
    )
    assert Bound(2.0e-3, 2.5e-3, 1e-3, 7).sentence.endswith("within 0.500 mm of the best there is")
