"""How near `solve` comes to the best that any method ever found, on 100 noisy tasks.

    python tests/benchmarks/noisy.py [--tasks 100] [--seed 0] [--deepen SECONDS]

Each task is solved once. noisy_record.json keeps the least RMS miss of each task
that anything ever found: this command, `peers.py --write`, or, with --deepen, so many seconds a task of
compiled least squares from the best of many random shapes, from others at random, and from near the best.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

from peer_tasks import noisy_task

from synth.synthesis import solve

RECORD = Path(__file__).with_name("noisy_record.json")
NEAR = 1e-3  # as a fraction of the least RMS miss
_SCREENED, _POLISHED = 5_000, 60


def known() -> dict[int, float]:
    """Return the least RMS miss ever found of each task, by its seed, m."""
    if not RECORD.exists():
        return {}
    return {int(seed): rms for seed, rms in json.loads(RECORD.read_text())["least_rms"].items()}


def remember(found: dict[int, float]) -> None:
    """Keep what is less than the record."""
    record = known()
    for seed, rms in found.items():
        record[seed] = min(round(float(rms), 12), record.get(seed, math.inf))
    text = {"unit": "m", "least_rms": {str(seed): record[seed] for seed in sorted(record)}}
    RECORD.write_text(json.dumps(text, indent=1) + "\n")


def rms_of(solution) -> float:
    return math.sqrt(np.mean(solution.best.verification.misses**2))


def deepened(seed: int, seconds: float) -> float:
    """Return the least RMS miss that a long search finds, m."""
    import compiled_miss  # noqa: PLC0415 - numba and the peers are needed here only
    from compiled_residuals import jacobian, residuals  # noqa: PLC0415
    from peer_race import Race  # noqa: PLC0415
    from scipy.optimize import least_squares  # noqa: PLC0415

    race = Race(noisy_task(seed), 1e-9, seconds, seed=int(time.time()))
    while not race.over:
        shapes = race.starts(_SCREENED)
        costs = compiled_miss.costs(np.ascontiguousarray(shapes.T), *race.arguments)
        starts = np.concatenate([shapes[np.argsort(costs)[:_POLISHED]], shapes[:_POLISHED]])
        if math.isfinite(race.best_cost):
            steps = race.rng.normal(size=(_POLISHED, starts.shape[1])) * race.rng.choice(
                [0.05, 0.2], (_POLISHED, 1)
            )
            starts = np.concatenate([starts, race.best_x + steps * np.append(np.ones(8), 0.1)])
        for start in starts:
            answer = least_squares(residuals, start, jacobian, method="lm", args=race.arguments)
            if race.offer(answer.x, 2.0 * answer.cost):
                break
    return race.result().rms


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--tasks", type=int, default=100)
    parser.add_argument("--seed", type=int, default=0, help="seed of the search")
    parser.add_argument("--deepen", type=float, default=0.0, metavar="SECONDS")
    arguments = parser.parse_args()
    found, times = {}, []
    for seed in range(arguments.tasks):
        if arguments.deepen:
            remember({seed: deepened(seed, arguments.deepen)})
        solution = solve(noisy_task(seed), seed=arguments.seed)
        found[seed] = rms_of(solution)
        times.append(solution.time.total)
    remember(found)
    record = known()
    excess = {seed: rms / record[seed] - 1.0 for seed, rms in found.items()}
    print(
        f"{len(found)} noisy tasks: {sum(e <= NEAR for e in excess.values())} within 0.1 % of the least RMS "
        f"miss known; median {np.median(times):.2f} s, 95 % {np.percentile(times, 95):.2f} s"
    )
    for seed, more in sorted(excess.items(), key=lambda item: -item[1]):
        if more > NEAR:
            print(
                f"  seed {seed:>2}: {1e3 * found[seed]:.4f} mm, "
                f"known {1e3 * record[seed]:.4f} mm, {100 * more:+.2f} %"
            )


if __name__ == "__main__":
    main()
