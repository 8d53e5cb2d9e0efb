"""What the hardware rules out, box by box: never a shape that the link can take."""

from dataclasses import replace

import numpy as np
from planted import ROBOT, planted_task
from sampled_shapes import boxes_at, parameters

from synth.robot import Arm, ArmBody, LinkReach
from synth.synthesis.bound import LinkEnd
from synth.synthesis.bound.limits import Limits, ReachTable
from synth.synthesis.shapes.shapes import Shapes


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
