"""How often the limit is named first that was taken just beyond what a planted task needs.

    python tests/benchmarks/blocked.py [--tasks 50]

Each limit in turn is made a little too tight for the planted arm; tasks that are met all the same, by another
arm, are left out and drawn anew; so are those that are met once the other limits give way a little.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from planted_blocked import BLOCKED, blocked_task

from synth.synthesis import explain
from synth.synthesis.solve import follow

STARTS = 8


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tasks", type=int, default=50)
    parser.add_argument("--first", type=int, default=0)
    arguments = parser.parse_args()
    right = named = 0
    for number in range(arguments.first, arguments.first + arguments.tasks):
        limit = list(BLOCKED)[number % len(BLOCKED)]
        seed = number
        while True:
            task = blocked_task(limit, seed, lambda task: follow(task, (), starts=STARTS).found)
            began = time.perf_counter()
            solution = explain(follow(task, (), starts=STARTS))
            if not solution.found:
                break
            seed += 1000  # the quick search had missed a shape
        found = solution.releases
        seconds = time.perf_counter() - began
        names = [release.limit for release in found]
        right += names[:1] == [limit]
        named += limit in names
        sentence = "; ".join(f"{r.sentence} ({100 * r.share:.2f} %)" for r in found)
        mark = " " if names[:1] == [limit] else "!"
        print(
            f"{mark} {number:>3} {limit:<14} {len(task.targets)} targets, {seconds:5.1f} s: {sentence}",
            flush=True,
        )
    print(f"{right} of {arguments.tasks} name the right limit first, {named} name it")


if __name__ == "__main__":
    main()
