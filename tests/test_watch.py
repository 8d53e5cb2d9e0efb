"""The watch: when it is up, whom it asks and tells, and that nothing swallows what these raise."""

import math

import numpy as np
import pytest
from planted import ROBOT, noisy, planted_task, scanned
from sampled_shapes import noisy_task

from synth.synthesis import Status, solve
from synth.synthesis.check import verify_targets
from synth.synthesis.run import Run
from synth.synthesis.shapes.shapes import Shapes
from synth.synthesis.starts.refinement import refine
from synth.synthesis.whole import for_all, verified_in_time
from synth.watch import Watch


class Clock:
    """A clock that a test sets."""

    def __init__(self):
        self.now = 100.0

    def __call__(self):
        return self.now

    def fail_after(self, seconds):
        self.now += seconds
        raise ZeroDivisionError


def test_it_is_up_when_the_time_is_and_stays_so():
    clock = Clock()
    watch = Watch(2.0, clock=clock)
    clock.now += 1.5
    assert not watch.is_up()
    assert watch.remaining == pytest.approx(0.5)
    clock.now += 1.0
    assert not watch.interrupted  # nobody was told yet
    assert watch.is_up()
    assert watch.interrupted
    assert watch.remaining == 0.0
    assert Watch().remaining == math.inf


def test_what_is_kept_back_is_there_after_the_block():
    clock = Clock()
    watch = Watch(10.0, clock=clock)
    with watch.keeping_back(0.8):
        clock.now += 2.5
        assert watch.is_up()
    assert not watch.is_up()
    assert watch.interrupted
    assert watch.remaining == pytest.approx(7.5)
    with Watch(clock=clock).keeping_back(0.5):
        assert Watch(clock=clock).remaining == math.inf


def test_a_run_aside_knows_how_much_time_is_left():
    clock = Clock()
    outer = Watch(10.0, clock=clock)
    clock.now += 4.0
    assert outer.aside().remaining == pytest.approx(6.0)


def test_a_wish_to_stop_is_asked_for_until_it_is_there():
    answers = iter([False, True])
    watch = Watch(stop=lambda: next(answers))
    assert [watch.is_up() for _ in range(3)] == [False, True, True]


def test_the_time_of_parts_is_counted_also_where_they_fail():
    clock = Clock()
    watch = Watch(clock=clock)
    with watch.on("solving"):
        clock.now += 2.0
    with pytest.raises(ZeroDivisionError), watch.on("solving"):
        clock.fail_after(1.0)
    clock.now += 4.0
    timing = watch.timing()
    assert (timing.solving, timing.screening, timing.total) == (3.0, 0.0, 7.0)


def test_what_is_told_is_what_changed_of_what_was_told():
    told = []
    watch = Watch(report=told.append)
    watch.tell(starts=3, phase="polishing shapes")
    watch.tell(phase="proving", lower_bound=1e-3)
    assert [(one.starts, one.phase, one.lower_bound) for one in told] == [
        (3, "polishing shapes", None),
        (3, "proving", 1e-3),
    ]
    Watch().tell(starts=1)  # to nobody


def test_a_watch_within_another_is_up_with_either():
    clock, told = Clock(), []
    outer = Watch(10.0, report=told.append, clock=clock)
    outer.tell(starts=5)
    inner = outer.within(2.0)
    inner.tell(phase="proving")
    assert (told[-1].starts, told[-1].phase) == (5, "proving")
    clock.now += 3.0
    assert inner.is_up()
    assert not outer.is_up()
    later = outer.within(100.0)
    clock.now += 8.0
    assert later.is_up()


def test_a_run_aside_obeys_the_watch_and_shows_that_it_is_alive():
    clock, told = Clock(), []
    outer = Watch(10.0, report=told.append, clock=clock)
    outer.tell(phase="relaxing: floor")
    clock.now += 4.0
    inner = outer.aside()
    inner.tell(phase="polishing shapes", starts=7)
    assert [(one.phase, one.starts) for one in told] == [("relaxing: floor", 0)] * 2
    with inner.on("solving"):
        clock.now += 1.0
    assert inner.timing().total == 1.0
    assert outer.timing().solving == 0.0
    clock.now += 9.0
    assert inner.is_up()


