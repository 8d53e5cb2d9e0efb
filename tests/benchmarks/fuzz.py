"""Random tasks over the whole input space, each answer judged by a second implementation, tests/oracle.py.

    python tests/benchmarks/fuzz.py [--tasks 300] [--first 0] [--workers 2] [--limit 300] [--save DIR]
                                    [--answers DIR] [--prove S] [--family points]

Other robots, free rigid links, joint ranges, places of the base, obstacles, floors, topologies, objectives,
1 to 30 targets, tolerances of 0.01 to 20 mm; in other families catalogues of rigid links, meshes, scans and
paths. Planted tasks can be done, impossible ones cannot by construction, of wild ones nobody knows. Each is
solved in a process of its own, which is ended when it takes far too long; what is at fault is printed with
its task as YAML, or put into files by --save. One task again: --numbers N. With --answers what was solved is
kept, and a second run only judges it anew; --prove looks for a lower bound of each task, too, and holds it
against every shape that is known. What cannot be drawn or judged is a fault of its own kind ("generator",
"judge").
"""

from __future__ import annotations

import argparse
import io
import json
import math
import multiprocessing
import sys
import time
import traceback
import warnings
from collections import Counter
from concurrent.futures import ThreadPoolExecutor, as_completed
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from ruamel.yaml import YAML

sys.path.insert(0, str(Path(__file__).parents[1]))

from fuzz_covered import judge_sampled
from fuzz_faults import Fault
from fuzz_judge import judge
from fuzz_sampled import FAMILIES, drawn

from synth.export import solution_to_json
from synth.guide import solution_text
from synth.synthesis import solve

if TYPE_CHECKING:
    from fuzz_drawn import FuzzTask

_DRAWING = 600.0  # s: more than drawing and judging a task take


def answered(number: int, family: str, seed: int, kept: Path | None, proof: float) -> dict:
    """Draw, solve and judge one task; return all that is counted, as plain values.

    What cannot be drawn or judged is a fault of these files, of a kind of its own, and no answer's.
    """
    outcome = _nothing_known(number)
    try:
        fuzz = drawn(number, family)
    except Exception:  # noqa: BLE001 - the generator's own fault, told as such
        return outcome | {"status": "not drawn", "faults": [_raised("generator")]}
    outcome |= {"kind": fuzz.kind, "why": fuzz.why, "tags": fuzz.tags}
    outcome |= {"targets": len(fuzz.content.get("targets", ())), "yaml": as_yaml(fuzz)}
    began, spent = time.perf_counter(), time.process_time()
    try:
        answer = _answer_of(fuzz, seed, kept and kept / f"answer-{family}-{number}-{seed}.json")
    except Exception:  # noqa: BLE001 - whatever is raised is what is looked for
        took = {"time": time.perf_counter() - began, "processor": time.process_time() - spent}
        return outcome | took | {"status": "exception", "faults": [_raised("exception")]}
    content = answer["content"]
    outcome |= {key: answer[key] for key in ("time", "processor")}
    outcome |= {"status": content["status"], "message": content["message"]}
    try:
        known = (fuzz, fuzz.read(), content, answer["text"])
        faults = judge_sampled(*known) if fuzz.fine else judge(*known, proof)
    except Exception:  # noqa: BLE001 - the judge's own fault, told as such
        faults = [_raised("judge")]
    return outcome | {"faults": [Fault("warning", words) for words in answer["warnings"]] + faults}


def _nothing_known(number: int) -> dict:
    outcome = {"number": number, "kind": "?", "why": "", "tags": [], "targets": 0, "yaml": ""}
    return outcome | {"time": math.nan, "processor": math.nan, "faults": []}


def _raised(kind: str) -> Fault:
    """Return the exception that is handled as a fault, with the line of ours that it is from."""
    told = traceback.format_exc().strip().splitlines()
    ours = ("/synth/", "/tests/")
    place = next((line.strip() for line in reversed(told) if any(part in line for part in ours)), "")
    return Fault(kind, f"{told[-1]} ({place})")


def _answer_of(fuzz: FuzzTask, seed: int, file: Path | None) -> dict:
    """Return the JSON and the text of a task's solution, what was warned of, and the time, s.

    Args:
        fuzz: The task.
        seed: Of the search.
        file: Where the answer is kept; one that is there already is not sought again.
    """
    if file is not None and file.exists():
        return json.loads(file.read_text())
    began, spent = time.perf_counter(), time.process_time()
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always")
        solution = solve(fuzz.read(), seed=seed)
        took = {"time": time.perf_counter() - began, "processor": time.process_time() - spent}
        content, text = solution_to_json(solution), solution_text(solution)
    counts = Counter(
        f"{each.category.__name__}: {each.message} ({Path(each.filename).name})" for each in warned
    )
    told = [f"{words}, {count} times" for words, count in counts.items()]
    answer = {"content": content, "text": text, "warnings": told} | took
    written = json.dumps(answer, allow_nan=False)
    if file is not None:
        file.write_text(written)
    return answer


def as_yaml(fuzz: FuzzTask) -> str:
    stream = io.StringIO()
    YAML(typ="safe").dump(fuzz.content, stream)
    return stream.getvalue()


def _send(pipe, *arguments) -> None:
    pipe.send(answered(*arguments))


