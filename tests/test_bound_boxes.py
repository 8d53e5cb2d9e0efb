"""Boxes of shapes: what affine bounds, cuts and narrowing say holds for every shape of a box."""

import numpy as np
import pytest
from planted import ROBOT
from sampled_shapes import boxes_at, contradictions, parameters, shapes_about, task_about
from scipy.optimize import linprog

from synth.synthesis.bound.boxes import Boxes
from synth.synthesis.bound.cells import Cells
from synth.synthesis.bound.contraction import contracted, hull_of_cells
from synth.synthesis.bound.forms import Circle
from synth.synthesis.bound.linear import combined, multipliers
from synth.synthesis.shapes.shapes import Shapes


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
