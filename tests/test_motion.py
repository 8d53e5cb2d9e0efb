import itertools
from dataclasses import replace

import numpy as np
import pytest
from oracle import OracleArm
from planted import ROBOT, planted_task
from planted_obstacles import SCENES, planted_with_obstacles

from synth.geometry import Box
from synth.synthesis import motions, verify
from synth.synthesis.wanted.design import Design
from synth.synthesis.wanted.ways import routed
from synth.task import Obstacle


def along(way):
    steps = [a + np.linspace(0, 1, 15)[:, None] * (b - a) for a, b in itertools.pairwise(way)]
    return np.vstack(steps)


@pytest.mark.parametrize("scene", SCENES)
@pytest.mark.parametrize("seed", [2, 3])
def test_ways_keep_clear_and_within_the_limits(scene, seed):
    task, arm, joints = planted_with_obstacles(scene, seed)
    ways = motions(task, Design(arm, verify(task, arm, joints)))
    assert len(ways) == len(task.targets) - 1
    for way, target, following in zip(ways, task.targets[:-1], task.targets[1:], strict=True):
        assert (way.start, way.end) == (target.name, following.name)
        assert way.found
        assert ROBOT.joint_limits.contain(way.joints).all()
        ends = arm.forward_kinematics(*way.joints[[0, -1]].T)
        assert np.linalg.norm(ends - [target.position, following.position], axis=1).max() < target.tolerance
        solids = [obstacle.solid for obstacle in task.obstacles]
        assert OracleArm.of(arm).clearance(along(way.joints), solids) >= -2e-6


def test_each_way_begins_where_the_last_one_ended():
    task, arm = planted_task(5, 8)
    ways = motions(task, Design(arm, verify(task, arm)))
    for one, other in itertools.pairwise(ways):
        assert one.joints[-1] == pytest.approx(other.joints[0])


def test_the_long_way_round_is_said():
    task, arm = planted_task(5, 2)
    joints = np.radians([[20.0, 170.0], [340.0, 190.0]])
    points = arm.forward_kinematics(*joints.T)
    targets = tuple(replace(t, position=p) for t, p in zip(task.targets, points, strict=True))
    task = replace(task, targets=targets)
    (way,) = motions(task, Design(arm, verify(task, arm, joints)))
    assert way.found
    assert way.describe() == (
        "target 1 to target 2: joint 1 by +320.0 deg, joint 2 by +20.0 deg "
        "(the long way round: the short one is closed by the limits of joint 1)"
    )


def test_a_wall_right_round_a_target_leaves_no_way():
    task, arm = planted_task(5, 2)
    check = verify(task, arm)
    # A plate that the arm cannot pass between its two postures, above the floor and up to the sky.
    half = 0.5 * (check.joints[0, 0] + check.joints[1, 0])
    normal = np.array([np.cos(half), np.sin(half), 0.0])
    plate = Box(0.45 * normal + [0, 0, 1.0], np.array([0.6, 0.004, 2.0]), half)
    task = replace(task, obstacles=(Obstacle("plate", plate),))
    check = verify(task, arm)
    assert check.found
    # On the way the tube is in the plate whatever joint 2 does; the other way the limits of joint 1 close.
    turns = np.linspace(*check.joints[:, 0], 20)
    tube = [OracleArm.of(arm).clearances([turn, np.pi], [plate])[0, 0] for turn in turns]
    assert min(tube) < -0.02
    (way,) = motions(task, Design(arm, check))
    assert not way.found
    assert way.describe() == "target 1 to target 2: no way was found that keeps clear"


def test_without_obstacles_no_way_around_is_looked_for(monkeypatch):
    def never(*_):
        raise AssertionError

    monkeypatch.setattr("synth.synthesis.wanted.ways.shortest_path", never)
    for seed in range(5):
        task, arm = planted_task(seed, 5)
        assert len(motions(task, Design(arm, verify(task, arm)))) == 4


def test_a_way_that_the_floor_closes_is_closed_for_good():
    """Between two angles of joint 2 every way passes all others; here the rod would dip below the floor."""
    for seed in range(40):
        _, arm = planted_task(seed, 2)
        theta2 = np.linspace(1.2, 5.0, 200)
        heights = arm.forward_kinematics(2.0, theta2)[:, 2]
        lowest = int(np.argmin(heights))
        if 40 < lowest < 160:
            break
    ends = theta2[[lowest - 40, lowest + 40]]
    points = arm.forward_kinematics(np.array([2.0, 3.0]), ends)
    floor = 0.5 * (points[:, 2].min() + heights[lowest])
    assert heights[lowest] < floor - 0.01
    task, _ = planted_task(5, 2)
    targets = tuple(replace(t, position=p) for t, p in zip(task.targets, points, strict=True))
    task = replace(task, targets=targets, floor=float(floor))
    joints = np.column_stack([[2.0, 3.0], ends])
    (way,) = motions(task, Design(arm, verify(task, arm, joints)))
    assert not way.found
    (way,) = motions(replace(task, floor=None), Design(arm, verify(replace(task, floor=None), arm, joints)))
    assert way.found


def test_after_the_time_no_way_around_is_looked_for_and_straight_ones_stay():
    around = 0
    for scene, seed in itertools.product(SCENES, (2, 3)):
        task, arm, joints = planted_with_obstacles(scene, seed)
        design = Design(arm, verify(task, arm, joints))
        in_time, in_haste = routed(task, design)[0], routed(task, design, lambda: True)[0]
        assert len(in_time) == len(in_haste)
        for way in in_haste:
            assert len(way.joints) in {0, 2}
        around += sum(one.found and not other.found for one, other in zip(in_time, in_haste, strict=True))
    assert around > 0
