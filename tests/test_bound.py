"""The bound is a theorem: no shape may contradict it, and it must be worth something."""

import json
from dataclasses import replace

import numpy as np
import pytest
from planted import ROBOT, planted_task
from sampled_shapes import boxes_at, contradictions, noisy_task, parameters, shapes_about, task_about
from scipy.optimize import linprog

from synth.export import solution_to_json
from synth.robot import Arm, ArmBody, Interval, JointLimits, LinkReach
from synth.synthesis import Status, solve, verify
from synth.synthesis.bound import Bound, LinkEnd, prove
from synth.synthesis.bound.boxes import Boxes
from synth.synthesis.bound.cells import Cells
from synth.synthesis.bound.contraction import contracted, hull_of_cells
from synth.synthesis.bound.forms import Circle
from synth.synthesis.bound.limits import Limits, ReachTable
from synth.synthesis.bound.linear import combined, multipliers
from synth.synthesis.shapes.shapes import Shapes
from synth.watch import Watch


def ended_after(looks):
    """Return a watch that is up once it was asked so many times."""
    left = iter(range(looks))
    return Watch(stop=lambda: next(left, None) is None)


@pytest.mark.parametrize("seed", range(6))
def test_no_shape_contradicts_the_bound_of_a_box_around_it(seed):
    rng = np.random.default_rng(seed)
    shapes = shapes_about(ROBOT, 250, rng)
    wrong, asked, ratios = contradictions(task_about(shapes, 1 + seed, rng), shapes, rng)
    assert wrong == 0
    assert asked > 350
    # A bound that is nothing, or far below the misses, would not be contradicted either.
    assert len(ratios) > asked / 4
    assert ratios.max() > 0.99


def test_every_direction_and_its_mirror_image_is_in_a_chart():
    rng = np.random.default_rng(0)
    shapes = Shapes.sample(ROBOT, 2000, rng)
    chart, where = parameters(shapes)
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


@pytest.mark.parametrize("width", [0.003, 0.05])
def test_no_point_of_a_cell_is_nearer_to_its_target_than_its_affine_bounds(width):
    rng = np.random.default_rng(0)
    count, targets = 2000, 8
    middle = rng.uniform([0.05, -0.2, -0.78, -0.78, -3.0], [0.6, 0.8, 0.78, 0.78, 3.0], (count, 5))
    half = 10.0 ** rng.uniform(-3.0, -0.5, (count, 1)) * rng.uniform(0.1, 1.0, (count, 5))
    half[:, 0] = np.minimum(half[:, 0], middle[:, 0])
    chart = rng.integers(0, 5, count)
    circle = Circle(0.1, 0.35, rng.uniform(0.0, 0.8, targets), rng.uniform(0.0, 0.8, targets))
    cells = Cells(np.arange(count), rng.integers(0, targets, count), rng.uniform(-3.0, 3.0, count), width)
    forms = circle.forms(boxes_at(chart, middle, half), cells)
    closest = np.full(count, np.inf)
    for _ in range(60):
        v, share = rng.uniform(-1.0, 1.0, (count, 5)), rng.uniform(-1.0, 1.0, count)
        corner = rng.uniform(size=(count, 6)) < 0.4
        v, share = np.where(corner[:, :5], np.sign(v), v), np.where(corner[:, 5], np.sign(share), share)
        there = boxes_at(chart, middle + v * half, 0.0 * half)
        u, e1, e2 = there.frame
        phi = (cells.phi + share * width)[:, None]
        point = there.end + circle.offset * u + circle.radius * (np.cos(phi) * e1 + np.sin(phi) * e2)
        rho, z = np.hypot(point[:, 0], point[:, 1]), point[:, 2]
        distance = np.hypot(rho - circle.rho[cells.target], z - circle.z[cells.target])
        bound = forms.values + np.einsum("ksc,ck->sc", forms.slopes, v[:, :4])
        bound += forms.along_cell * np.sin(share * width)
        assert (distance - bound).min() > -1e-12
        assert (distance - forms.least()).min() > -1e-12
        closest = np.minimum(closest, distance - bound.max(axis=0))
    # And they are close in small boxes: the remainder is of second order.
    small = half[:, :4].max(axis=1) < 0.005
    assert np.median(closest[small]) < 1e-3


