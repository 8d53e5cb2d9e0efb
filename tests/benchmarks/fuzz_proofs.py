"""Whether proofs are true: by what was planted, by a search of the oracle's own, and by what was found."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np
from fuzz_faults import Fault, wrongly_told
from fuzz_tasks import random_arm
from oracle import OracleArm, distance_from_solid, longest_rod
from scipy.optimize import least_squares

from synth.synthesis.bound import prove
from synth.watch import Watch

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fuzz_drawn import FuzzTask

    from synth.task import Task

_NUMBER = r"(-?\d+\.?\d*)"
_OUT_OF_REACH = (
    rf"(.+) is at least {_NUMBER} mm from wherever the malleable link can end, and the rigid link reaches "
    rf"at most {_NUMBER} mm from there: it misses by at least {_NUMBER} mm"
)
_BELOW_FLOOR = rf"(.+) is at least {_NUMBER} mm below the floor, and the end effector stays above it"
_IN_SOLID = rf"(.+) is in (.+): there the end effector would be at least {_NUMBER} mm inside"
_START_BELOW = rf"the link starts at P2, at least {_NUMBER} mm below the floor"
_START_INSIDE = rf"the link starts at P2, at least {_NUMBER} mm inside (.+)"
_NO_ARM = r"no arm with this rigid link passes exactly through such (\d+) targets, by algebra"
# What a shape would have to do that is not in the answer: nobody can judge the numbers of that.
_OF_NO_SHAPE = (
    r"no shape was found that the hardware can take",
    r"the length of \w+ would have to be .* limit",
    r"the link would need a bend radius of .* limit",
    r"the link would have to bend by .* limit",
    r"the (base|second) joint would have to turn .* deg beyond its limit",
    r"the (link|second joint|end effector) would be .* mm below the floor",
    r"the shape is not \w+, which the task asks for",
    r"at .+ the (rigid|malleable) link would be .* mm inside .+",
    r"the malleable link would be .* mm inside itself or the base",
)
_BOUND_SLACK = 1e-7  # m


def faults_of_reasons(fuzz: FuzzTask, task: Task, content) -> Iterator[Fault]:
    """Check the sentences that say why: a bound is rounded to where nothing attains it."""
    for reason in content["reasons"]:
        proven = list(_proof(fuzz, task, reason))
        yield from (fault for faults in proven for fault in faults)
        if not proven and not any(re.fullmatch(words, reason) for words in _OF_NO_SHAPE):
            yield Fault("not judged", f"a reason: {reason}")
        if not proven and content["status"] == "proven_impossible":
            yield Fault("not judged", f"no proof: {reason}")


def _proof(fuzz: FuzzTask, task: Task, reason: str) -> Iterator[list[Fault]]:
    """Yield the faults of a reason that is a proof, a list; nothing if it is none that is known."""
    indices = {name: index for index, name in enumerate(task.table.names)}
    points = task.base.to_base(task.table.positions)
    solids = {obstacle.name: obstacle.solid for obstacle in task.obstacles}
    if found := re.fullmatch(_OUT_OF_REACH, reason):
        name, *numbers = found.groups()
        yield list(_reach(task, reason, points[indices[name]], numbers))
    elif found := re.fullmatch(_BELOW_FLOOR, reason):
        depth = task.floor_in_base - points[indices[found.group(1)], 2]
        yield wrongly_told(reason, found.group(2), 1e3 * depth, "down")
    elif found := re.fullmatch(_IN_SOLID, reason):
        name, solid, number = found.groups()
        target, rod = task.table.positions[indices[name]], 0.5 * task.robot.rigid_link.diameter
        depth = rod - float(distance_from_solid(solids[solid], target))
        yield wrongly_told(reason, number, 1e3 * depth, "down")
    elif found := re.fullmatch(_START_BELOW, reason):
        yield wrongly_told(reason, found.group(1), 1e3 * (task.floor_in_base - task.robot.d12), "down")
    elif found := re.fullmatch(_START_INSIDE, reason):
        p2 = task.base.to_task(np.array([0.0, 0.0, task.robot.d12]))
        depth = -float(distance_from_solid(solids[found.group(2)], p2))
        yield wrongly_told(reason, found.group(1), 1e3 * depth, "down")
    elif found := re.fullmatch(_NO_ARM, reason):
        count = [] if int(found.group(1)) == len(points) else [Fault("untrue", reason)]
        yield count + [Fault("false proof", f"planted, but: {reason}")] * (fuzz.kind == "planted")


def _reach(task: Task, reason: str, point, numbers) -> Iterator[Fault]:
    """Check a target out of reach: how far it is from the link's end, the rigid link, the least miss."""
    away, reach, least = map(float, numbers)
    rod, nearest = 1e3 * longest_rod(task.robot), 1e3 * nearest_end(task, point)
    if least > nearest - rod + 1e-6:
        yield Fault("false proof", f"{reason}; but {nearest - rod:.6f} mm is possible")
    if reach < rod - 1e-6:
        yield Fault("false proof", f"{reason}; but the rigid link reaches {rod:.6f} mm")
    if away > nearest + 1e-6:
        yield Fault("false proof", f"{reason}; but it can be {nearest:.6f} mm")


