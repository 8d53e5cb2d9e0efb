"""Planted paths: 50 of 200 waypoints, 20 splines through 20, and 20 across the dead zone of joint 1.

    python tests/benchmarks/paths.py [FIRST [LAST]]

Counted are those that are found and followed; by how much P5 strays, by kinematics of its own at 30 places
between each two joint angles, against the bound that is told; and the largest step of a joint.
"""

import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

from oracle import OracleArm
from planted_paths import path_task, planted_path

import synth

KINDS = {"200 waypoints": 50, "spline": 20, "across": 20}
SHARES = np.arange(30) / 30.0


def planted(kind, seed):
    """Return a planted task of a kind; splines that leave their workspace are drawn again."""
    if kind == "200 waypoints":
        return planted_path(seed)[0]
    while True:
        task, arm = planted_path(seed, spline=kind == "spline")
        (path,) = task.paths
        dense = path.at(path.parameters(3000))
        if arm.closest_joints(dense)[1].max() < 0.9 * path.tolerance:
            break
        seed += 1000
    if kind == "spline":
        return task
    theta1 = arm.closest_joints(path.waypoints)[0][:, 0]
    middle = 0.5 * (theta1.min() + theta1.max())
    cosine, sine = np.cos(middle), np.sin(middle)  # there joint 1 is to stand at 0, where it cannot
    turned = path.waypoints @ np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    return path_task(f"across {seed}", arm.robot, replace(path, waypoints=turned))


def strays(solution):
    """Return how far P5 is off the path somewhere, m, and the largest step of a joint, rad."""
    (path,), (told,) = solution.task.paths, solution.best.verification.followed
    u = np.interp(told.lengths, path.lengths(fine := path.parameters(50_000)), fine)
    joints = told.joints[:-1, None] + SHARES[:, None] * np.diff(told.joints, axis=0)[:, None]
    along = u[:-1, None] + SHARES * np.diff(u)[:, None]
    reached = OracleArm.of(solution.robot).reached(joints.reshape(-1, 2))
    off = np.linalg.norm(reached - path.at(along.ravel()), axis=-1)
    return float(off.max()), float(np.abs(np.diff(told.joints, axis=0)).max())


def main():
    bounds = [int(each) for each in sys.argv[1:]]
    first, last = (bounds + [0, 1000][len(bounds) :])[:2]
    for kind, count in KINDS.items():
        met, ratios, steps, times, missed = 0, [], [], [], []
        seeds = range(first, min(last, count))
        for seed in seeds:
            task = planted(kind, seed)
            began = time.process_time()
            solution = synth.solve(task)
            times.append(time.process_time() - began)
            if not solution.found:
                missed.append(f"{seed} ({solution.message[:160]})")
                continue
            met += 1
            off, step = strays(solution)
            told = solution.best.verification.followed[0].largest
            assert off <= told <= task.paths[0].tolerance, (kind, seed, off, told)
            ratios.append(told / off)
            steps.append(step)
        ratio, step = (max(each, default=np.nan) for each in (ratios, steps))
        print(
            f"{kind:>14}: {met} of {len(seeds)} followed; bound over what is seen at most {ratio:.3f}; "
            f"largest step {np.degrees(step):.1f} deg; median {np.median(times):.2f} s, "
            f"95 % {np.quantile(times, 0.95):.2f} s of a processor",
            *(f"\n    not: {each}" for each in missed),
            flush=True,
        )


if __name__ == "__main__":
    main()