def test_narrowed_boxes_keep_what_affine_functions_allow():
    rng = np.random.default_rng(0)
    count, m = 300, 7
    slopes = rng.normal(size=(5, m, count)) * 10.0 ** rng.uniform(-2.0, 0.5, (5, m, count))
    values = -0.3 * np.abs(slopes).sum(axis=0)
    lower, upper = contracted(values, slopes)
    kept = 0
    for _ in range(400):
        v = rng.uniform(-1.0, 1.0, (5, count))
        allowed = (values + np.einsum("kmn,kn->mn", slopes, v) <= 0.0).all(axis=0)
        assert ((lower <= v) & (v <= upper))[:, allowed].all()
        kept += np.count_nonzero(allowed)
    assert kept > 1000
    # One function alone is followed exactly: the other parameters go where it is least.
    one, slope = values[:1], slopes[:, :1]
    lower, upper = contracted(one, slope)
    room = np.abs(slope).sum(axis=0) - one[0] - np.abs(slope[:, 0])
    limit = room / np.abs(slope[:, 0])
    rising = slope[:, 0] > 0.0
    assert np.allclose(upper[rising], np.minimum(limit, 1.0)[rising], atol=1e-8)
    assert np.allclose(lower[~rising], -np.minimum(limit, 1.0)[~rising], atol=1e-8)
    assert np.count_nonzero(limit < 0.9) > 30


def test_narrowed_boxes_keep_what_is_near_a_cell_of_each_target():
    rng = np.random.default_rng(0)
    count, targets, each = 200, 3, 4
    box = np.repeat(np.arange(count), targets * each)
    starts = np.arange(0, len(box), each)
    slopes = rng.normal(size=(4, 2, len(box))) * 10.0 ** rng.uniform(-2.0, 0.5, (4, 2, len(box)))
    values = (rng.uniform(size=len(box)) - 0.4) * np.abs(slopes).sum(axis=0)
    psi = rng.uniform(-1.5, 0.5, len(box)), rng.uniform(0.0, 1.5, len(box))
    near, lower, upper = hull_of_cells(values, slopes, psi, box, starts)
    kept = 0
    for _ in range(400):
        v = rng.uniform(-1.0, 1.0, (5, count))
        at = v[:, box]
        by_cell = (values + np.einsum("ksc,kc->sc", slopes, at[:4]) <= 0.0).all(axis=0)
        by_cell &= (psi[0] <= at[4]) & (at[4] <= psi[1])
        allowed = np.logical_or.reduceat(by_cell, starts).reshape(count, targets).all(axis=1)
        assert near[by_cell & allowed[box]].all()
        assert ((lower <= v) & (v <= upper))[:, allowed].all()
        kept += np.count_nonzero(allowed)
    assert kept > 1000
    assert np.mean(~near) > 0.05
    # With one target that has one cell, each of its functions narrows the box as it would alone.
    few = np.arange(count)
    alone = hull_of_cells(values[:, few], slopes[..., few], (psi[0][few], psi[1][few]), few, few)
    left = alone[0]
    assert np.count_nonzero(left) > 30
    for side in range(2):
        lower, upper = contracted(values[[side]][:, few], slopes[:, [side]][..., few])
        assert (alone[2][:4, left] <= upper[:, left] + 1e-8).all()
        assert (alone[1][:4, left] >= lower[:, left] - 1e-8).all()
        assert np.mean(upper[:, left] - lower[:, left] < 1.9) > 0.1
    assert np.array_equal(alone[2][4, left], np.minimum(psi[1][few], 1.0)[left])


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
    chart, where = parameters(Shapes.sample(ROBOT, 4000, np.random.default_rng(1)))
    boxes = boxes_at(chart, where, np.full(where.shape, 1e-9))
    assert limits.allow_end(boxes).all()
    value, _, known = limits.length_cut(boxes)
    assert known.any()
    assert (value[known] <= 1e-9).all()
    assert limits.allow_direction(boxes, where[:, 4:], 1e-9).all()
    # And it forbids something: directions that the same ends cannot have.
    assert np.mean(~limits.allow_direction(boxes, where[:, 4:] + np.pi, 1e-9)) > 0.05


