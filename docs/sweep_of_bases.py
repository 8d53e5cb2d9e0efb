"""Where to put the base of a robot for twenty jobs: every place of a grid is tried for every job.

`python docs/sweep_of_bases.py sweep.sqlite` solves what the store does not hold yet, and writes `pictures/sweep.csv`: how
many of the jobs can be done from each place. `docs/figures.py` draws the map from it.
"""

from __future__ import annotations

import csv
import sys
from concurrent.futures import Executor, ProcessPoolExecutor
from dataclasses import replace
from multiprocessing import get_context
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

import synth

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

TABLE = Path(__file__).parent / "pictures" / "sweep.csv"
Place = tuple[float, float]
PLACES: list[Place] = [(0.2 * i, 0.2 * j) for i in range(-2, 4) for j in range(-2, 4)]  # x and y of P1, m


def jobs() -> list[synth.Task]:
    """Return twenty jobs in one cell: from a belt, past a camera, to a shelf; 5 mm at each."""
    rng = np.random.default_rng(0)
    robot = synth.load_robot("malleable-2dof")
    cell = {
        "belt": ([0.45, -0.5, 0.15], [0.75, 0.5, 0.15]),  # m
        "shelf": ([-0.6, 0.5, 0.35], [0.6, 0.75, 0.35]),
        "camera": ([0.2, 0.2, 0.7], [0.6, 0.6, 0.9]),
    }
    return [
        synth.Task(
            f"job {number}",
            robot,
            [synth.PointTarget(name, rng.uniform(*ends), tolerance=0.005) for name, ends in cell.items()],
            floor=0.0,
        )
        for number in range(1, 21)
    ]


def sweep(
    places: Sequence[Place], store: Path, executor: Executor | None = None
) -> Iterable[tuple[Place, Sequence[synth.TaskOutcome]]]:
    """Yield each place and what became of all jobs there."""
    asked = [replace(job, base=synth.BasePose([*place, 0.0])) for place in places for job in jobs()]
    outcomes = synth.solve_many(asked, executor=executor, store=store, alternatives=0)
    count = len(jobs())
    for index, place in enumerate(places):
        yield place, outcomes[index * count : (index + 1) * count]


def found(outcomes: Sequence[synth.TaskOutcome]) -> int:
    """Return how many jobs there is a shape for."""
    return sum(outcome.found for outcome in outcomes)


def counts() -> dict[Place, int]:
    """Return what the table holds: how many jobs can be done from each place."""
    with TABLE.open(encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    return {(1e-3 * float(row["x_mm"]), 1e-3 * float(row["y_mm"])): int(row["found"]) for row in rows}


def main() -> None:
    """Sweep the whole grid with two processes and write the table."""
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        rows = [
            [f"{1e3 * x:.0f}", f"{1e3 * y:.0f}", found(outcomes)]
            for (x, y), outcomes in sweep(PLACES, Path(sys.argv[1]), pool)
        ]
    with TABLE.open("w", encoding="utf-8", newline="") as stream:
        csv.writer(stream, lineterminator="\n").writerows([["x_mm", "y_mm", "found"], *rows])


if __name__ == "__main__":
    main()
