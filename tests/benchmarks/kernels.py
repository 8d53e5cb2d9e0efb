"""Whether rounding sways an answer: every worked task with many seeds, BLAS kernels and numbers of threads.

    python tests/benchmarks/kernels.py [--problems NAME ...] [--seeds 10] [--kernels NAME ...] [--threads 1 2]

OpenBLAS rounds differently with each kernel; which one it takes is fixed when Python starts, so each kernel
and number of threads is a process of its own. Those the processor cannot run are left out: that is tried.
For each problem: in how many runs its facts hold, how far the objective (the task's own) spreads, and which
runs are above the best one by more than 1e-6 of it. Shapes that meet the task are not compared by what they
miss but by how gently they bend: the spread of the bending energy is told.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

ROOT = Path(__file__).parents[2]
# Two that every x86 of the last fifteen years has, and those of the processors with AVX2 and AVX-512.
KERNELS = ("SkylakeX", "Haswell", "Sandybridge", "Nehalem")
SAME = 1e-6  # relative difference of two objectives that are one
_EXACT = 1e-12  # an objective below this is of a task that is met exactly: nothing spreads there
_TRIAL = (
    "import numpy as np; a = np.ones((64, 64)) + 64 * np.eye(64); np.linalg.svd(np.linalg.solve(a, a @ a))"
)


def environment(kernel: str, threads: int) -> dict[str, str]:
    return os.environ | {
        "OPENBLAS_CORETYPE": kernel,
        "OPENBLAS_NUM_THREADS": str(threads),
        "PYTHONPATH": os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")]),
    }


def runs(kernel: str) -> bool:
    """Whether the processor can run a kernel: without its instructions a process dies of them."""
    trial = subprocess.run(
        [sys.executable, "-c", _TRIAL], env=environment(kernel, 1), capture_output=True, check=False
    )
    return trial.returncode == 0


def solved(names: list[str], seeds: range) -> None:
    """Solve in this process, and print a line of JSON for each run."""
    from facts import broken_facts, facts_of, task_of  # noqa: PLC0415 - once the kernel is set

    import synth  # noqa: PLC0415

    for name in names:
        facts, task = facts_of(name), task_of(name)
        for seed in seeds:
            solution = synth.solve(task, seed=seed)
            run = {"problem": name, "seed": seed, "status": solution.status.value, "objective": None}
            run |= {"time": solution.time.total, "broken": broken_facts(facts, task, solution)}
            if solution.designs:
                run["objective"] = objective(task, solution.best.verification.misses)
                run["bend"] = solution.robot.shape.bending_energy
            print(json.dumps(run), flush=True)


def objective(task, misses) -> float:
    """Return the task's own norm of the misses over their tolerances."""
    weighted = task.weights * (misses / task.tolerances) ** 2
    return float(weighted.max() if task.objective.value == "minimax" else weighted.sum())


def run_all(kernel: str, threads: int, names: list[str], seeds: int) -> list[dict]:
    """Return the runs of one kernel and number of threads, from a process of its own."""
    command = [sys.executable, __file__, "--here", "--seeds", str(seeds), "--problems", *names]
    process = subprocess.Popen(command, env=environment(kernel, threads), stdout=subprocess.PIPE, text=True)
    found = []
    for line in process.stdout:
        last = json.loads(line) | {"kernel": kernel, "threads": threads}
        found.append(last)
        told = f"{last['problem']} seed {last['seed']} {kernel} x{threads}: {last['status']}"
        print(f"{told}, {last['time']:.1f} s", file=sys.stderr, flush=True)
    if process.wait():
        found.append({"problem": None, "kernel": kernel, "threads": threads, "code": process.returncode})
    return found


def summary(name: str, found: list[dict]) -> dict:
    """Return what the runs of one problem say."""
    objectives = [run["objective"] for run in found if run["objective"] is not None]
    best, worst = min(objectives, default=None), max(objectives, default=None)
    spread = 0.0 if best is None or worst < _EXACT else (worst - best) / max(best, _EXACT)
    # Of found tasks the gentler shape wins, whatever their misses: only best efforts are compared by them.
    apart = [
        run
        for run in found
        if run["status"] != "found"
        and run["objective"] is not None
        and run["objective"] > best * (1.0 + SAME) + _EXACT
    ]
    bends = [run["bend"] for run in found if run["status"] == "found"]
    return {
        "problem": name,
        "bend_spread": max(bends) / min(bends) - 1.0 if bends else None,
        "runs": len(found),
        "hold": sum(not run["broken"] for run in found),
        "statuses": Counter(run["status"] for run in found),
        "best": best,
        "worst": worst,
        "spread": spread,
        "apart": [{key: run[key] for key in ("kernel", "threads", "seed", "objective")} for run in apart],
        "broken": [
            {key: run[key] for key in ("kernel", "threads", "seed", "broken")}
            for run in found
            if run["broken"]
        ],
        "time": max(run["time"] for run in found),
    }


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    every = sorted(path.name for path in (ROOT / "problems").iterdir() if path.is_dir())
    parser.add_argument("--problems", nargs="*", default=every, choices=every, metavar="NAME")
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--kernels", nargs="*", default=KERNELS, metavar="NAME")
    parser.add_argument("--threads", type=int, nargs="*", default=[1, 2])
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument("--json", action="store_true", help="print what was found as JSON")
    parser.add_argument("--here", action="store_true", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.here:
        solved(arguments.problems, range(arguments.seeds))
        return
    kernels = [kernel for kernel in arguments.kernels if runs(kernel)]
    left_out = sorted(set(arguments.kernels) - set(kernels))
    with ThreadPoolExecutor(arguments.workers) as executor:
        jobs = [
            executor.submit(run_all, kernel, threads, arguments.problems, arguments.seeds)
            for kernel in kernels
            for threads in arguments.threads
        ]
        found = [run for job in jobs for run in job.result()]
    died = [run for run in found if run["problem"] is None]
    summaries = [
        summary(name, mine)
        for name in arguments.problems
        if (mine := [run for run in found if run["problem"] == name])
    ]
    if arguments.json:
        content = {"kernels": kernels, "left_out": left_out, "died": died, "problems": summaries}
        print(json.dumps(content, indent=1))
        return
    print(
        f"kernels: {', '.join(kernels)}"
        + (f"; not on this processor: {', '.join(left_out)}" * bool(left_out))
    )
    for each in summaries:
        statuses = ", ".join(f"{count} {status}" for status, count in each["statuses"].items())
        numbers = (
            "no shape" if each["best"] is None else f"objective {each['best']:.8g} to {each['worst']:.8g}"
        )
        print(
            f"{each['problem']:<20} facts hold {each['hold']} of {each['runs']}; {statuses}; {numbers}, "
            f"spread {each['spread']:.1e}; {len(each['apart'])} apart; at most {each['time']:.1f} s"
            + (
                ""
                if each["bend_spread"] is None
                else f"; bend of those found spreads {each['bend_spread']:.1e}"
            )
        )
        for run in each["apart"]:
            print(
                f"    seed {run['seed']}, {run['kernel']} x{run['threads']}: objective {run['objective']:.8g}"
            )
        for run in each["broken"]:
            print(f"    seed {run['seed']}, {run['kernel']} x{run['threads']}: {'; '.join(run['broken'])}")
    for run in died:
        print(f"{run['kernel']} x{run['threads']} died with exit code {run['code']}")
    hold, count = (sum(each[key] for each in summaries) for key in ("hold", "runs"))
    print(f"facts hold in {hold} of {count} runs; {sum(len(each['apart']) for each in summaries)} apart")


if __name__ == "__main__":
    main()
