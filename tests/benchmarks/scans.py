"""Scanned surfaces of 10 to 3,000 points, each with ten seeds: how many are found, and how long it takes.

    python tests/benchmarks/scans.py [--seeds 10] [--vary search | scan | both] [--counts N ...]

Points of a planted arm's workspace, 1 mm of noise, 6 mm of tolerance: a shape within it exists. The seed
is that of the search for one and the same scan, that of the scan, or both. Times are of this machine.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

from planted import scanned

from synth.synthesis import solve, verify

COUNTS = (10, 20, 50, 80, 100, 101, 150, 300, 1000, 3000)
TOLERANCE = 6e-3  # m
SCAN = 3  # the seed of the scan where only that of the search varies


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--counts", type=int, nargs="*", default=COUNTS, metavar="N")
    parser.add_argument("--vary", choices=("search", "scan", "both"), default="search")
    arguments = parser.parse_args()
    missed, every = [], []
    for count in arguments.counts:
        times = []
        for seed in range(arguments.seeds):
            scan = SCAN if arguments.vary == "search" else seed
            search = 0 if arguments.vary == "scan" else seed
            task, arm = scanned(count, seed=scan, tolerance=TOLERANCE)
            solution = solve(task, seed=search)
            times.append(solution.time.total)
            if not solution.found:
                worst = float(solution.best.verification.misses.max()) if solution.designs else np.inf
                missed.append((count, scan, search, worst, float(verify(task, arm).misses.max())))
        every += times
        lost = sum(each[0] == count for each in missed)
        print(
            f"{count:>5} points: {len(times) - lost} of {len(times)} found; median {np.median(times):.2f} s, "
            f"at most {max(times):.2f} s",
            flush=True,
        )
    for count, scan, search, worst, planted in missed:
        print(
            f"  {count} points, scan {scan}, seed {search}: worst miss {1e3 * worst:.2f} mm, "
            f"of the planted arm {1e3 * planted:.2f} mm"
        )
    print(f"{len(every) - len(missed)} of {len(every)} found; median {np.median(every):.2f} s")


if __name__ == "__main__":
    main()