@pytest.mark.parametrize("after", [1, 3, 15])
def test_what_a_users_question_raises_comes_through_the_solver(after):
    asked = 0

    def stop():
        nonlocal asked
        asked += 1
        if asked > after:
            raise ValueError("mine")
        return False

    task, _ = planted_task(15, 4)
    with pytest.raises(ValueError, match="mine"):
        solve(task, stop=stop)
    assert asked == after + 1  # it is not asked again after it raised
    assert solve(task).found  # and the solver of this thread still works


def test_what_a_users_report_raises_comes_through():
    def report(_):
        raise ValueError("mine")

    with pytest.raises(ValueError, match="mine"):
        solve(planted_task(15, 4)[0], progress=report)


def test_a_proof_for_which_no_time_is_left_is_said_to_be_missing():
    solution = solve(planted_task(15, 4)[0], prove=True, stop=lambda: True)
    assert solution.bound is None
    assert solution.notes == ("nothing was proven: the search was stopped before",)


def test_a_proof_that_is_stopped_says_so():
    asked = []

    def proving(progress):
        if progress.phase == "proving":
            asked.append(progress)

    task = noisy_task(5)
    solution = solve(task, alternatives=0, prove=True, stop=lambda: bool(asked), progress=proving)
    assert solution.bound.lower_bound < solution.bound.best_found
    assert solution.notes == ("the proof was stopped early: more time may prove more",)
    assert solution.status is not Status.LIMIT  # the search itself was complete


@pytest.fixture
def seconds_each(monkeypatch):
    """A clock that goes on by a second for each target that is verified."""
    clock = Clock()

    def slow(task, arm):
        clock.now += len(task.targets)
        return verify_targets(task, arm)

    monkeypatch.setattr(for_all, "verify_targets", slow)
    return clock


def test_as_many_targets_are_verified_as_there_is_time_for(seconds_each):
    task, arm = scanned(9000, noise=0.0)
    some, design = verified_in_time(task, arm, Watch(7000.0, clock=seconds_each))
    check = design.verification
    assert len(some.targets) == 4000  # 2000 to see how long one takes, then 0.8 of the 5000 s left
    assert check.unseen == 5000
    assert all(check.within_tolerance)
    assert not check.found  # whatever was seen


def test_with_time_for_all_targets_all_are_verified(seconds_each):
    task, arm = scanned(9000, noise=0.0)
    for limit in (14_000.0, math.inf):
        some, design = verified_in_time(task, arm, Watch(limit, clock=seconds_each))
        assert some is task
        assert design.verification.found


def test_a_shape_seen_with_some_targets_is_told_as_that(seconds_each):
    task, _ = scanned(9000, tolerance=20e-3)
    watch = Watch(3000.0, clock=seconds_each)
    run = Run(task, task_part(task), 0, watch, 0)
    run.search.run()
    solution = run.solution()
    assert solution.status is Status.LIMIT
    assert not solution.found
    assert len(solution.task.targets) == len(solution.best.verification.misses) < 9000
    assert f"only {len(solution.task.targets)} of 9000 targets" in solution.notes[0]


def task_part(task):
    return for_all.random_part(task, 40, 0)


def test_no_step_of_a_refinement_is_taken_after_the_time():
    steps = []

    def is_up():
        steps.append(1)
        return len(steps) == 3

    shapes = Shapes.sample(ROBOT, 50, np.random.default_rng(0))
    stopped = refine(noisy(5), shapes, is_up=is_up)
    assert len(steps) == 3
    assert (stopped.cost == refine(noisy(5), shapes, iterations=3).cost).all()
