"""Gauss-Newton on many shapes: its derivatives by differences, and where it leads."""

from dataclasses import replace

import numpy as np
import pytest
from planted import ROBOT, noisy, planted_task

from synth.geometry import Sphere
from synth.robot import BasePose, Interval, JointLimits, RigidLink
from synth.synthesis.shapes import Postures, TargetsSeen
from synth.synthesis.shapes.category_offsets import category_offsets, category_slopes
from synth.synthesis.shapes.overlaps import overlaps
from synth.synthesis.shapes.shapes import Shapes, in_equal_arcs, into_limits
from synth.synthesis.starts.refined import relative_weights
from synth.synthesis.starts.refinement import cleared, refine
from synth.synthesis.starts.residuals import Residuals
from synth.task import Objective, Obstacle, Topology

FREE = replace(
    ROBOT, name="rigid link to choose", rigid_link=RigidLink(Interval(0.40, 0.5), Interval(0.42, 0.48))
)
STEP = 1e-6


def nudged(shapes, unknown):
    """The shapes with one unknown more and less by STEP."""
    step = STEP * np.eye(shapes.unknowns.shape[1])[unknown]
    return tuple(Shapes(shapes.robot, shapes.unknowns + side * step) for side in (1.0, -1.0))


def change(more, less):
    return (more - less) / (2.0 * STEP)


def inside(robot, count, seed):
    """Shapes well within all limits, so that differences may go to either side."""
    drawn = Shapes.sample(robot, 8 * count, np.random.default_rng(seed))
    unknowns = np.array(drawn.unknowns[drawn.kinematics.radius > 0.1][:count])
    unknowns[:, :8] *= 0.7
    return Shapes(robot, unknowns)


@pytest.mark.parametrize("robot", [ROBOT, FREE])
def test_the_motion_of_the_links_end_is_its_derivative(robot):
    shapes = inside(robot, 20, 0)
    frame, _ = shapes.end
    for unknown in range(shapes.unknowns.shape[1]):
        more, less = nudged(shapes, unknown)
        turned = change(more.end[0], less.end[0]) @ frame.transpose(0, 2, 1)
        turn = np.stack([turned[:, 2, 1], turned[:, 0, 2], turned[:, 1, 0]], axis=-1)
        assert np.allclose(shapes.motion[:, :3, unknown], change(more.end[1], less.end[1]), atol=1e-6)
        assert np.allclose(shapes.motion[:, 3:6, unknown], turn, atol=1e-6)
        if shapes.motion.shape[1] > 6:
            circles = [np.stack(robot.end_effector_circle(*p.rigid_links), axis=-1) for p in (more, less)]
            assert np.allclose(shapes.motion[:, 6:, unknown], change(*circles), rtol=1e-6, atol=1e-5)


@pytest.mark.parametrize("robot", [ROBOT, FREE])
@pytest.mark.parametrize(
    "limits",
    [JointLimits(), ROBOT.joint_limits, JointLimits(Interval(-0.5, 0.9), Interval(2.4, 3.6))],
    ids=["free", "published", "narrow: most joints are held"],
)
def test_the_slope_is_that_of_the_squared_misses_with_the_joints_at_their_best(robot, limits):
    robot = replace(robot, joint_limits=limits)
    shapes, compared = inside(robot, 30, 1), 0

    def led(aims, shapes, theta2):
        """Postures whose joint 2 is led on to its best, and which of them are there."""
        for _ in range(40):
            residuals = Residuals(shapes, Postures.at(aims, shapes.kinematics, theta2), aims)
            step = residuals.following(np.zeros((len(theta2), shapes.motion.shape[1])))
            theta2 = np.clip(theta2 + step, limits.second.lower, limits.second.upper)
        return Postures.at(aims, shapes.kinematics, theta2), np.abs(step[:, 0]) < 1e-10

    for target in noisy(1).positions_in_base:
        aims = TargetsSeen(target[None], limits)
        here, arrived = led(aims, shapes, Postures.nearest(aims, shapes.kinematics).theta2)
        _, slope = Residuals(shapes, here, aims).normal_equations(np.ones((30, 1)))
        by_unknowns = np.einsum("nk,nku->nu", slope, shapes.motion)
        for unknown in range(shapes.unknowns.shape[1]):
            (more, sure), (less, again) = (led(aims, p, here.theta2) for p in nudged(shapes, unknown))
            # Where joint 2 is between two valleys, or joint 1 comes to its limit, there is no derivative.
            sure &= arrived & again & (np.abs(more.theta2 - less.theta2)[:, 0] < 1e-3)
            sure &= ((more.beyond == 0.0) == (less.beyond == 0.0))[:, 0]
            slopes = change(more.squared, less.squared)[sure, 0]
            assert np.allclose(2.0 * by_unknowns[sure, unknown], slopes, rtol=1e-4, atol=1e-6)
            compared += np.count_nonzero(sure)
    assert compared > 0.7 * 30 * len(noisy(1).positions_in_base) * shapes.unknowns.shape[1]


