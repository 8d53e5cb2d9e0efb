"""Solving again from the solution of a task nearby, and in several threads at once."""

import threading
from dataclasses import replace

import numpy as np
import pytest
from planted import out_of_reach, planted_task

from synth.robot import BasePose, LinkShape
from synth.synthesis import Status, solve


def moved(task, step):
    shift = np.random.default_rng(1).normal(scale=step, size=task.table.positions.shape)
    return replace(task, targets=replace(task.table, positions=task.table.positions + shift))


@pytest.fixture(scope="module")
def neighbour():
    return solve(planted_task(0, 4)[0])


def same(one, other):
    return np.array_equal(one.robot.shape.curvatures, other.robot.shape.curvatures)


def test_a_neighbour_is_found_in_one_start_and_again_alike(neighbour):
    task = moved(neighbour.task, 0.003)
    solution = solve(task, warm_start=neighbour)
    assert solution.found
    assert solution.starts == 1
    assert solution.best.verification.misses.max() < 0.5e-3
    assert same(solution, solve(task, warm_start=neighbour))


def test_a_neighbour_whose_link_is_of_finer_arcs_is_followed_too(neighbour):
    arm = neighbour.robot
    finer = LinkShape(np.repeat(arm.shape.curvatures, 3, axis=0), np.repeat(arm.shape.lengths / 3.0, 3))
    design = replace(neighbour.best, arm=replace(arm, shape=finer))
    solution = solve(moved(neighbour.task, 0.003), warm_start=replace(neighbour, designs=(design,)))
    assert solution.found
    assert solution.starts == 1


def test_targets_and_base_that_move_together_keep_the_shape(neighbour):
    task = replace(
        neighbour.task,
        base=BasePose([0.1, 0.2, 0.0]),
        targets=replace(
            neighbour.task.table, positions=neighbour.task.table.positions + np.array([0.1, 0.2, 0.0])
        ),
    )
    solution = solve(task, warm_start=neighbour)
    assert solution.starts == 1
    assert solution.found


def test_where_the_neighbour_leads_nowhere_the_whole_search_follows(neighbour):
    task = planted_task(6, 16)[0]
    solution, whole = solve(task, warm_start=neighbour), solve(task)
    assert solution.found
    assert solution.starts > whole.starts
    assert len(solution.designs) >= len(whole.designs)


def test_what_is_impossible_is_said_of_a_neighbour_too(neighbour):
    assert solve(out_of_reach(1), warm_start=neighbour).status is Status.PROVEN_IMPOSSIBLE


def test_a_neighbour_of_another_robot_is_not_followed(neighbour):
    robot = replace(neighbour.task.robot, d12=0.06)
    solution = solve(replace(neighbour.task, robot=robot), warm_start=neighbour)
    assert solution.robot.robot == robot


def test_threads_solve_alike_and_one_interrupted_solver_solves_again(neighbour):
    asked = 0

    def interrupt():
        nonlocal asked
        asked += 1
        if asked > 12:
            raise KeyboardInterrupt
        return False

    with pytest.raises(KeyboardInterrupt):
        solve(neighbour.task, stop=interrupt)
    answers = {}

    def work(index):
        answers[index] = solve(neighbour.task)

    threads = [threading.Thread(target=work, args=(index,)) for index in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(same(answer, neighbour) for answer in [*answers.values(), solve(neighbour.task)])
    assert len(answers) == 3
