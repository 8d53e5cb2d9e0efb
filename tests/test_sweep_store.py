"""A store of solutions: what is in it is not solved again, also after a kill."""

import signal
import sqlite3
import subprocess
import sys
import time
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from planted import planted_task
from swept_tasks import QUICK, TASKS, same_answers, solved_alone

from synth.errors import SynthError
from synth.sweep import solve_many
from synth.sweep import solve_many as sweep_module
from synth.sweep.store import Store, key_of

ROOT = Path(__file__).parents[1]


alone = pytest.fixture(scope="module")(solved_alone)


def count_solves(monkeypatch):
    solved = []
    worker = sweep_module.__globals__["solved_chunk"]

    def counted(tasks, *rest, **options):
        solved.extend(task.name for task in tasks)
        return worker(tasks, *rest, **options)

    monkeypatch.setitem(sweep_module.__globals__, "solved_chunk", counted)
    return solved


def test_what_is_in_the_store_is_not_solved_again(monkeypatch, tmp_path, alone):
    solved = count_solves(monkeypatch)
    store = tmp_path / "sweep.sqlite"
    first = solve_many(TASKS[:2], store=store, **QUICK)
    again = solve_many(TASKS, store=store, **QUICK)
    assert solved == [task.name for task in TASKS]
    assert [outcome.stored for outcome in again] == [True, True, False]
    assert [outcome.stored for outcome in first] == [False, False]
    assert same_answers(again, alone)
    assert again[0].solution == first[0].solution


def test_another_question_is_solved_anew():
    task = TASKS[0]
    keys = {
        key_of(task, 0, QUICK),
        key_of(task, 1, QUICK),
        key_of(task, 0, {"alternatives": 1}),
        key_of(replace(task, floor=-0.01), 0, QUICK),
        key_of(replace(task, robot=replace(task.robot, d12=0.059)), 0, QUICK),
    }
    assert len(keys) == 5
    assert key_of(replace(task), 0, dict(QUICK)) in keys


def test_another_version_is_solved_anew(monkeypatch):
    before = key_of(TASKS[0], 0, QUICK)
    monkeypatch.setattr("synth.sweep.store.__version__", "9.9.9")
    assert key_of(TASKS[0], 0, QUICK) != before


def test_rows_are_only_ever_added(tmp_path):
    store = tmp_path / "sweep.sqlite"
    first = solve_many(TASKS[:1], store=store, **QUICK)[0]
    with Store(store) as kept:
        key = key_of(TASKS[0], 0, {"alternatives": 0, "prove": False, "time_limit": np.inf})
        assert kept.find(key).text == first.text
        kept.add(key, replace(first, text="{}"), 0, QUICK)
        assert kept.find(key).text == first.text


def test_what_is_no_store_is_said(tmp_path):
    (tmp_path / "store").write_text("x" * 5000)
    with pytest.raises(SynthError, match=r"cannot keep solutions in .*store"):
        solve_many(TASKS, store=tmp_path / "store")
    with pytest.raises(SynthError, match="cannot keep solutions"):
        solve_many(TASKS, store=tmp_path / "none" / "store")


SWEEP = """
import sys
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

sys.path.insert(0, {tests!r})
from planted import planted_task
from synth.sweep import solve_many

if __name__ == "__main__":
    tasks = [planted_task(seed, 2)[0] for seed in range(30)]
    with ProcessPoolExecutor(1, get_context("spawn")) as pool:
        solve_many(tasks, executor=pool, store={store!r}, alternatives=0)
"""


def rows(store):
    # Not read-only: what a killed process left half written is rolled back on opening.
    try:
        with closing(sqlite3.connect(store)) as connection:
            return connection.execute("SELECT key, solution FROM solutions").fetchall()
    except sqlite3.Error:
        return []


def wait_until(true, seconds=120.0):
    until = time.monotonic() + seconds
    while not true():
        assert time.monotonic() < until
        time.sleep(0.05)


def test_a_sweep_that_is_killed_goes_on_where_it_was(tmp_path, monkeypatch):
    store = tmp_path / "sweep.sqlite"
    script = tmp_path / "sweep.py"
    script.write_text(SWEEP.format(tests=str(Path(__file__).parent), store=str(store)))
    process = subprocess.Popen([sys.executable, script])
    wait_until(lambda: len(rows(store)) >= 3)
    children = subprocess.run(
        ["ps", "-o", "pid=", "--ppid", str(process.pid)],  # noqa: S607
        capture_output=True,
        text=True,
        check=True,
    ).stdout.split()
    process.send_signal(signal.SIGKILL)
    process.wait()
    before = dict(rows(store))
    assert 3 <= len(before) < 30
    # Workers whose parent is gone end, too.
    wait_until(lambda: not any(Path(f"/proc/{child}/exe").exists() for child in children))
    solved = count_solves(monkeypatch)
    tasks = [planted_task(seed, 2)[0] for seed in range(len(before) + 2)]
    outcomes = solve_many(tasks, store=store, alternatives=0)
    assert all(outcome.found for outcome in outcomes)
    assert len(solved) == 2
    after = dict(rows(store))
    assert before.items() <= after.items()
    assert len(after) == len(before) + 2
