"""A sweep whose parent is killed at random times: nothing is lost, and nothing is solved twice.

    python tests/benchmarks/killed_sweeps.py [--tasks 500] [--kills 20] [--workers 1]

The sweep runs in a process of its own, which is killed with SIGKILL after a random time and started again, so
often; then it is let run to its end. Each solution that was in the store at a kill must be there unchanged at
the end, every task once; what no run told of and no store held is solved again, and counted.
"""

from __future__ import annotations

import argparse
import pickle
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from contextlib import closing
from multiprocessing import get_context
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

from planted import planted_task

from synth.sweep import SweepProgress, solve_many


def sweep(workers: int, store: Path, log: Path) -> None:
    """Solve tasks, and note in a file which ones were solved and not taken from the store."""

    def note(progress: SweepProgress) -> None:
        if not progress.outcome.stored:
            with log.open("a") as stream:
                stream.write(f"{progress.index}\n")

    planted = pickle.loads(store.with_suffix(".tasks").read_bytes())  # noqa: S301 - our own
    with ProcessPoolExecutor(workers, get_context("spawn")) as pool:
        solve_many(planted, executor=pool, store=store, progress=note, alternatives=0)


def rows(store: Path) -> dict[str, str]:
    # Not read-only: what a killed process left half written is rolled back on opening.
    with closing(sqlite3.connect(store)) as connection:
        return dict(connection.execute("SELECT key, solution FROM solutions"))


def main() -> None:
    """Kill sweeps, and print what became of them."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tasks", type=int, default=500)
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--store", type=Path)
    options = parser.parse_args()
    if options.store is not None:
        sweep(options.workers, options.store, options.store.with_suffix(".log"))
        return
    rng, began = np.random.default_rng(options.seed), time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        store = Path(folder) / "sweep.sqlite"
        tasks = [planted_task(seed, 2)[0] for seed in range(options.tasks)]
        store.with_suffix(".tasks").write_bytes(pickle.dumps(tasks))
        command = [sys.executable, __file__, "--store", str(store)]
        command += ["--workers", str(options.workers)]
        kept = 0
        for _ in range(options.kills):
            process = subprocess.Popen(command)
            time.sleep(float(rng.uniform(4.0, 18.0)))
            process.send_signal(signal.SIGKILL)
            process.wait()
            if store.exists():
                now = rows(store)
                kept = len(now)
        before = rows(store)
        subprocess.run(command, check=True)
        after = rows(store)
        lost = sum(after.get(key) != text for key, text in before.items())
        told = store.with_suffix(".log").read_text().split()
    print(f"{options.tasks} tasks, {options.kills} kills, {kept} solutions at the last one")
    print(f"{len(after)} solutions at the end, {lost} lost or changed")
    twice = len(told) - len(set(told))
    print(f"{twice} told twice as solved; {time.monotonic() - began:.0f} s")
    sys.exit(bool(lost or twice or len(after) != options.tasks))


if __name__ == "__main__":
    main()
