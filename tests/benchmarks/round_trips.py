"""Random solutions from their files: equal to what was written, and verified again.

    python tests/benchmarks/round_trips.py [--count 500] [--first 0]

Tasks are those of `fuzz_tasks`: other robots, free rigid links, obstacles, floors, tilted questions; the runs
are whole, stopped early, proven, explained or broken off, so that every status turns up.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections import Counter
from dataclasses import replace
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from fuzz_tasks import fuzz_task, parsed

from synth.errors import InputError
from synth.export import json_bytes, solution_to_json
from synth.synthesis import Solution, Status, explain, solve

LIMIT = 4.0  # s


def random_solution(number: int) -> Solution:
    """Return what is found for a random task, in one of five ways of asking."""
    task = parsed(fuzz_task(number).content)
    match number % 5:
        case 0:
            solution = solve(task, time_limit=LIMIT)
        case 1:
            solution = solve(task, time_limit=LIMIT, alternatives=0)
        case 2:
            solution = solve(task, time_limit=0.05)
        case 3:
            solution = solve(task, time_limit=LIMIT, alternatives=0, prove=True)
        case _:
            solution = explain(solve(task, time_limit=LIMIT, alternatives=0), time_limit=LIMIT)
    if number % 50 == 7:
        broken = {"status": Status.FAILED, "breakdown": "Traceback: broken", "designs": ()}
        solution = replace(solution, **broken)
    return solution


def main() -> None:
    """Write and read random solutions, and print what became of them."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=500)
    parser.add_argument("--first", type=int, default=0)
    options = parser.parse_args()
    statuses: Counter[str] = Counter()
    with_: Counter[str] = Counter()
    times, wrong = [], []
    for number in range(options.first, options.first + options.count):
        try:
            solution = random_solution(number)
        except InputError as error:
            statuses["refused input"] += 1
            print(f"{number}: {error}", file=sys.stderr)
            continue
        text = json_bytes(solution_to_json(solution)).decode()
        began = time.perf_counter()
        try:
            again = Solution.from_json(text)
        except InputError as error:
            wrong.append(f"{number}: refused: {error}")
            continue
        times.append(time.perf_counter() - began)
        if again != solution or json.loads(text) != solution_to_json(again):
            wrong.append(f"{number}: differs")
        statuses[solution.status.value] += 1
        with_["obstacles"] += bool(solution.task.obstacles)
        with_["free rigid link"] += not solution.task.robot.rigid_link.is_fixed
        with_["releases"] += bool(solution.releases)
        with_["a bound"] += solution.bound is not None
        with_["a shape"] += bool(solution.designs)
    print(f"statuses: {dict(statuses)}; with {dict(with_)}")
    print(
        f"reading takes {1e3 * sum(times) / len(times):.0f} ms on average, {1e3 * max(times):.0f} ms at most"
    )
    print(f"{len(wrong)} of {len(times) + len(wrong)} are not what was written")
    print("\n".join(wrong))
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
