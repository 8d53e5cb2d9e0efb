"""How often exact synthesis finds the planted design, how exactly, and how fast.

    python tests/benchmarks/exact_designs.py [--sets 10000]

"Skew" arms are random numbers of realistic size, "prototype" arms random shapes of the published robot.
An error is that of the nearest answer: of lengths as a fraction of the arm's longest, of angles in rad.
"By rounding" counts sets whose nearest answer moves by more than 1e-9 if the targets are moved by one unit
in the last place, in one of five ways: no method can do better there. False answers miss a target by more
than 1e-6 m, by the exact distance for some hundred of them and by an upper bound of it for all.
"""

from __future__ import annotations

import argparse
import sys
import time
from dataclasses import astuple
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

from exact_targets import RADIUS, errors, half_ball, random_values, targets_of, through
from planted import planted_arm

GOAL = 1e-9
FALSE = 1e-6  # m
EXACTLY_CHECKED = 300
NUDGES = 5


def planted_designs(kind: str, sets: int, rng: np.random.Generator) -> np.ndarray:
    if kind == "prototype":
        return np.array([astuple(planted_arm(rng).invariants) for _ in range(sets)])
    return random_values(rng, sets)


def false_answers(targets, designs) -> int:
    """Return how many answers miss a target by more than FALSE."""
    bound = int(np.sum(designs.misses[designs.found] > FALSE))
    exact = sum(
        np.max(design.circle().distance(targets[index])) > FALSE
        for index in np.flatnonzero(designs.found.any(axis=-1))[:EXACTLY_CHECKED]
        for design in designs.of(index)
    )
    return bound + int(exact)


def report(kind: str, count: int, sets: int) -> None:
    rng = np.random.default_rng(0)
    planted = planted_designs(kind, sets, rng)
    if count == 4 and kind == "skew":
        planted[:, 4] = RADIUS
    radius = planted[:, 4] if count == 4 else None
    targets = targets_of(planted, count, rng)
    times = []
    for _ in range(3):
        start = time.perf_counter()
        designs = through(targets, radius)
        times.append(time.perf_counter() - start)
    found = errors(designs, planted)
    by_rounding = np.zeros(sets, dtype=bool)
    for _ in range(NUDGES):
        nudged = np.nextafter(targets, rng.choice([-np.inf, np.inf], targets.shape))
        by_rounding |= np.abs(errors(through(nudged, radius), planted) - found) > GOAL
    print(
        f"{count} targets, {kind:>9} arms: {np.sum(found <= GOAL)} of {sets} within 1e-9 "
        f"({np.sum((found > GOAL) & by_rounding)} of the others by rounding), "
        f"99.9 % {np.quantile(found, 0.999):.1e}, worst {np.max(found):.1e}; "
        f"{1e6 * min(times) / sets:.0f} us a set; {np.sum(designs.found)} answers, "
        f"{false_answers(targets, designs)} false, worst miss {np.nanmax(designs.misses):.1e} m",
        flush=True,
    )


def report_random(count: int, sets: int) -> None:
    targets = half_ball(np.random.default_rng(1), sets, count)
    start = time.perf_counter()
    designs = through(targets, RADIUS if count == 4 else None)
    elapsed = time.perf_counter() - start
    numbers = np.bincount(designs.found.sum(axis=-1))
    print(
        f"{count} targets,   random above the base: {100 * (1 - numbers[0] / sets):.1f} % have a design "
        f"({', '.join(f'{number} sets {k}' for k, number in enumerate(numbers) if number)}); "
        f"{1e6 * elapsed / sets:.0f} us a set; {false_answers(targets, designs)} false",
        flush=True,
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sets", type=int, default=10_000)
    sets = parser.parse_args().sets
    for count in (5, 4):
        for kind in ("skew", "prototype"):
            report(kind, count, sets)
        report_random(count, sets)


if __name__ == "__main__":
    main()
