"""`synth.solve` beside seven other ways, on the same tasks, with the same model and measure of miss.

    python tests/benchmarks/peers.py [--tasks 5] [--budget 20] [--counts 4 8 16] [--write] [--bounds]

Planted tasks are to be reached (worst miss at most 1 mm), noisy ones to be missed no more than `synth` does
(RMS within 0.1 %). Every peer is stopped at once when it has done so, or when its budget is used up, and
restarts until then. On noisy tasks, where nobody knows the goal, each also runs to its own end.
--write stores tables, pictures and record; --bounds asks instead what is proven of a few tasks: by SCIP, by
Gurobi where its package is installed, and by `synth solve --prove`. The packages are those of the extra
`bench`.
"""

from __future__ import annotations

import argparse
import math
import sys
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

import compiled_miss
from compiled_link import TUBE_RADIUS, constants
from noisy import known, remember
from peer_bounds import bounds_table
from peer_methods import METHODS, NOT_AN_ARM, first_shape
from peer_pictures import draw
from peer_race import CLOCKS, REACHED, Race, Result, warmed_up
from peer_report import Outcome, Report, write, write_bounds
from peer_tasks import noisy_task
from planted import planted_task

from synth.synthesis import solve
from synth.synthesis.shapes.shapes import Shapes
from synth.synthesis.solve import follow

if TYPE_CHECKING:
    from collections.abc import Callable

    from synth.synthesis import Solution
    from synth.task import Task

SYNTH, FIRST = "`synth.solve`", "the same, stopped when found"
FLOOR = "floor: the answer itself, polished again"
KIN = {SYNTH: SYNTH, FIRST: "that stopped when found", FLOOR: "the floor"}
SAME_MODEL = 1e-9  # m
NOISY = 0  # in place of a number of planted targets


def task_of(kind: int, seed: int) -> Task:
    return noisy_task(seed) if kind == NOISY else planted_task(seed, kind)[0]


def model_difference(task: Task, count: int = 20) -> float:
    """Return by how much the compiled misses of random shapes differ from those of `synth`, m.

    The links are in nothing's way here: how thick ones keep clear, the independent check judges.
    """
    shapes = Shapes.sample(task.robot, count, np.random.default_rng(0))
    targets = np.ascontiguousarray(task.positions_in_base)
    known_to_them = constants(task)
    known_to_them[TUBE_RADIUS] = -0.5
    return max(
        np.abs(
            compiled_miss.misses(np.array(shapes.unknowns[i]), known_to_them, targets)
            - shapes.arm(i, task.base).closest_joints(task.positions_in_base)[1]
        ).max()
        for i in range(count)
    )


def by_synth(task: Task, kind: int, clock: str) -> tuple[Result, Result]:
    """Return what `synth` reaches, on noisy tasks the goal of the others, and what the answer costs if known.

    The second is the floor: its best shape polished and verified once more, from where it is.
    """

    def timed(run: Callable[[], Solution]) -> tuple[Result, Solution]:
        began = CLOCKS[clock]()
        solution = run()
        seconds = CLOCKS[clock]() - began
        misses = solution.best.verification.misses
        worst = float(misses.max())
        reached = kind == NOISY or worst <= REACHED
        return Result(math.sqrt(np.mean(misses**2)), worst, seconds, reached=reached), solution

    result, solution = timed(lambda: solve(task))
    return result, timed(lambda: follow(task, solution.designs[:1]))[0]


def outcome(job: tuple[int, int], budget: float, clock: str) -> Outcome:
    """Let every method do one task."""
    kind, seed = job
    task = task_of(kind, seed)
    warmed_up(task)
    by_synth(task, kind, clock)  # builds the programs, as what the others call is compiled before
    whole, floor = by_synth(task, kind, clock)
    # A noisy task is never found, so `synth` does not stop there.
    results = {SYNTH: whole, FIRST: whole, FLOOR: floor}
    goal = whole.rms if kind == NOISY else None
    if kind != NOISY:
        race = Race(task, None, budget, seed, clock)
        first_shape(race)
        results[FIRST] = race.result()
    untold = dict(results)
    for name, method in METHODS.items():
        for told, into in ((True, results), (False, untold)):
            if told or kind == NOISY:
                race = Race(task, goal, budget, seed, clock, told)
                method(race)
                into[name] = race.result()
    return Outcome(kind, seed, len(task.targets), results, untold)


def least_rms(outcomes: list[Outcome]) -> dict[int, float]:
    """Return the least RMS miss of each noisy task that an arm has reached, here or ever before, m."""
    least = known()
    for done in outcomes:
        if done.kind == NOISY:
            found = [result.rms for name, result in done.results.items() if name not in NOT_AN_ARM]
            least[done.seed] = min(*found, least.get(done.seed, math.inf))
    return least


def arguments_given() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--tasks", type=int, default=5, help="tasks of each kind")
    parser.add_argument("--budget", type=float, default=20.0, help="seconds for each method and task")
    parser.add_argument("--counts", type=int, nargs="+", default=[4, 8, 16], help="planted targets")
    parser.add_argument("--clock", choices=sorted(CLOCKS), default="wall", help="cpu: on a busy machine")
    parser.add_argument("--workers", type=int, default=1, help="tasks at a time")
    parser.add_argument("--write", action="store_true", help="store tables, pictures and record")
    parser.add_argument(
        "--bounds", type=float, nargs="?", const=100.0, metavar="SECONDS",
        help="what SCIP, Gurobi and --prove prove in so long a time each, and nothing else",
    )  # fmt: skip
    return parser.parse_args()


def main() -> None:
    arguments = arguments_given()
    if arguments.bounds:
        table = bounds_table(arguments.bounds)
        if arguments.write:
            write_bounds(table, arguments.bounds)
        return
    difference = model_difference(noisy_task(0))
    print(f"the compiled misses differ by {difference:.1e} m from those of synth")
    if difference > SAME_MODEL:
        sys.exit("so the peers would not solve the same tasks")
    jobs = [(kind, seed) for kind in [*arguments.counts, NOISY] for seed in range(arguments.tasks)]
    run = partial(outcome, budget=arguments.budget, clock=arguments.clock)
    outcomes = []
    with ProcessPoolExecutor(arguments.workers) as executor:
        for done in executor.map(run, jobs):
            outcomes.append(done)
            times = "; ".join(f"{result.time:.3f}" for result in done.results.values())
            print(f"{done.targets:>3} targets, seed {done.seed}: {times}", file=sys.stderr, flush=True)
    least = least_rms(outcomes)
    report = Report(outcomes, least, SYNTH, KIN, NOT_AN_ARM, arguments.budget)
    print(report.text())
    if arguments.write:
        remember(least)
        write(report, arguments)
        draw(report)


if __name__ == "__main__":
    main()
