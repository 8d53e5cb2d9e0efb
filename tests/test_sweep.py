"""Many tasks: in order, whatever fails, on any executor."""

from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import pytest
from planted import out_of_reach
from swept_tasks import QUICK, TASKS, same_answers, solved_alone

from synth.errors import InputError, SynthError
from synth.sweep import solve_many
from synth.sweep import solve_many as sweep_module
from synth.synthesis import Status, solve

ROOT = Path(__file__).parents[1]


alone = pytest.fixture(scope="module")(solved_alone)


def test_the_outcomes_are_those_of_solve_in_the_order_of_the_tasks(alone):
    told = []
    outcomes = solve_many(TASKS, progress=told.append, **QUICK)
    assert same_answers(outcomes, alone)
    assert [outcome.name for outcome in outcomes] == [task.name for task in TASKS]
    assert [(each.done, each.total, each.index) for each in told] == [(1, 3, 0), (2, 3, 1), (3, 3, 2)]
    for outcome, solution in zip(outcomes, alone, strict=True):
        assert outcome.found
        assert outcome.worst_miss == solution.best.verification.misses.max()
        assert outcome.seconds > 0.0


@pytest.mark.parametrize("method", ["spawn", "fork"])
@pytest.mark.filterwarnings("ignore:.*is multi-threaded")
def test_processes_give_the_same_answers(alone, method):
    with ProcessPoolExecutor(2, get_context(method)) as pool:
        assert same_answers(solve_many(TASKS, executor=pool, **QUICK), alone)


def test_threads_and_chunks_give_the_same_answers(alone):
    with ThreadPoolExecutor(2) as pool:
        assert same_answers(solve_many(TASKS, executor=pool, chunksize=2, **QUICK), alone)


def test_what_fails_is_a_result(tmp_path):
    wrong = {"synth": 1, "length_unit": "mm", "robot": "malleable-2dof", "targets": []}
    outcomes = solve_many([TASKS[0], wrong, tmp_path / "none.yaml", out_of_reach(2), 3], **QUICK)
    assert [outcome.solved for outcome in outcomes] == [True, False, False, True, False]
    assert [outcome.wrong_input for outcome in outcomes] == [False, True, True, False, True]
    assert outcomes[3].status is Status.PROVEN_IMPOSSIBLE
    assert "no such file" in outcomes[2].error
    assert outcomes[1].status is Status.FAILED
    with pytest.raises(SynthError, match="targets"):
        _ = outcomes[1].solution


def test_a_task_that_breaks_is_a_result_and_the_others_go_on(monkeypatch):
    def broken(task, **_):
        if task is TASKS[0]:
            raise ZeroDivisionError("by zero")
        return solve(task, **QUICK)

    monkeypatch.setattr("synth.sweep.worker.solve", broken)
    first, second = solve_many(TASKS[:2])
    assert first.error == "by zero (ZeroDivisionError)"
    assert not first.wrong_input
    assert second.found


class Breaking(Executor):
    """An executor whose workers are killed, and which then takes nothing more."""

    def __init__(self):
        self.submitted = 0

    def submit(self, *_):
        self.submitted += 1
        if self.submitted > 1:
            raise BrokenExecutor("the pool is broken")
        future = Future()
        future.set_exception(BrokenExecutor("a worker was killed"))
        return future


def test_a_worker_that_breaks_down_is_a_result():
    outcomes = solve_many(TASKS, executor=Breaking())
    assert [outcome.error for outcome in outcomes] == [
        "the worker broke down: a worker was killed (BrokenExecutor)",
        *["the worker broke down: the pool is broken (BrokenExecutor)"] * 2,
    ]


def test_what_was_not_begun_is_given_up_on_request():
    asked = iter([False, True, True, True])
    outcomes = solve_many(TASKS, stop=lambda: next(asked), alternatives=0)
    assert not outcomes[-1].solved
    assert "stopped before" in outcomes[-1].error


def test_wrong_arguments_are_refused_at_once():
    with pytest.raises(InputError) as caught:
        solve_many(TASKS, executor=3, chunksize=0)
    assert [mistake.key for mistake in caught.value.mistakes] == ["executor", "chunksize"]


def count_solves(monkeypatch):
    solved = []
    worker = sweep_module.__globals__["solved_chunk"]

    def counted(tasks, *rest, **options):
        solved.extend(task.name for task in tasks)
        return worker(tasks, *rest, **options)

    monkeypatch.setitem(sweep_module.__globals__, "solved_chunk", counted)
    return solved


def test_a_task_given_twice_is_solved_once(monkeypatch):
    solved = count_solves(monkeypatch)
    outcomes = solve_many([TASKS[0], TASKS[1], TASKS[0]], **QUICK)
    assert solved == [TASKS[0].name, TASKS[1].name]
    assert outcomes[0] is outcomes[2]