def test_no_limit_forbids_a_shape_whose_tube_is_above_the_floor():
    floor = ROBOT.d12 - 0.1
    task = replace(planted_task(0, 4)[0], floor=floor)
    limits = Limits.of(task)
    shapes = Shapes.sample(ROBOT, 1500, np.random.default_rng(2))
    arms = [shapes.arm(i, task.base) for i in range(1500)]
    above = np.array(
        [ArmBody(arm).lowest() >= floor and arm.axis_points[2:, 2].min() >= floor for arm in arms]
    )
    chart, where = parameters(shapes)
    boxes = boxes_at(chart, where, np.full(where.shape, 1e-9))
    allowed = limits.allow_end(boxes) & limits.allow_direction(boxes, where[:, 4:], 1e-9)[:, 0]
    assert np.count_nonzero(above) > 200
    assert allowed[above].all()
    # Of those below it, it forbids some only because of the tube.
    without = replace(limits, task=replace(task, floor=None))
    assert np.mean(allowed[~above]) < 0.9
    assert (without.allow_end(boxes) & without.allow_direction(boxes, where[:, 4:], 1e-9)[:, 0]).all()


def test_links_end_as_they_are_asked_to():
    rng = np.random.default_rng(0)
    shapes = Shapes.sample(ROBOT, 5, rng)
    for i in range(5):
        frame, position = shapes.arm(i, planted_task(0, 4)[0].base).shape.end_frame()
        shape = LinkEnd(position, frame).links(ROBOT.link, 4, 64, rng)[0]
        reached, there = shape.end_frame()
        # A turn about axis 1 is left open.
        invariants = [
            (np.hypot(*p[:2]), p[2], *f[2], *(p[:2] @ f[:2]), *(p[0] * f[1] - p[1] * f[0]))
            for f, p in ((frame, position), (reached, there))
        ]
        assert np.allclose(*invariants, atol=1e-6)
        arm = Arm(ROBOT, shape, ROBOT.rigid_link.d35.lower, ROBOT.rigid_link.d45.lower)
        assert shape.total_bend <= ROBOT.link.max_total_bend + 1e-9
        assert arm.shape.bends.max() <= ROBOT.link.max_curvature * (1.0 + 1e-9)


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
    solved = 0
    for i in range(60):
        rows = np.vstack([np.column_stack([slopes[i], -np.ones(12)]), np.append(cut_slopes[i], 0.0)])
        sides = [(-1.0, 1.0)] * 5 + [(None, None)]
        best = linprog(np.eye(6)[5], rows, np.append(-values[i], -cuts[i]), bounds=sides)
        if best.status == 0:
            assert least[i] == pytest.approx(best.fun, abs=1e-9)
            solved += 1
    assert solved > 30


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
        bound = prove(task, 0.01, np.zeros(6), tightest=0.5e-3, watch=ended_after(40))
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
    tight = prove(task, 1.7e-3, misses, tightest=1e-3, watch=Watch())
    same = prove(wide, 1.7e-3, misses, tightest=4e-3, watch=Watch())
    assert tight.lower_bound == same.lower_bound
    assert tight.excludes
    assert not same.excludes
    # A target with four times the tolerance of the others counts a quarter of its miss.
    first = replace(task.targets[0], tolerance=4e-3)
    mixed = prove(
        replace(task, targets=(first, *task.targets[1:])), 1.7e-3, misses, tightest=1e-3, watch=Watch()
    )
    assert mixed.lower_bound <= tight.lower_bound


