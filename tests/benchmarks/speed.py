"""How long `solve` takes: warm, from a neighbour, from the command line, and for many targets.

    python tests/benchmarks/speed.py [--tasks 20] [--most 100000]

Times are of this machine; those of the processor are given beside those of the clock, because they do not
depend on what else runs.
"""

from __future__ import annotations

import argparse
import os
import resource
import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

from planted import planted_task, scanned

from synth.synthesis import Solution, solve

if TYPE_CHECKING:
    from collections.abc import Callable

    from synth.task import Task

ROOT = Path(__file__).parents[2]
EXAMPLE = ROOT / "problems" / "four-targets" / "task.yaml"
NEIGHBOUR_MOVES = 0.003  # m


def timed(run: Callable[[], Solution]) -> tuple[Solution, float, float]:
    """Return a solution and its time in seconds, of the clock and of the processor."""
    clock, processor = time.perf_counter(), time.process_time()
    solution = run()
    return solution, time.perf_counter() - clock, time.process_time() - processor


def report(title: str, outcomes: list[tuple[Solution, float, float]]) -> None:
    solutions, clock, processor = zip(*outcomes, strict=True)
    found = sum(solution.found for solution in solutions)
    (median, high), (median_cpu, high_cpu) = (np.percentile(t, [50, 95]) for t in (clock, processor))
    print(
        f"{title:<44} {found:>3} of {len(solutions)} found; median {median:.3f} s, 95 % {high:.3f} s; "
        f"processor {median_cpu:.3f} and {high_cpu:.3f} s",
        flush=True,
    )


def moved(task: Task, seed: int) -> Task:
    """Return a task whose targets are moved by a few millimetres."""
    step = np.random.default_rng(seed).normal(scale=NEIGHBOUR_MOVES, size=task.table.positions.shape)
    return replace(task, targets=replace(task.table, positions=task.table.positions + step))


def neighbours(count: int, tasks: int) -> None:
    """Report on tasks near found ones, with and without the neighbour's solution."""
    followed, whole = [], []
    for seed in range(tasks):
        task = replace(planted_task(seed, count)[0], floor=None)
        solution, near = solve(task), moved(task, seed)
        solve(moved(task, seed + 1000), warm_start=solution)  # builds the program
        answer = timed(lambda near=near, solution=solution: solve(near, warm_start=solution))
        (followed if answer[0].starts == 1 else whole).append(answer)
    if followed:
        report(f"{count} targets moved by {1e3 * NEIGHBOUR_MOVES:.0f} mm, warm start", followed)
    if whole:
        report("   ... where the whole search followed", whole)


def command_line(runs: int) -> None:
    """Report on the command in a fresh process; the first run, which may compile modules, is not counted."""
    command = [sys.executable, "-m", "synth", "solve", str(EXAMPLE), "--json"]
    times = []
    with tempfile.TemporaryDirectory() as cache:
        environment = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
        environment |= {"PYTHONPATH": str(ROOT), "PYTHONPYCACHEPREFIX": cache}
        for _ in range(runs + 1):
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            began = time.perf_counter()
            subprocess.run(command, check=True, capture_output=True, env=environment)
            clock = time.perf_counter() - began
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            spent = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
            times.append((clock, spent))
    clock, processor = np.median(times[1:], axis=0)
    print(f"{'command line, --json, cold':<44} median {clock:.2f} s; processor {processor:.2f} s", flush=True)


def scaling(most: int) -> None:
    """Report on the points of a scanned surface, 1 to `most` of them."""
    count = 1
    while count <= most:
        task, _ = scanned(count, tolerance=6e-3)
        _, clock, processor = answer = timed(lambda task=task: solve(task))
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        worst = 1e3 * float(answer[0].best.verification.misses.max())
        print(
            f"{count:>6} surface points: {answer[0].status.value}, worst miss {worst:.2f} mm, "
            f"{clock:.2f} s, processor {processor:.2f} s, memory at most {peak:.0f} MiB",
            flush=True,
        )
        count *= 10


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tasks", type=int, default=20)
    parser.add_argument("--most", type=int, default=100_000)
    arguments = parser.parse_args()
    for count in (1, 2, 4, 6, 8):
        solve(planted_task(999, count)[0])  # builds the program
        tasks = [planted_task(seed, count)[0] for seed in range(arguments.tasks)]
        report(f"{count} targets, warm", [timed(lambda task=task: solve(task)) for task in tasks])
    neighbours(4, arguments.tasks)
    command_line(5)
    scaling(arguments.most)


if __name__ == "__main__":
    main()
