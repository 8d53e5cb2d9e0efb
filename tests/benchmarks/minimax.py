"""How near `solve` comes to the least worst miss, on the minimax version of 20 of the noisy tasks.

    python tests/benchmarks/minimax.py [--tasks 20] [--seed 0] [--restarts 30] [--prove]

Each task of `noisy.py` is solved once with `objective: minimax`. minimax_record.json keeps for each task the
least worst miss that anything ever found and the greatest lower bound that was ever proven: by this command,
by so many searches with seeds of their own (--restarts), or by `solve(prove=True)` (--prove).
The benchmark asks for the first shape and no alternatives, as `peers.py` does. Times are of this machine.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
import time
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

from peer_tasks import noisy_task

from synth.synthesis import solve
from synth.task import Objective, Task

RECORD = Path(__file__).with_name("minimax_record.json")
GOAL = 1.01  # of the bound, or of the least worst miss known


@dataclass(frozen=True)
class Known:
    """What is known of a task's worst miss, m: the least found and the greatest lower bound proven."""

    least: float = math.inf
    bound: float = 0.0

    def with_(self, other: Known) -> Known:
        return Known(min(self.least, other.least), max(self.bound, other.bound))


def known() -> dict[int, Known]:
    if not RECORD.exists():
        return {}
    tasks = json.loads(RECORD.read_text())["tasks"]
    return {int(seed): Known(entry["least"] or math.inf, entry["bound"]) for seed, entry in tasks.items()}


def remember(seed: int, more: Known) -> None:
    """Keep what is better than the record; bounds rounded down."""
    record = known()
    record[seed] = record.get(seed, Known()).with_(more)
    tasks = {
        str(key): {
            "least": round(each.least, 12) if math.isfinite(each.least) else None,
            "bound": math.floor(1e9 * each.bound) / 1e9,
        }
        for key, each in sorted(record.items())
    }
    RECORD.write_text(json.dumps({"unit": "m", "tasks": tasks}, indent=1) + "\n")


def minimax_task(seed: int) -> Task:
    return replace(noisy_task(seed), objective=Objective.MINIMAX)


def worst_of(solution) -> float:
    return float(solution.best.verification.misses.max())


def deepened(seed: int, restarts: int) -> float:
    """Return the least worst miss of searches with other seeds, m."""
    task = minimax_task(seed)
    return min(worst_of(solve(task, seed=1000 + each, alternatives=0)) for each in range(restarts))


def proven(seed: int) -> Known:
    solution = solve(minimax_task(seed), prove=True)
    bound = solution.bound
    return Known(min(worst_of(solution), bound.best_found), bound.lower_bound)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--tasks", type=int, default=20)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=0, help="seed of the search")
    parser.add_argument("--restarts", type=int, default=0, metavar="N")
    parser.add_argument("--prove", action="store_true", help="a minute a task")
    arguments = parser.parse_args()
    seeds = range(arguments.first, arguments.first + arguments.tasks)
    solve(minimax_task(999), alternatives=0)  # loads what is loaded once
    found, times, spent = {}, [], []
    for seed in seeds:
        began, processor = time.perf_counter(), time.process_time()
        found[seed] = worst_of(solve(minimax_task(seed), seed=arguments.seed, alternatives=0))
        times.append(time.perf_counter() - began)
        spent.append(time.process_time() - processor)
        remember(seed, Known(found[seed]))
        if arguments.prove:
            remember(seed, proven(seed))
        if arguments.restarts:
            remember(seed, Known(deepened(seed, arguments.restarts)))
    record, reached = known(), 0
    print("task targets      worst      bound    ratio      known    ratio  time")
    for seed, took in zip(seeds, times, strict=True):
        best = record[seed]
        over_bound = found[seed] / best.bound if best.bound else math.inf
        over_known = found[seed] / best.least
        near = min(over_bound, over_known) <= GOAL
        reached += near
        numbers = "".join(
            f" {1e3 * miss:>7.3f} mm"
            + (f" {found[seed] / miss if miss else math.inf:>8.4f}" if ratio else "")
            for miss, ratio in ((found[seed], False), (best.bound, True), (best.least, True))
        )
        count = len(minimax_task(seed).targets)
        print(f"{seed:>4} {count:>7}{numbers}  {took:.2f} s{'' if near else '  *'}")
    print(
        f"{reached} of {len(found)} within 1 % of the bound or the least known; "
        f"median {np.median(times):.2f} s, "
        f"95 % {np.percentile(times, 95):.2f} s; processor {np.median(spent):.2f} s, "
        f"{np.percentile(spent, 95):.2f} s"
    )


if __name__ == "__main__":
    main()