def outcome_of(number: int, family: str, seed: int, limit: float, kept: Path | None, proof: float) -> dict:
    """Answer one task in a process of its own, and end it if it takes too long or dies."""
    mine, its = multiprocessing.Pipe(duplex=False)
    arguments = (its, number, family, seed, kept, proof)
    process = multiprocessing.get_context("fork").Process(target=_send, args=arguments, daemon=True)
    process.start()
    its.close()
    try:
        if mine.poll(limit + _DRAWING):
            return mine.recv()
        process.terminate()
        fault = Fault("time", f"no answer after {limit + _DRAWING:.0f} s")
    except EOFError:
        process.join()
        fault = Fault("died", f"the process died: exit code {process.exitcode}")
    finally:
        process.join(10.0)
    return _nothing_known(number) | {"status": "none", "faults": [fault]}


def report(outcomes: list[dict], limit: float) -> None:
    print(
        "\nkind         tasks  "
        + "  ".join(f"{s:>17}" for s in STATUSES)
        + "   processor time: median, 95 %, most"
    )
    for kind in sorted({outcome["kind"] for outcome in outcomes}):
        mine = [outcome for outcome in outcomes if outcome["kind"] == kind]
        counts = Counter(outcome["status"] for outcome in mine)
        times = [outcome["processor"] for outcome in mine if not math.isnan(outcome["processor"])]
        cells = "  ".join(f"{counts[status]:>17}" for status in STATUSES)
        print(
            f"{kind:<12} {len(mine):>5}  {cells}  {np.median(times or [math.nan]):>5.2f} s "
            f"{np.percentile(times or [math.nan], 95):>5.1f} s {max(times, default=math.nan):>5.1f} s"
        )
    faults = [(outcome, Fault(*fault)) for outcome in outcomes for fault in outcome["faults"]]
    by_kind = Counter(fault.kind for _, fault in faults)
    tasks = {kind: len({o["number"] for o, f in faults if f.kind == kind}) for kind in by_kind}
    planted = [outcome for outcome in outcomes if outcome["kind"] == "planted"]
    found = sum(outcome["status"] == "found" for outcome in planted)
    slow = sum(outcome["time"] > limit for outcome in outcomes)
    print(f"\nplanted: {found} of {len(planted)} found; {slow} tasks took over {limit:.0f} s")
    print(
        "faults: "
        + (", ".join(f"{n} {kind} in {tasks[kind]} tasks" for kind, n in by_kind.most_common()) or "none")
    )
    for outcome, fault in sorted(faults, key=lambda each: (each[1].kind, each[0]["number"])):
        tags = ", ".join(outcome["tags"] + [outcome["why"]] * bool(outcome["why"]))
        print(f"  {fault.kind}: task {outcome['number']} ({outcome['kind']}; {tags}): {fault.sentence}")


STATUSES = ("found", "best_effort", "proven_impossible", "limit", "failed", "exception", "not drawn", "none")


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--tasks", type=int, default=300)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--numbers", type=int, nargs="*", help="these tasks only")
    parser.add_argument("--seed", type=int, default=0, help="seed of the search")
    parser.add_argument("--family", choices=FAMILIES, default="points")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--limit", type=float, default=300.0, metavar="S")
    parser.add_argument("--save", type=Path, metavar="DIR", help="for the tasks at fault, and outcomes.json")
    parser.add_argument(
        "--answers", type=Path, metavar="DIR", help="kept there, and only judged where they are"
    )
    parser.add_argument(
        "--prove", type=float, default=0.0, metavar="S", help="look for bounds for so long, too"
    )
    arguments = parser.parse_args()
    if arguments.answers is not None:
        arguments.answers.mkdir(parents=True, exist_ok=True)
    numbers = arguments.numbers or range(arguments.first, arguments.first + arguments.tasks)
    outcomes = []
    with ThreadPoolExecutor(arguments.workers) as executor:
        answer = partial(
            outcome_of,
            family=arguments.family,
            seed=arguments.seed,
            limit=arguments.limit,
            kept=arguments.answers,
            proof=arguments.prove,
        )
        jobs = [executor.submit(answer, number) for number in numbers]
        for done, job in enumerate(as_completed(jobs), start=1):
            outcome = job.result()
            outcomes.append(outcome)
            print(
                f"{done:>4} task {outcome['number']:>4} {outcome['kind']:<10} {outcome['status']:<17} "
                f"{outcome['time']:>6.1f} s, processor {outcome['processor']:.1f} s",
                flush=True,
            )
            for kind, sentence in outcome["faults"]:
                print(f"       {kind}: {sentence}", flush=True)
    outcomes.sort(key=lambda outcome: outcome["number"])
    report(outcomes, arguments.limit)
    for outcome in outcomes:
        serious = [fault for fault in outcome["faults"] if Fault(*fault).kind != "instructions"]
        if serious and arguments.save is None:
            print(f"\n# task {outcome['number']}: {Fault(*serious[0]).sentence}\n{outcome['yaml']}")
        elif serious:
            arguments.save.mkdir(parents=True, exist_ok=True)
            (arguments.save / f"fuzz-{outcome['number']}.yaml").write_text(outcome["yaml"])
    if arguments.save is not None:
        arguments.save.mkdir(parents=True, exist_ok=True)
        (arguments.save / "outcomes.json").write_text(json.dumps(outcomes, indent=1))


if __name__ == "__main__":
    main()
