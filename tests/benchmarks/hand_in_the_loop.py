"""The simulated operator: what a hand, a camera and a guide make of a task.

    python tests/benchmarks/hand_in_the_loop.py [--tasks 24] [--operators 25] [--targets 3,4,5,6] [...]

A hand places the link's end 9.64 +- 2.06 mm and 4 +- 1.2 deg off. It carries a correction out with an error
of 30 to 50 % of itself, each operator with a share of its own, and a floor of 2.5 mm and 0.85 deg. The link
moves by 1.5 mm and 0.3 deg as it stiffens. A camera sees each marker with a mean error of 0.455 mm. There are
three corrections at most.

Guides, each with the same operators:

    a       placed once, joint angles for the arm measured
    b       three corrections that bring P3 and P4, as seen, to where they should be
    pose    three corrections of the whole pose of the link's end, by all markers, to that of the first shape
    check   `check` as it is
    set     the same; then base and tool are set by what was measured, within 30 mm, each 0.2 mm off

The truth is never told to a guide: it sees markers. What counts is the largest miss of all targets on the
true arm, after stiffening, with the joint angles for what was measured then.
"""

from __future__ import annotations

import argparse
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

from planted import ROBOT, planted_task

from synth.guide.loop.checking import CONFIDENCE, Verdict, best_joints, check_arm
from synth.guide.loop.settings import best_settings, with_settings
from synth.measurement import (
    MARKER_ERROR,
    Readings,
    StandingArm,
    fit_arm,
    marker_named,
    marker_positions,
    sigma_of,
)
from synth.synthesis import solve

TOLERANCE = 5e-3
SETTING_ERROR = 0.2e-3  # m, of each of the five settings
GUIDES = ("a", "b", "pose", "check")
SIGMA = sigma_of(MARKER_ERROR)
MARKERS = {
    "points": ("P1 P2 P3 P4", False),  # P1 to P4 come first in each set
    "p5": ("P1 P2 P3 P4 P5", True),
    "bars": ("P1 P2 P3 P4 P5 A2:-150 A2:150", True),
    "bars-uncalibrated": ("P1 P2 P3 P4 P5 A1:300 A2:-150 A2:150", False),
}


@dataclass
class Operator:
    """A hand with its own share of error, and its own luck."""

    seed: int
    rng: np.random.Generator = field(init=False)
    share: float = field(init=False)

    def __post_init__(self):
        self.rng = np.random.default_rng(self.seed)
        self.share = self.rng.uniform(0.3, 0.5)

    def direction(self):
        vector = self.rng.normal(size=3)
        return vector / np.linalg.norm(vector)

    def off(self, shift, turn):
        return np.concatenate([shift * self.direction(), turn * self.direction()])

    def placed(self, arm):
        shift, turn = self.rng.normal([9.64e-3, np.radians(4.0)], [2.06e-3, np.radians(1.2)])
        return arm.moved(self.off(abs(shift), abs(turn)))

    def corrected(self, arm, move):
        shift = np.hypot(self.share * np.linalg.norm(move[:3]), 2.5e-3)
        turn = np.hypot(self.share * np.linalg.norm(move[3:]), np.radians(0.85))
        return arm.moved(move + self.off(shift, turn))

    def stiffened(self, arm):
        return arm.moved(self.off(1.5e-3, np.radians(0.3)))

    def measured(self, arm, wanted, markers, calibrated):
        none = Readings(markers, np.zeros((len(markers), 3)), np.tile([arm.joint1, np.pi], (len(markers), 1)))
        seen = marker_positions(arm, none, ROBOT.tip_offset)
        seen = Readings(markers, seen + SIGMA * self.rng.normal(size=seen.shape), none.joints)
        return fit_arm(seen, wanted, ROBOT.tip_offset, SIGMA, base_calibrated=calibrated)


def pose_move(arm, wanted):
    """Return the displacement from an arm's whole end pose to another's."""
    turn = wanted.frame @ arm.frame.T
    angle = np.arccos(np.clip(0.5 * (np.trace(turn) - 1.0), -1.0, 1.0))
    axis = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
    return np.concatenate([wanted.end - arm.end, axis * 0.5 / np.sinc(angle / np.pi)])


@dataclass
class Trial:
    """What became of one operator with one guide."""

    worst: float
    corrections: int
    locked: bool = False
    promised: float = 0.0
    set_worst: float = 0.0


