"""How often `solve` finds planted arms with obstacles in the way, and how long it takes with and without.

    python tests/benchmarks/obstacles.py [--tasks 100] [--workers 2]

Walls with a window, shelves and crates in turn, 2 to 6 targets each. The clearance of what was found is
looked at again by brute force, at points half a millimetre apart.
"""

from __future__ import annotations

import argparse
import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

from oracle import OracleArm
from planted_obstacles import SCENES, planted_with_obstacles, without_obstacles

from synth.synthesis import solve


def outcome(number: int) -> tuple[str, str, float, float, float]:
    """Return scene, status, least clearance (m), and the times with and without obstacles (s) of one task."""
    scene = list(SCENES)[number % len(SCENES)]
    task, _, _ = planted_with_obstacles(scene, number)
    solution, free = solve(task), solve(without_obstacles(task))
    clearance = np.inf
    if solution.designs:
        joints = np.array([target.joints for target in solution.targets])
        clearance = OracleArm.of(solution.robot).clearance(joints, [each.solid for each in task.obstacles])
    return f"{scene} {number}", solution.status.value, clearance, solution.time.total, free.time.total


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tasks", type=int, default=100)
    parser.add_argument("--workers", type=int, default=2)
    arguments = parser.parse_args()
    with ProcessPoolExecutor(arguments.workers) as executor:
        outcomes = list(executor.map(outcome, range(arguments.tasks)))
    missing = [name for name, status, *_ in outcomes if status != "found"]
    found = np.array([numbers for _, status, *numbers in outcomes if status == "found"])
    times = np.array([numbers for _, _, _, *numbers in outcomes])
    print(f"{len(found)} of {len(outcomes)} found" + (f"; not {', '.join(missing)}" if missing else ""))
    print(f"least clearance of those found, by brute force: {1e3 * found[:, 0].min():.4f} mm")
    for name, column in (("with", times[:, 0]), ("without", times[:, 1])):
        print(f"{name} obstacles: median {np.median(column):.2f} s, 95 % {np.percentile(column, 95):.2f} s")
    print(f"with over without: median {np.median(times[:, 0] / times[:, 1]):.1f}")


if __name__ == "__main__":
    main()
