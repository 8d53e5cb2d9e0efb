"""What blocks a task that cannot be met, and what would release it: found by relaxing each limit in turn.

A limit blocks if the task is met once that limit alone is relaxed far enough; by how much is then found by
tightening it again, halving after halving, each time with a shape that is verified. So every release is
certain to do; that a smaller one would not is not certain, nor that a limit that is not named could not.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from synth.checks import refuse_unless
from synth.geometry import Box
from synth.robot import BasePose, Interval
from synth.synthesis.solution import Release, Solution
from synth.synthesis.solve import follow
from synth.synthesis.verification import verify
from synth.task import Obstacle

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from synth.arrays import FloatArray
    from synth.geometry import Solid
    from synth.robot import MalleableLink
    from synth.synthesis.solution import Design
    from synth.task import Task

# How far a limit is relaxed, as a share of the most, and how many starts are polished then.
_RELAXED = ((0.04, 8), (0.25, 8), (1.0, 6))
_RESOLUTION = 0.03  # of an amount
_NOTHING = 1e-6  # of a limit
_HALVINGS = 6
_BASE_STEPS = 12
_FARTHEST_BASE = 1.0  # m


@dataclass(frozen=True)
class _Limit:
    """A limit that can be relaxed: how far at most, and how."""

    name: str
    scale: float
    most: float
    relaxed: Callable[[float], Task]
    sentence: Callable[[float], str]


def explain(solution: Solution, *, stop: Callable[[], bool] | None = None) -> Solution:
    """Return a solution with what would release its task, if it was not met; it takes some seconds.

    Args:
        solution: What a synthesis found; of one that found every target nothing blocks.
        stop: Asked between the steps; when it says yes, what is known so far is returned.

    Returns:
        The same with `releases`, one for each limit that does alone, the least change first, the base
        last. None may mean that several limits block together. Should a shape turn up that meets the
        task as it is, the solution with this shape.
    """
    refuse_unless("solution", solution, Solution)
    if solution.found:
        return solution
    stop = stop or (lambda: False)
    found = []
    for limit in _limits(solution.task):
        if stop():
            break
        release = _released(limit, solution, stop)
        if release is not None and release.share < _NOTHING:
            return follow(solution.task, [release.design], seed=solution.seed)
        if release is not None:
            found.append(release)
    found.sort(key=lambda release: release.share)
    moved = None if stop() else _base_moved(solution, stop)
    return replace(solution, releases=tuple(found if moved is None else [*found, moved]))


def _released(limit: _Limit, solution: Solution, stop: Callable[[], bool]) -> Release | None:
    """Relax one limit more and more, then tighten it: as far as a shape allows, then as shapes follow."""
    for share, starts in _RELAXED:
        most = share * limit.most
        designs = follow(limit.relaxed(most), solution.designs, starts=starts, stop=stop).designs
        needs = [_needed(limit, design, most) for design in designs]
        if needs and min(needs) < math.inf:
            break
    else:
        return None
    best = int(np.argmin(needs))
    too_little, enough, design = 0.0, needs[best], designs[best]
    while enough - too_little > _RESOLUTION * enough and not stop():
        amount = 0.5 * (too_little + enough)
        followed = follow(limit.relaxed(amount), [design])
        if followed.found:
            enough, design = amount, followed.best
        else:
            too_little = amount
    return Release(
        limit.name,
        float(enough),
        float(enough / limit.scale),
        limit.sentence(enough),
        design,
        limit.relaxed(enough),
    )


def _needed(limit: _Limit, design: Design, most: float) -> float:
    """Return by how much a limit has to give way for one shape, infinite if that does not help it."""
    if not design.verification.found:
        return math.inf

    def does(amount: float) -> bool:
        task = limit.relaxed(amount)
        return verify(task, replace(design.arm, robot=task.robot), design.verification.joints).found

    if does(0.0):
        return 0.0
    too_little, enough = 0.0, most
    while enough - too_little > 0.1 * _RESOLUTION * enough:
        amount = 0.5 * (too_little + enough)
        if does(amount):
            enough = amount
        else:
            too_little = amount
    return enough


def _limits(task: Task) -> Iterator[_Limit]:
    """Yield the limits of a task and its hardware, each to be relaxed on its own."""
    robot, link, limits = task.robot, task.robot.link, task.robot.joint_limits

    def with_link(changed: MalleableLink) -> Task:
        return replace(task, robot=replace(robot, link=changed))

    low, high = link.length.lower, link.length.upper
    yield _Limit(
        "link length", high, high,
        lambda more: with_link(replace(link, length=Interval(low, high + more))),
        lambda more: f"a link {1e3 * more:.1f} mm longer, up to {1e3 * (high + more):.1f} mm",
    )  # fmt: skip
    yield _Limit(
        "link length", low, 0.6 * low,
        lambda less: with_link(replace(link, length=Interval(low - less, high))),
        lambda less: f"a link {1e3 * less:.1f} mm shorter, down to {1e3 * (low - less):.1f} mm",
    )  # fmt: skip
    radius = link.min_bend_radius
    yield _Limit(
        "bend radius", radius, 0.6 * radius,
        lambda less: with_link(replace(link, min_bend_radius=radius - less)),
        lambda less: f"a bend radius {1e3 * less:.1f} mm smaller, down to {1e3 * (radius - less):.1f} mm",
    )  # fmt: skip
    bend = link.max_total_bend
    if math.isfinite(bend):
        yield _Limit(
            "total bend", bend, 2.0 * math.pi,
            lambda more: with_link(replace(link, max_total_bend=bend + more)),
            lambda more: f"{math.degrees(more):.1f} deg more of bend in all, "
            f"up to {math.degrees(bend + more):.1f} deg",
        )  # fmt: skip
    for name, key, interval in (("joint 1", "base", limits.base), ("joint 2", "second", limits.second)):
        room = math.pi - 0.5 * (interval.upper - interval.lower)
        if room > 0.0:
            yield _Limit(
                name, math.pi, room,
                lambda more, key=key, interval=interval: replace(  # type: ignore[misc]
                    task, robot=replace(robot, joint_limits=replace(
                        limits, **{key: Interval(interval.lower - more, interval.upper + more)}))),
                lambda more, name=name: f"{math.degrees(more):.1f} deg more of {name} at each end",  # type: ignore[misc]
            )  # fmt: skip
    if task.floor is not None:
        floor, depth = task.floor, robot.d12 + high
        yield _Limit(
            "floor", high, depth,
            lambda lower: replace(task, floor=floor - lower),
            lambda lower: f"a floor {1e3 * lower:.1f} mm lower",
        )  # fmt: skip
    for index, obstacle in enumerate(task.obstacles):
        most = -_deepest(obstacle.solid)
        yield _Limit(
            f"obstacle: {obstacle.name}", high, most,
            lambda less, index=index: _with_less_of(task, index, less),  # type: ignore[misc]
            lambda less, name=obstacle.name: f"{name} {1e3 * less:.1f} mm smaller all round",  # type: ignore[misc]
        )  # fmt: skip


def _deepest(solid: Solid) -> float:
    """Return the least signed distance from a solid, m: how much it can shrink."""
    return -0.5 * float(solid.size.min()) if isinstance(solid, Box) else -solid.radius


def _with_less_of(task: Task, index: int, less: float) -> Task:
    """Return the task with an obstacle shrunk all round; one that has shrunk to nothing is gone."""
    obstacle = task.obstacles[index]
    solid, kept = obstacle.solid, list(task.obstacles)
    if less >= -_deepest(solid):
        del kept[index]
    elif isinstance(solid, Box):
        kept[index] = Obstacle(obstacle.name, replace(solid, size=solid.size - 2.0 * less))
    else:
        kept[index] = Obstacle(obstacle.name, replace(solid, radius=solid.radius - less))
    return replace(task, obstacles=tuple(kept))


def _base_moved(solution: Solution, stop: Callable[[], bool]) -> Release | None:
    """Move the base by what targets are missed on average, again and again, then back as far as may be.

    With its joints as they are, an arm whose base moves takes the end effector along.
    """
    task = solution.task

    def moved(shift: FloatArray) -> Task:
        floor = None if task.floor is None else task.floor - float(shift[2])
        base = BasePose(task.base.position + shift, task.base.yaw)
        return replace(task, base=base, floor=floor)

    shift, designs = np.zeros(3), solution.designs[:1]
    for _ in range(_BASE_STEPS):
        if not designs or stop() or np.linalg.norm(shift) > _FARTHEST_BASE:
            return None
        check = designs[0].verification
        shift = shift + np.mean(task.table.positions - check.reached, axis=0)
        followed = follow(moved(shift), designs)
        designs = followed.designs
        if followed.found:
            break
    else:
        return None
    too_little, enough = 0.0, 1.0
    for _ in range(_HALVINGS):
        part = 0.5 * (too_little + enough)
        followed = follow(moved(part * shift), designs)
        if followed.found:
            enough, designs = part, followed.designs
        else:
            too_little = part
    shift = enough * shift
    distance = float(np.linalg.norm(shift))
    x, y, z = 1e3 * shift
    return Release(
        "base", distance, distance / task.robot.link.length.upper,
        f"the base moved by {1e3 * distance:.1f} mm, ({x:z.1f}, {y:z.1f}, {z:z.1f}) mm",
        designs[0], moved(shift),
    )  # fmt: skip
