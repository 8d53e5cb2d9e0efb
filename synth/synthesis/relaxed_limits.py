"""The limits of a task and its hardware: each relaxed on its own, or all of them at once."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from synth.geometry import Box
from synth.robot import Interval, JointLimits
from synth.rounding import Unit, rounded_down, rounded_up
from synth.task import Obstacle, Topology

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from synth.geometry import Solid
    from synth.robot import MalleableLink
    from synth.task import Task

_LEAST_PART = 0.4  # of a length or a bend radius that is left, at most relaxed


@dataclass(frozen=True)
class Limit:
    """A limit that can be relaxed.

    Attributes:
        name: What it is called.
        scale: What its amounts are compared with, m or rad.
        most: How far it is relaxed at most, m or rad.
        relaxed: Returns the task with the limit relaxed by an amount.
        sentence: Says that, for the user.
    """

    name: str
    scale: float
    most: float
    relaxed: Callable[[float], Task]
    sentence: Callable[[float], str]


def limits_of(task: Task) -> Iterator[Limit]:
    """Yield the limits of a task and its hardware, each to be relaxed on its own."""
    robot, link, limits = task.robot, task.robot.link, task.robot.joint_limits

    def with_link(changed: MalleableLink) -> Task:
        return replace(task, robot=replace(robot, link=changed))

    low, high = link.length.lower, link.length.upper
    yield Limit(
        "link length", high, high,
        lambda more: with_link(replace(link, length=Interval(low, high + more))),
        lambda more: f"a link {rounded_up(more)} mm longer (up to {rounded_up(high + more)} mm)",
    )  # fmt: skip
    yield Limit(
        "link length", low, (1.0 - _LEAST_PART) * low,
        lambda less: with_link(replace(link, length=Interval(low - less, high))),
        lambda less: f"a link {rounded_up(less)} mm shorter (down to {rounded_down(low - less)} mm)",
    )  # fmt: skip
    radius = link.min_bend_radius
    yield Limit(
        "bend radius", radius, (1.0 - _LEAST_PART) * radius,
        lambda less: with_link(replace(link, min_bend_radius=radius - less)),
        lambda less: f"a bend radius {rounded_up(less)} mm smaller "
        f"(down to {rounded_down(radius - less)} mm)",
    )  # fmt: skip
    bend = link.max_total_bend
    if math.isfinite(bend):
        yield Limit(
            "total bend", bend, 2.0 * math.pi,
            lambda more: with_link(replace(link, max_total_bend=bend + more)),
            lambda more: f"{rounded_up(more, Unit.DEG)} deg more of bend in all "
            f"(up to {rounded_up(bend + more, Unit.DEG)} deg)",
        )  # fmt: skip
    for name, key, interval in (("joint 1", "base", limits.base), ("joint 2", "second", limits.second)):
        room = math.pi - 0.5 * (interval.upper - interval.lower)
        if room > 0.0:
            yield Limit(
                name, math.pi, room,
                lambda more, key=key, interval=interval: replace(  # type: ignore[misc]
                    task, robot=replace(robot, joint_limits=replace(
                        limits, **{key: Interval(interval.lower - more, interval.upper + more)}))),
                lambda more, name=name: f"{rounded_up(more, Unit.DEG)} deg more of {name} at each end",  # type: ignore[misc]
            )  # fmt: skip
    if (floor := task.floor_height) is not None:
        depth = robot.d12 + high
        yield Limit(
            "floor", high, depth,
            lambda lower: replace(task, floor=floor - lower),
            lambda lower: f"a floor {rounded_up(lower)} mm lower",
        )  # fmt: skip
    for index, obstacle in enumerate(task.obstacles):
        most = -_deepest(obstacle.solid)
        yield Limit(
            f"obstacle: {obstacle.name}", high, most,
            lambda less, index=index: _with_less_of(task, index, less),  # type: ignore[misc]
            lambda less, name=obstacle.name: f"{name} {rounded_up(less)} mm smaller all around",  # type: ignore[misc]
        )  # fmt: skip


def _deepest(solid: Solid) -> float:
    """Return the least signed distance from a solid, m: how much it can shrink."""
    return -0.5 * float(solid.size.min()) if isinstance(solid, Box) else -solid.radius


def _with_less_of(task: Task, index: int, less: float) -> Task:
    """Return the task with an obstacle shrunk all around; one that has shrunk to nothing is gone."""
    obstacle = task.obstacles[index]
    solid, kept = obstacle.solid, list(task.obstacles)
    if less >= -_deepest(solid):
        del kept[index]
    elif isinstance(solid, Box):
        kept[index] = Obstacle(obstacle.name, replace(solid, size=solid.size - 2.0 * less))
    else:
        kept[index] = Obstacle(obstacle.name, replace(solid, radius=solid.radius - less))
    return replace(task, obstacles=tuple(kept))


def without_limits(task: Task) -> Task:
    """Return a task with all limits relaxed at once: as far as each on its own, or gone."""
    robot, link = task.robot, task.robot.link
    length = Interval(_LEAST_PART * link.length.lower, 2.0 * link.length.upper)
    free = replace(
        link, length=length, min_bend_radius=_LEAST_PART * link.min_bend_radius, max_total_bend=math.inf
    )
    return replace(
        task,
        robot=replace(robot, link=free, joint_limits=JointLimits()),
        floor=None,
        obstacles=(),
        topology=Topology.ANY,
        current=None,
    )