def test_no_bound_is_better_than_a_false_one():
    task = noisy_task(2)
    rigid = replace(ROBOT.rigid_link, d35=Interval(0.4, 0.5))
    free = replace(task, robot=replace(ROBOT, rigid_link=rigid))
    assert prove(free, 0.01, np.zeros(7), tightest=1e-3, watch=Watch()) is None


def test_a_proof_that_is_stopped_keeps_its_bound():
    task, bounds = noisy_task(5), []
    whole = prove(
        task,
        1.7e-3,
        np.zeros(5),
        tightest=1e-3,
        watch=Watch(report=lambda told: bounds.append(told.lower_bound)),
    )
    assert bounds == sorted(bounds)
    for steps in (0, len(bounds) // 2, len(bounds) - 1):
        part = prove(task, 1.7e-3, np.zeros(5), tightest=1e-3, watch=ended_after(steps))
        assert part.lower_bound <= whole.lower_bound


def test_a_bound_has_a_sentence_where_nothing_was_found():
    assert (
        Bound(2.0e-3, np.inf, 1e-3, 7).sentence
        == "proven: every shape misses some target by at least 2.000 mm"
    )
    assert Bound(2.0e-3, 2.5e-3, 1e-3, 7).sentence.endswith("found is within 0.500 mm of the least there is")
    assert Bound(0.0, np.inf, 1e-3, 7).sentence == "proven: nothing yet"


def test_a_bound_is_told_on_the_safe_side_and_of_the_shape_shown():
    bound = Bound(2.0005e-3, 2.1e-3, 1e-3, 7)
    assert "at least 2.000 mm" in bound.sentence
    assert "within 0.100 mm" in bound.sentence
    assert bound.sentence_of_shape(9.69051e-3).endswith(
        "the worst miss of this shape is within 7.691 mm of the least there is"
    )


def test_where_tolerances_differ_a_gap_is_one_of_weighted_misses():
    """With tolerances of 1 and 2 mm a plain miss of 3 mm may be a weighted one of 1.5 mm."""
    bound = Bound(1.0e-3, 1.5e-3, 1e-3, 7, weighted=True)
    assert bound.sentence_of_shape(1.5e-3).endswith(
        "the worst miss of this shape, each weighed by the tightest tolerance over its own, "
        "is within 0.500 mm of the least there is"
    )
    task = noisy_task(2)
    loose = replace(
        task, targets=tuple(replace(t, tolerance=(1 + i) * 1e-3) for i, t in enumerate(task.targets))
    )
    told = []
    misses = np.full(len(task.targets), 0.3)
    for each in (task, loose):
        watch = Watch(stop=lambda: len(told) > 5, report=told.append)
        made = prove(each, 0.3, misses, tightest=float(each.tolerances.min()), watch=watch)
        assert made.weighted == (each is loose)
        assert (told[-1].worst_miss < np.inf) == (each is task)  # no plain miss, so none is told
        told.clear()


def test_a_gap_that_may_be_joint_1s_is_said_to_be_so():
    """Joint 1 turns by little, so every shape misses by far more than the bound, which leaves joint 1 out."""
    task = noisy_task(2)
    limits = replace(task.robot.joint_limits, base=Interval(-0.2, 0.2))
    narrow = replace(task, robot=replace(task.robot, joint_limits=limits))
    bound = prove(narrow, 0.3, np.full(len(task.targets), 0.3), tightest=1e-3, watch=Watch(stop=lambda: True))
    assert "leaves out that joint 1 turns by 23 deg only; it may be all that the gap is" in bound.sentence
    assert "leaves out" not in replace(bound, lower_bound=0.29995).sentence  # there is no gap to speak of
    free = replace(task.robot, joint_limits=JointLimits(second=task.robot.joint_limits.second))
    bound = prove(
        replace(task, robot=free),
        0.3,
        np.full(len(task.targets), 0.3),
        tightest=1e-3,
        watch=Watch(stop=lambda: True),
    )
    assert "leaves out" not in bound.sentence
