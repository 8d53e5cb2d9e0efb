"""Planted tasks whose base is free, and whose targets have a direction of arrival.

    python tests/benchmarks/places_and_directions.py [KIND [FIRST [LAST]]]

Found counts only if the oracle's kinematics agree: every miss by the joint angles told is within 0.5 mm, the
base stands where it may, and the rigid link points where it is to, within its tolerance.
"""

import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

from planted_approaches import planted_approach, pointing_of
from planted_bases import LEANING, planted_base, planted_choice

import synth

KINDS = {
    "upright": (100, lambda seed: planted_base(seed)[0]),
    "leaning": (100, lambda seed: planted_base(seed, leaning=LEANING)[0]),
    "choices": (50, planted_choice),
    "one direction, 15 deg": (100, lambda seed: planted_approach(seed, 1, np.radians(15.0))),
    "one direction, 1 deg": (100, lambda seed: planted_approach(seed, 1, np.radians(1.0))),
    "two directions, 1 deg": (100, lambda seed: planted_approach(seed, 2, np.radians(1.0))),
}


def holds(solution):
    """Whether what is found holds, by points alone."""
    task, arm = solution.task, solution.robot
    if task.places is not None and not task.places.contains(arm.base):
        return False
    for target, told in zip(task.targets, solution.targets, strict=True):
        reached = arm.forward_kinematics(*told.joints)
        if np.linalg.norm(reached - target.position) > target.tolerance + 1e-9:
            return False
        if target.approach is not None:
            cosine = float(pointing_of(arm, told.joints) @ target.approach.direction)
            if np.arccos(min(cosine, 1.0)) > target.approach.tolerance + 1e-6:
                return False
    return True


def main():
    kinds = [sys.argv[1]] if len(sys.argv) > 1 else list(KINDS)
    first, last = (int(each) for each in (sys.argv[2:4] + ["0", "1000"][len(sys.argv[2:4]) :]))
    for kind in kinds:
        count, planted = KINDS[kind]
        found, false, times, missed = 0, 0, [], []
        seeds = range(first, min(last, count))
        for seed in seeds:
            task, right = planted(seed) if kind == "choices" else (planted(seed), "")
            began = time.process_time()
            solution = synth.solve(task)
            times.append(time.process_time() - began)
            good = solution.found and holds(solution)
            if right and good:
                good = task.places.name_of(solution.robot.base) == right
            found += good
            false += solution.found and not holds(solution)
            if not good:
                missed.append(seed)
        print(
            f"{kind:>22}: {found} of {len(seeds)} found, {false} false; median {np.median(times):.2f} s, "
            f"95 % {np.quantile(times, 0.95):.2f} s of a processor; not: {missed}",
            flush=True,
        )


if __name__ == "__main__":
    main()
