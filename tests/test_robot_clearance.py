import numpy as np
import pytest
from oracle import SPACING, OracleArm
from planted import ROBOT, planted_arm

from synth.geometry import Box, Capsule, Sphere
from synth.robot import Arm, ArmBody, LinkShape, clear_of_obstacles, clear_of_tube, tube_clear_of_itself

CLOSE = 3e-5  # what the bound gives away, m


def scene(seed: int):
    rng = np.random.default_rng(seed)
    limits = ROBOT.joint_limits
    joints = np.column_stack(
        [
            rng.uniform(limits.base.lower, limits.base.upper, 3),
            rng.uniform(limits.second.lower, limits.second.upper, 3),
        ]
    )
    solids = [
        Box(rng.uniform(-0.6, 0.6, 3), rng.uniform(0.05, 0.4, 3), rng.uniform(0, 6)),
        Capsule(rng.uniform(-0.6, 0.6, (2, 3)), 0.05),
        Sphere(rng.uniform(-0.6, 0.6, 3), 0.1),
    ]
    return planted_arm(rng), joints, solids


@pytest.mark.parametrize("seed", range(12))
def test_clearance_is_the_least_along_the_curve(seed):
    arm, joints, solids = scene(seed)
    bounds = clear_of_obstacles(ArmBody(arm), joints, solids)
    assert bounds.shape == (3, 3, 2)
    for pair, joint in zip(bounds, joints, strict=True):
        for bound, solid in zip(pair, solids, strict=True):
            brute = OracleArm.of(arm).clearance(joint[None], [solid])
            assert min(bound) <= brute
            assert min(bound) >= min(brute - 0.5 * SPACING, 0.1) - CLOSE


@pytest.mark.parametrize("seed", range(6))
def test_on_the_way_it_is_the_least_of_all_joint_angles_between(seed):
    arm, joints, solids = scene(seed)
    start, end = joints[:1], joints[:1] + [[0.3, -0.2]]
    bounds = clear_of_obstacles(ArmBody(arm), start, solids, end=end)[0]
    steps = start + np.linspace(0, 1, 60)[:, None] * (end - start)
    at_steps = clear_of_obstacles(ArmBody(arm), steps, solids).min(axis=0)
    assert ((bounds == -np.inf) == (at_steps < 0)).all()
    clear = at_steps >= 0
    assert (bounds[clear] <= at_steps[clear] + CLOSE).all()
    assert bounds[clear] == pytest.approx(at_steps[clear], abs=5e-3)


def test_on_the_way_the_rod_may_meet_the_tube():
    body = ArmBody(curled(0.0))
    way = clear_of_tube(body, np.array([0.5 * np.pi, 0.5 * np.pi]), np.array([np.pi, 0.0]))
    assert way[0] == pytest.approx(0.02)
    assert way[1] == -np.inf


def test_the_lowest_point_is_the_tubes_not_the_centrelines():
    arm = planted_arm(np.random.default_rng(3))
    s = np.linspace(0.025, arm.shape.length, 20_000)
    lowest = (arm.robot.d12 + arm.shape.point_at(s)[:, 2]).min() - 0.025
    assert ArmBody(arm).lowest() == pytest.approx(lowest, abs=1e-7)


def curled(turn: float) -> Arm:
    """Return an arm whose link is a circle in the plane y = 0 through `turn` rad, then straight."""
    bent = turn * 0.11
    shape = LinkShape(np.array([[1 / 0.11, 0.0], [0.0, 0.0]]), np.array([bent, 0.7 - bent]))
    return Arm(ROBOT, shape, 0.455, 0.46)


def test_a_loop_meets_itself():
    """The link turns right round and runs on beside its own start: the tube is in itself by its diameter."""
    assert tube_clear_of_itself(ArmBody(curled(6.0))) < -0.02
    assert tube_clear_of_itself(ArmBody(curled(3.0))) == pytest.approx(0.02)


def test_the_rod_folded_onto_the_link_meets_it():
    body = ArmBody(curled(0.0))
    clearances = clear_of_tube(body, np.array([0.0, 0.5 * np.pi, np.pi]))
    # Folded back, the rod is inside the tube or beside it by what P5's circle is off the link's end.
    offset, _ = ROBOT.end_effector_circle(0.455, 0.46)
    joint = 0.05 * abs(offset) / body.rod_length
    assert clearances[0] == pytest.approx(max(joint - 0.025, -0.025), abs=1e-3)
    assert clearances[1] == pytest.approx(0.02)
    assert clearances[2] == pytest.approx(0.02)
