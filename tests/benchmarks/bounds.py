"""How near the proof comes to the best shape found, and whether any shape contradicts it.

    python tests/benchmarks/bounds.py [--tasks 50] [--seeds 2] [--limit 60] [--cpu] [--samples 100000]

Tasks of 4 to 8 planted targets, moved by 10 to 30 mm of noise. Times are of this machine; with `--cpu` they
are processor time, for a machine that has other work.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

from planted import ROBOT
from sampled_shapes import contradictions, noisy_task, shapes_about, task_about

from synth.synthesis import Design, solve, verify
from synth.synthesis.proving import Certifier
from synth.watch import Watch

GOALS = ((10.0, 0.5e-3), (60.0, 0.1e-3))  # s, m
ROUNDING = 1e-9  # m


def worst(task, design):
    """Return the worst weighted miss of a design, m."""
    return float(np.max(design.verification.misses * task.tolerances.min() / task.tolerances))


def outcome(seed, clock, seeds, limit):
    """Return the bound of a task, the gaps at the times of the goals, and the least miss ever found, m."""
    task = noisy_task(seed)
    designs = [design for other in range(seeds) for design in solve(task, seed=other).designs]
    ever = min(worst(task, design) for design in designs)
    kept, told = list(solve(task).designs), [(0.0, min(worst(task, d) for d in designs), 0.0)]
    began = clock()

    def keep(arm, joints):
        design = Design(arm, verify(task, arm, joints))
        if design.verification.possible:
            kept.append(design)
        return design

    def tell(now):
        if now.lower_bound is not None:
            told.append((clock() - began, now.worst_miss, now.lower_bound))

    certifier = Certifier(
        task,
        float(task.tolerances.min()),
        kept,
        keep,
        Watch(limit, report=tell, clock=clock),
        0,
    )
    bound = certifier.certificate()
    took = clock() - began
    told.append((took, bound.best_found, bound.lower_bound))
    gaps = [next(best - low for at, best, low in reversed(told) if at <= time_) for time_, _ in GOALS]
    return len(task.targets), bound, gaps, min(ever, *(worst(task, design) for design in kept)), took


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tasks", type=int, default=50)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--limit", type=float, default=60.0)
    parser.add_argument("--cpu", action="store_true")
    parser.add_argument("--samples", type=int, default=0)
    arguments = parser.parse_args()
    clock = time.process_time if arguments.cpu else time.perf_counter
    reached, false_ = np.zeros(len(GOALS), dtype=int), 0
    for seed in range(arguments.first, arguments.first + arguments.tasks):
        count, bound, gaps, ever, took = outcome(seed, clock, arguments.seeds, arguments.limit)
        wrong = ever < bound.lower_bound - ROUNDING
        false_ += wrong
        reached += [gap <= goal + ROUNDING for gap, (_, goal) in zip(gaps, GOALS, strict=True)]
        print(
            f"{seed:>3}: {count} targets, best {1e3 * bound.best_found:7.3f} mm, proven "
            f"{1e3 * bound.lower_bound:7.3f} mm, gap after 10 s {1e3 * gaps[0]:6.3f}, after 60 s "
            f"{1e3 * gaps[1]:6.3f} mm; {bound.boxes} boxes, {took:.1f} s"
            + (" CONTRADICTED" if wrong else ""),
            flush=True,
        )
    for number, (time_, goal) in zip(reached, GOALS, strict=True):
        print(f"within {1e3 * goal:.1f} mm after {time_:.0f} s: {number} of {arguments.tasks}")
    print(f"contradicted by a shape that was found: {false_}")
    if arguments.samples:
        wrong = asked = seed = 0
        while asked < arguments.samples:
            rng = np.random.default_rng([seed, 3])
            shapes = shapes_about(ROBOT, 1500, rng)
            task = task_about(shapes, int(rng.integers(1, 9)), rng)
            more, of, _ = contradictions(task, shapes, rng)
            wrong, asked, seed = wrong + more, asked + of, seed + 1
        print(f"contradicted by a sampled shape: {wrong} of {asked}")


if __name__ == "__main__":
    main()