def nearest_end(task: Task, point) -> float:
    """Return how near the link's end comes to a point of the base frame at least, by a search, m."""
    rng, link = np.random.default_rng(0), task.robot.link
    best = np.inf
    for _ in range(6):
        start = random_arm(task, rng)
        count = len(start.lengths)

        def end(x, start=start, count=count):
            curvatures = x[: 2 * count].reshape(-1, 2)
            size = np.linalg.norm(curvatures, axis=1, keepdims=True) * link.min_bend_radius
            curvatures = curvatures / np.maximum(size, 1.0)
            lengths = start.lengths * np.clip(x[-1], link.length.lower, link.length.upper) / start.length
            total = float(np.linalg.norm(curvatures, axis=1) @ lengths)
            curvatures = curvatures * min(1.0, link.max_total_bend / max(total, 1e-12))
            return OracleArm(
                task.robot, curvatures, lengths, start.d35, start.d45, start.position, start.yaw
            ).end[1]

        x = np.concatenate([0.3 * start.curvatures.ravel(), [start.length]])
        answer = least_squares(lambda x, end=end: end(x) - point, x, max_nfev=100)
        best = min(best, float(np.linalg.norm(answer.fun)))
    return best


def searched(task: Task, seed: int, broken, shapes: int = 200, polished: int = 3):
    """Return a shape that meets a task, by least squares from random shapes, or None if none is found.

    Args:
        task: The task.
        seed: Of the shapes.
        broken: Says what limits an arm breaks at joint angles.
        shapes: How many are drawn.
        polished: How many of them are led to the targets.
    """
    rng = np.random.default_rng([seed, 5])
    robot, targets = task.robot, task.table.positions

    def cost(arm, halvings):
        return (
            arm.misses(arm.closest(targets, samples=91, valleys=1, halvings=halvings), targets)
            / task.tolerances
        )

    arms = [random_arm(task, rng) for _ in range(shapes)]
    arms.sort(key=lambda arm: float(np.sum(np.minimum(cost(arm, 0), 1e6) ** 2)))
    for arm in arms[:polished]:
        count = len(arm.lengths)

        def bent(x, arm=arm, count=count):
            limit = 1.0 / robot.link.min_bend_radius
            curvatures = x[: 2 * count].reshape(-1, 2)
            size = np.linalg.norm(curvatures, axis=1, keepdims=True)
            curvatures = curvatures / np.maximum(size / limit, 1.0)
            length = np.clip(x[-3], robot.link.length.lower, robot.link.length.upper)
            d35, d45 = (
                np.clip(value, i.lower, i.upper)
                for value, i in zip(x[-2:], (robot.rigid_link.d35, robot.rigid_link.d45), strict=True)
            )
            lengths = arm.lengths * length / arm.length
            return OracleArm(robot, curvatures, lengths, float(d35), float(d45), arm.position, arm.yaw)

        start = np.concatenate([arm.curvatures.ravel(), [arm.length, arm.d35, arm.d45]])
        answer = least_squares(lambda x, bent=bent: cost(bent(x), 12), start, max_nfev=25)
        best = bent(answer.x)
        joints = best.closest(targets)
        if (best.misses(joints, targets) <= task.tolerances).all() and not broken(task, best, joints):
            return best
    return None


def faults_of_bound(fuzz: FuzzTask, task: Task, arm: OracleArm | None, joints, seconds: float) -> list[Fault]:
    """Look for a bound and hold it against the shapes that are known: none may miss by less.

    It is looked for as if nothing had been found, or a good answer would end it before it says anything.

    Args:
        fuzz: The task, and what was planted.
        task: The same as read.
        arm: The shape found, if it is legal.
        joints: Its joint angles at the targets.
        seconds: How long to look, s.
    """
    tightest = float(task.tolerances.min())
    far = np.zeros(len(task.targets))
    bound = prove(task, 10.0 * (1e-3 + tightest), far, tightest=tightest, watch=Watch(seconds))
    faults = []
    for who, which, at in (("planted", fuzz.planted, fuzz.joints), ("found", arm, joints)):
        if bound is None or which is None:
            continue
        worst = float(np.max(which.misses(at, task.table.positions) * tightest / task.tolerances))
        if bound.lower_bound > worst + _BOUND_SLACK:
            faults.append(Fault("false bound", f"{bound.lower_bound} m, but {who} misses by {worst} m"))
    return faults
