"""Planted surfaces: patches of a known workspace as points, triangles and tori; noise, outliers, coverage.

    python tests/benchmarks/surfaces.py [--tasks 100] [--kinds points mesh torus]

Points: with noise of 0 and 2 mm, and 0 and 20 % outliers (then a coverage of 0.8). The tolerance asked for is
0.1 mm, or with noise 1.1 times the worst miss of the planted arm: within a tolerance it is not the least miss
that counts. A task counts if it is found and its root mean square miss, over the points that are no outliers,
is at most 0.1 mm, or with noise at most 1.05 times that of the planted arm, in one of the shapes told. Tori:
the share of the area told beside an independent count on ten times the samples. Times are of a processor.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections import defaultdict
from dataclasses import replace
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

from planted_surfaces import as_mesh, as_points, as_task, as_torus

from synth.surfaces import Scan
from synth.synthesis import solve, verify

EXACT, NEARLY = 1e-4, 1.05  # m; of the planted arm's
ROOM = 1.1  # of the planted arm's worst miss, the tolerance


def rms(arm, points) -> float:
    return float(np.sqrt(np.mean(arm.closest_joints(points)[1] ** 2)))


def of_points(seed: int, noise: float, outliers: float) -> tuple[bool, str]:
    task, planted, inliers = as_points(seed, noise=noise, outliers=outliers)
    points = task.table.positions[inliers]
    worst = float(planted.closest_joints(points)[1].max())
    task = as_points(seed, noise=noise, outliers=outliers, tolerance=max(EXACT, ROOM * worst))[0]
    solution = solve(task)
    least = min((rms(design.arm, points) for design in solution.designs), default=np.inf)
    most = max(EXACT, NEARLY * rms(planted, points) if noise else 0.0)
    told = f"{solution.status.value}, {1e3 * least:.3f} mm RMS of {1e3 * most:.3f}"
    return solution.found and least <= most, told


def of_mesh(seed: int) -> tuple[bool, str]:
    task, _ = as_mesh(seed, tolerance=5 * EXACT)  # triangles cut corners
    solution = solve(task)
    least = min((rms(design.arm, task.table.positions) for design in solution.designs), default=np.inf)
    return solution.found and least <= EXACT, f"{solution.status.value}, {1e3 * least:.3f} mm RMS"


def of_torus(seed: int) -> tuple[bool, str]:
    task = as_torus(seed)
    solution = solve(task)
    (surface,) = task.surfaces
    share = solution.best.verification.coverings[0].share
    cells = surface.cells(10 * len(surface.samples))
    points = replace(surface, shape=Scan(cells.points, cells.areas), position=np.zeros(3), rpy=np.zeros(3))
    again = verify(as_task("again", points), solution.robot).coverings[0].share
    told = f"{solution.status.value}, share {share:.4f}, by ten times the samples {again:.4f}"
    return solution.found and abs(share - again) <= 0.01, told


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--tasks", type=int, default=100)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--kinds", nargs="*", default=["points", "mesh", "torus"])
    given = parser.parse_args()
    runs = {"mesh": {"mesh": of_mesh}, "torus": {"torus": of_torus}, "points": {}}
    for noise in (0.0, 2e-3):
        for outliers in (0.0, 0.2):
            name = f"points, {1e3 * noise:.0f} mm of noise, {100 * outliers:.0f} % outliers"
            runs["points"][name] = lambda seed, n=noise, o=outliers: of_points(seed, n, o)
    counts, times = defaultdict(int), defaultdict(list)
    for seed in range(given.first, given.first + given.tasks):
        for kind in given.kinds:
            for name, run in runs[kind].items():
                began = time.process_time()
                good, told = run(seed)
                times[name].append(time.process_time() - began)
                counts[name] += good
                if not good:
                    print(f"  {name}, seed {seed}: {told}", flush=True)
    for name, spent in times.items():
        told = f"median {np.median(spent):.2f} s, at most {max(spent):.2f} s"
        print(f"{name}: {counts[name]} of {len(spent)}; {told}")


if __name__ == "__main__":
    main()