def trial(guide, task, designs, operator, markers, calibrated, corrections, confidence):
    planned = designs[0].verification.joints
    wanted = StandingArm.of(designs[0].arm, ROBOT.joint_limits.base.middle)
    arm = operator.placed(wanted)
    made, locked, told = 0, False, 0.0
    if guide in {"b", "pose"}:
        shown = markers[:4] if guide == "b" else markers  # P1 to P4
        for _ in range(corrections):
            made += 1
            seen = operator.measured(arm, wanted, shown, calibrated).arm
            arm = operator.corrected(arm, pose_move(seen, wanted))
    elif guide != "a":
        while True:
            fit = operator.measured(arm, wanted, markers, calibrated)
            left = corrections - made
            check = check_arm(task, designs, fit, corrections=left, confidence=confidence)
            locked, told = check.verdict is Verdict.LOCK, check.probability
            if check.verdict is not Verdict.CORRECT:
                break
            arm = operator.corrected(arm, np.concatenate([check.correction.move, check.correction.rotate]))
            made += 1
    arm = operator.stiffened(arm)
    fit = operator.measured(arm, wanted, markers, calibrated)
    joints = best_joints(fit.arm, task, planned)
    worst = float(np.linalg.norm(arm.forward(joints) - task.positions_in_base, axis=-1).max())
    if guide in {"a", "b", "pose"}:
        return Trial(worst, made)
    settings = best_settings(task, ROBOT, fit, joints)
    asked = np.array([*settings.base, settings.along, settings.radius])
    arm = with_settings(arm, asked + operator.rng.normal(size=5) * SETTING_ERROR)
    set_worst = float(
        np.linalg.norm(arm.forward(settings.outlook.joints) - task.positions_in_base, axis=-1).max()
    )
    return Trial(worst, made, locked, told, set_worst)


def of_task(arguments):
    """Return the trials of all operators on one task, by guide."""
    seed, count, operators, marker_set, limits, guides = arguments
    task, _ = planted_task(seed, count)
    task = replace(task, targets=tuple(replace(each, tolerance=TOLERANCE) for each in task.targets))
    solution = solve(task)
    if not solution.found:
        return count, {}, 0.0
    names, calibrated = MARKERS[marker_set]
    markers = tuple(marker_named(name, ROBOT) for name in names.split())
    start = time.perf_counter()
    trials = {
        guide: [
            trial(guide, task, solution.designs, Operator(1000 * seed + k), markers, calibrated, *limits)
            for k in range(operators)
        ]
        for guide in guides
    }
    return count, trials, time.perf_counter() - start


def line(name, trials):
    worst = 1e3 * np.array([t.worst for t in trials])
    locked = [t for t in trials if t.locked]
    false = sum(t.worst > TOLERANCE for t in locked)
    told = np.mean([t.promised for t in locked]) if locked else 0.0
    return (
        f"{name:<22} median {np.median(worst):5.2f}  95 % {np.quantile(worst, 0.95):6.2f}  within "
        f"{np.mean(worst <= 1e3 * TOLERANCE):4.0%}  corrections "
        f"{np.mean([t.corrections for t in trials]):.2f}  "
        f"locked {len(locked)}, of these false {false}, told {told:.3f}"
    )


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--tasks", type=int, default=24)
    parser.add_argument("--operators", type=int, default=25)
    parser.add_argument("--targets", default="3,4,5,6", help="numbers of targets, in turn")
    parser.add_argument("--markers", choices=list(MARKERS), default="bars")
    parser.add_argument("--corrections", type=int, default=3)
    parser.add_argument("--confidence", type=float, default=CONFIDENCE, help="from which on `check` locks")
    parser.add_argument("--first-seed", type=int, default=7000)
    parser.add_argument("--guides", default=",".join(GUIDES))
    parser.add_argument("--processes", type=int, default=2)
    arguments = parser.parse_args()
    guides = arguments.guides.split(",")
    counts = [int(word) for word in arguments.targets.split(",")]
    work = [
        (
            arguments.first_seed + k,
            counts[k % len(counts)],
            arguments.operators,
            arguments.markers,
            (arguments.corrections, arguments.confidence),
            guides,
        )
        for k in range(arguments.tasks)
    ]
    with ProcessPoolExecutor(arguments.processes) as pool:
        results = []
        for result in pool.map(of_task, work):
            results.append(result)
            so_far = {
                guide: [t for _, trials, _ in results for t in trials.get(guide, [])] for guide in guides
            }
            print(
                f"{len(results)} tasks",
                *(line(g, t) for g, t in so_far.items() if t),
                sep="\n",
                file=sys.stderr,
            )
    for count in [*sorted(set(counts)), 0] if len(counts) > 1 else [0]:
        some = [trials for number, trials, _ in results if trials and count in (0, number)]
        if not some:
            continue
        print(f"{len(some)} tasks of {count or arguments.targets} targets")
        for guide in guides:
            of_guide = [t for trials in some for t in trials[guide]]
            print("  " + line(guide, of_guide))
            if guide == "check":
                then = [replace(t, worst=t.set_worst, locked=False) for t in of_guide]
                print("  " + line(f"{guide}, then set", then))
    print(f"{sum(seconds for *_, seconds in results):.0f} s of trials")


if __name__ == "__main__":
    main()