@pytest.mark.parametrize("topology", [Topology.SPHERICAL, Topology.PUMA, Topology.SCARA, Topology.ANY])
def test_the_slopes_of_the_category_are_derivatives(topology):
    task, shapes = replace(noisy(2), topology=topology), inside(ROBOT, 10, 2)
    slopes = category_slopes(task, shapes) @ shapes.motion
    for unknown in range(9):
        more, less = (category_offsets(task, shapes) for shapes in nudged(shapes, unknown))
        assert np.allclose(slopes[:, :, unknown], change(more, less), atol=1e-6)


@pytest.mark.parametrize("robot", [ROBOT, FREE])
def test_free_directions_lead_along_limits_and_not_beyond(robot):
    rng = np.random.default_rng(0)
    drawn = Shapes.sample(robot, 400, rng).unknowns
    stretched = np.array(drawn)
    stretched[:, :8] *= rng.uniform(1.0, 4.0, (400, 1))
    stretched[:, 8:] += rng.normal(scale=0.1, size=stretched[:, 8:].shape)
    shapes = Shapes(robot, into_limits(robot, stretched))
    slope = rng.normal(size=shapes.unknowns.shape)
    free = shapes.free_directions(slope)
    assert np.allclose(free, free.transpose(0, 2, 1))
    assert np.allclose(free @ free, free, atol=1e-9)
    downhill = -(free @ slope[..., None])[..., 0]
    assert (np.einsum("ni,ni->n", downhill, slope) <= 1e-12).all()
    held = np.trace(free, axis1=1, axis2=2) < shapes.unknowns.shape[1] - 0.5
    assert 50 < np.count_nonzero(held) < 400
    # A small step oversteps the limits of the link by no more than its square.
    size = 1e-4
    step = downhill[:, :9] * size / np.linalg.norm(downhill, axis=1, keepdims=True)
    moved = np.array(shapes.unknowns)
    moved[:, :9] += step
    assert np.abs(into_limits(robot, moved)[:, :9] - moved[:, :9]).max() < 10.0 * size**2


@pytest.mark.parametrize("seed", range(4))
def test_shapes_near_an_exact_answer_arrive_there(seed):
    task, arm = planted_task(seed, 6)
    task = replace(task, floor=None)
    here = Shapes.of(in_equal_arcs(arm))
    rng = np.random.default_rng(seed)
    around = into_limits(ROBOT, here.unknowns + 0.05 * rng.normal(size=(30, 9)) * np.append(np.ones(8), 0.05))
    refined = refine(task, Shapes(ROBOT, around))
    assert np.median(np.sqrt(refined.cost)) < 1e-6
    assert (into_limits(ROBOT, refined.shapes.unknowns) == refined.shapes.unknowns).all()


