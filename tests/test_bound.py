"""The bound is a theorem: no shape may contradict it, and it must be worth something."""

import json
from dataclasses import replace

import numpy as np
from planted import ROBOT, planted_task
from sampled_shapes import noisy_task

from synth.export import solution_to_json
from synth.robot import Interval, JointLimits
from synth.synthesis import Status, solve, verify
from synth.synthesis.bound import Bound, prove
from synth.watch import Watch


def ended_after(looks):
    """Return a watch that is up once it was asked so many times."""
    left = iter(range(looks))
    return Watch(stop=lambda: next(left, None) is None)


def test_a_task_that_misses_is_proven_impossible_and_the_gap_is_small():
    solution = solve(noisy_task(2), prove=True)
    bound = solution.bound
    assert solution.status is Status.PROVEN_IMPOSSIBLE
    assert bound.sentence in solution.message
    assert bound.lower_bound > 1e-3
    assert 0.0 <= bound.gap <= 1e-4 + 1e-12
    worst = min(design.verification.misses.max() for design in solution.designs)
    assert bound.lower_bound < bound.best_found <= worst
    told = json.loads(json.dumps(solution_to_json(solution)))["bound"]
    assert (told["lower_bound"], told["gap"]) == (bound.lower_bound, bound.gap)


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
