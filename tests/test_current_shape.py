"""A task may name the present shape of the link: then the operator moves it as little as possible."""

from dataclasses import replace

import numpy as np
import pytest
from planted import ROBOT, planted_arm, planted_task

from synth.errors import InputError
from synth.robot import LinkShape
from synth.synthesis import solve
from synth.task import parse_task

TASK = {
    "synth": 1,
    "length_unit": "mm",
    "robot": "malleable-2dof",
    "targets": [{"position": [400, 300, 500]}],
}


def moved(one: LinkShape, other: LinkShape) -> float:
    share = np.linspace(0, 1, 50)
    apart = one.point_at(share * one.length) - other.point_at(share * other.length)
    return float(np.sqrt(np.mean(np.sum(apart**2, axis=1))))


@pytest.mark.parametrize("seed", range(3))
def test_the_link_moves_less_than_to_the_gentlest_shape(seed):
    task, _ = planted_task(seed, 3)
    present = planted_arm(np.random.default_rng(seed)).shape
    gentlest = solve(task)
    nearest = solve(replace(task, current=present))
    assert gentlest.found
    assert nearest.found
    # The shape that a person would want otherwise may happen to be the one that moves least.
    assert moved(nearest.robot.shape, present) <= moved(gentlest.robot.shape, present)
    assert moved(nearest.robot.shape, present) < max(
        moved(one.arm.shape, present) for one in gentlest.designs
    )


def test_what_is_bent_right_already_stays_nearly_as_it_is():
    task, planted = planted_task(4, 6)
    solution = solve(replace(task, current=planted.shape))
    assert solution.found
    # Chains of equal arcs only come near the planted unequal ones.
    assert moved(solution.robot.shape, planted.shape) < 0.02


def test_arcs_are_read_in_the_unit_of_the_file():
    arcs = [{"curvature": [0.002, -0.001], "length": 300}, {"curvature": [0.0, 0.004], "length": 280.5}]
    task = parse_task(TASK | {"current": {"arcs": arcs}})
    assert task.current.curvatures == pytest.approx(np.array([[2.0, -1.0], [0.0, 4.0]]))
    assert task.current.lengths == pytest.approx(np.array([0.3, 0.2805]))


def test_markers_are_read_with_joint_1_where_it_stood():
    arm = planted_arm(np.random.default_rng(1))
    angle = np.radians(40)
    turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    p3, p4 = (1e3 * arm.axis_points[2:] @ turn.T).tolist()
    markers = {"P3": p3, "P4": p4, "joint1_deg": 40}
    task = parse_task(TASK | {"current": {"markers": markers}})
    frame, end = task.current.end_frame()
    expected_frame, expected_end = arm.shape.end_frame()
    assert end == pytest.approx(expected_end, abs=1e-8)
    assert frame[:, 0] == pytest.approx(expected_frame[:, 0], abs=1e-7)


@pytest.mark.parametrize(
    ("current", "key", "words"),
    [
        ({}, "current", "either arcs or markers"),
        ({"arcs": [], "markers": {}}, "current.arcs", ""),
        ({"arcs": [{"curvature": [0, 0]}]}, "current.arcs[0].length", "missing"),
        ({"markers": {"P3": [0, 0, 5000], "P4": [0, 49, 5000]}}, "current.markers", "this robot's link"),
        ({"makers": {}}, "current.makers", "did you mean 'markers'"),
    ],
)
def test_wrong_present_shapes_are_named(current, key, words):
    with pytest.raises(InputError) as error:
        parse_task(TASK | {"current": current})
    mistake = next(m for m in error.value.mistakes if m.key == key)
    assert words in mistake.message


def test_the_robot_is_the_one_of_the_task():
    assert parse_task(TASK).robot == ROBOT
    assert parse_task(TASK).current is None