@pytest.mark.parametrize("robot", [ROBOT, FREE])
@pytest.mark.parametrize("objective", list(Objective))
def test_costs_are_those_of_forward_kinematics_and_become_less(robot, objective):
    task = noisy(3, robot=robot, objective=objective)
    shapes = Shapes.sample(robot, 60, np.random.default_rng(3))
    refined = refine(task, shapes)
    aims = TargetsSeen(task.positions_in_base, robot.joint_limits)
    before = Postures.nearest(aims, shapes.kinematics).squared @ relative_weights(task)
    after = np.empty(60)
    for index in range(60):
        arm = refined.shapes.arm(index, BasePose())
        reached = arm.forward_kinematics(*refined.joints[index].T)
        squared = np.sum((reached - task.positions_in_base) ** 2, axis=-1)
        after[index] = relative_weights(task) @ squared
        least, most = (
            (squared.mean(), squared.max()) if objective is Objective.MINIMAX else [after[index]] * 2
        )
        assert least * (1.0 - 1e-9) <= refined.cost[index] <= most * (1.0 + 1e-9)
    assert np.median(after / before) < 0.5
    if objective is Objective.LEAST_SQUARES:
        assert (after <= before * (1.0 + 1e-12)).all()


def test_given_branches_are_kept():
    task = noisy(5)
    shapes = Shapes.sample(ROBOT, 20, np.random.default_rng(5))
    theta2 = np.full((20, len(task.targets)), np.pi)
    held = refine(task, shapes, theta2, iterations=1)
    assert np.abs(held.joints[..., 1] - np.pi).max() < 0.6


def test_the_parts_in_which_shapes_are_refined_do_not_matter():
    task = noisy(6, count=20)
    shapes = Shapes.sample(ROBOT, 450, np.random.default_rng(6))
    whole = refine(task, shapes, iterations=5)
    last = refine(task, shapes.take(np.arange(400, 450)), iterations=5)
    assert np.allclose(whole.cost[400:], last.cost)
    best = whole.best(10)
    assert (np.diff(best.cost) >= 0.0).all()
    assert best.cost[0] == whole.cost.min()


@pytest.mark.parametrize("objective", list(Objective))
def test_a_rigid_link_that_is_a_flat_triangle_breaks_nothing(objective):
    robot = replace(ROBOT, rigid_link=RigidLink(Interval(0.2, 0.5), Interval(0.2, 0.6)))
    unknowns = np.array(Shapes.sample(robot, 20, np.random.default_rng(9)).unknowns)
    unknowns[:, -1] = unknowns[:, -2] + robot.d34  # P3, P4 and P5 in line: P5 cannot move about axis 2
    refined = refine(noisy(9, robot=robot, objective=objective), Shapes(robot, unknowns))
    assert np.isfinite(refined.cost).all()


def test_shapes_are_moved_out_of_an_obstacle_though_only_the_rigid_link_is_in_it():
    task, arm = planted_task(11, 3)
    point = task.positions_in_base[0]
    end = arm.end_frame[1]
    joints, _ = arm.closest_joints(point)
    middle = 0.5 * (point + BasePose(yaw=float(joints[0])).to_task(end))
    thin = Obstacle("ball", Sphere(middle, 0.012))
    task = replace(task, floor=None, obstacles=(thin,))
    around = np.repeat(Shapes.of(in_equal_arcs(arm)).unknowns, 20, axis=0)
    around = into_limits(ROBOT, around + 0.05 * np.random.default_rng(0).normal(size=around.shape))
    before = refine(replace(task, obstacles=()), Shapes(ROBOT, around))
    depth = overlaps(task, before.shapes, before.joints).max(axis=1)
    after = cleared(task, before.take(np.flatnonzero(depth > 0.0)))
    now = overlaps(task, after.shapes, after.joints).max(axis=1)
    assert len(now)
    assert np.median(now) < 0.2 * np.median(depth[depth > 0.0])


def test_shapes_chosen_of_two_keep_the_ends_that_were_computed():
    one, other = (Shapes.sample(ROBOT, 6, np.random.default_rng(seed)) for seed in (0, 1))
    assert one.end[1].shape == other.end[1].shape == (6, 3)  # computed, and so kept
    chosen = one.where(np.array([True, False, True, False, False, True]), other)
    again = Shapes(ROBOT, chosen.unknowns)
    assert "end" in vars(chosen)
    for kept, fresh in zip(chosen.end, again.end, strict=True):
        assert np.allclose(kept, fresh, rtol=0.0, atol=1e-15)
