"""Planted rigid links: five targets each, with a catalogue of six, and with d35 and d45 in ranges.

    python tests/benchmarks/catalogue.py [--catalogues 50] [--ranges 100]

A catalogue counts if the rigid link that was planted is chosen, with every target within 0.01 mm; ranges
count if every target is within 0.5 mm. Misses are those of the independent check. Times are of this machine.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

from planted_rigid_links import free_rigid_link, planted_rigid_link

from synth.synthesis import Solution, solve


def of_catalogue(seed: int) -> tuple[bool, Solution]:
    """Return whether the planted one of six rigid links was chosen, and the solution."""
    task, name = planted_rigid_link(seed)
    solution = solve(task)
    arm = solution.robot
    return solution.found and task.robot.name_of_rigid_link(arm.d35, arm.d45) == name, solution


def of_ranges(seed: int) -> tuple[bool, Solution]:
    """Return whether a shape and a rigid link within the ranges reach every target, and the solution."""
    solution = solve(free_rigid_link(seed))
    return solution.found, solution


def report(kind: str, outcomes: list[tuple[bool, Solution]]) -> None:
    """Print how many count, which do not, and the times."""
    times = np.percentile([solution.time.total for _, solution in outcomes], [50, 95])
    print(
        f"{kind}: {sum(right for right, _ in outcomes)} of {len(outcomes)}; "
        f"median {times[0]:.2f} s, 95 % {times[1]:.2f} s",
        flush=True,
    )
    for seed, (right, solution) in enumerate(outcomes):
        if not right:
            print(f"  seed {seed}: {solution.message}; {'; '.join(solution.notes)}", flush=True)


def main() -> None:
    """Run both kinds, one task after the other."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--catalogues", type=int, default=50)
    parser.add_argument("--ranges", type=int, default=100)
    arguments = parser.parse_args()
    for kind, outcome, count in (
        ("the right one of six rigid links", of_catalogue, arguments.catalogues),
        ("d35 and d45 in ranges", of_ranges, arguments.ranges),
    ):
        if count:
            report(kind, [outcome(seed) for seed in range(count)])


if __name__ == "__main__":
    main()
