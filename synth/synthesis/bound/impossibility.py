"""Proofs that a target cannot be reached by any shape: short, certain, and far from complete."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from synth.robot import LinkReach
from synth.rounding import at_least, at_most

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.robot import Robot
    from synth.task import Task

_DIRECTIONS = 12  # in which points of the reach are tried
_ROUNDING = 1e-8  # m, many times what the margin of the reach has


def longest_rigid_link(robot: Robot) -> float:
    """Return the largest distance from the link's end to the end effector, m.

    The link's end divides P3P4 at lambda = tip_offset / d34, so by Stewart's theorem
    |P5 - p|^2 = (1 - lambda) s35 + lambda s45 - lambda (1 - lambda) s34: linear in s35 and s45, hence
    largest at an end of each interval.

    Args:
        robot: The hardware.
    """
    part = robot.tip_offset / robot.d34
    d35, d45 = robot.rigid_link.d35, robot.rigid_link.d45
    squared = max(
        (1.0 - part) * a**2 + part * b**2 - part * (1.0 - part) * robot.d34**2
        for a in (d35.lower, d35.upper)
        for b in (d45.lower, d45.upper)
    )
    return math.sqrt(max(squared, 0.0))


def why_impossible(task: Task) -> tuple[str, ...]:
    """Return the reasons for which no shape at all can do the task; none does not mean it can.

    The end effector is at most the longest rigid link from the malleable link's end, and that end is
    in the link's reach. So a target farther than that from the reach is missed by the difference. And
    neither the end effector nor P2, where the link starts, may be below the floor or in an obstacle.

    Args:
        task: The task.

    Returns:
        One sentence for each target or limit that makes the task impossible.
    """
    reasons = []
    if (too_deep := task.lowest_from(task.base) - task.robot.d12) > 0.0:
        reasons.append(f"the link starts at P2, {at_least(too_deep)} below the floor")
    reasons += _in_the_way(task)
    longest = longest_rigid_link(task.robot)
    positions, tolerances, targets = task.positions_in_base, task.tolerances, task.targets
    beyond = np.full(len(positions), -math.inf)
    far = _perhaps_out_of_reach(task, longest)
    seen = positions[far] - np.array([0.0, 0.0, task.robot.d12])
    beyond[far] = -LinkReach(task.robot.link).margin(seen)
    floor = task.lowest_from(task.base)
    out_of_reach = beyond > longest + tolerances + _ROUNDING
    sunk = positions[:, 2] < floor - tolerances
    for index in np.flatnonzero(out_of_reach | sunk).tolist():
        name, distance = targets[index].name, float(beyond[index])
        if out_of_reach[index]:
            reasons.append(
                f"{name} is {at_least(distance)} from wherever the malleable link can end, "
                f"and the rigid link reaches {at_most(longest)} from there: "
                f"it misses by {at_least(distance - longest)}"
            )
        else:
            reasons.append(
                f"{name} is {at_least(floor - positions[index, 2])} below the floor, and the "
                "end effector stays above it"
            )
    return tuple(reasons)


def _in_the_way(task: Task) -> list[str]:
    """Return a sentence for each obstacle about the base or about a target.

    A link that leaves its mount, half a diameter long, at a point of an obstacle cannot be clear of it. And
    an end effector that is within the tolerance of a target is at most that much less deep than it.
    """
    reasons = []
    rod_radius = 0.5 * task.robot.rigid_link.diameter
    p2 = np.array([0.0, 0.0, task.robot.d12])
    for obstacle, solid in zip(task.obstacles_from(task.base), task.solids, strict=True):
        depth = -float(solid.distance(p2))
        if depth > _ROUNDING:
            reasons.append(f"the link starts at P2, {at_least(depth)} inside {obstacle.name}")
        depths = rod_radius - solid.distance(task.positions_in_base)
        reasons += [
            f"{task.targets[index].name} is in {obstacle.name}: "
            f"there the end effector would be {at_least(depths[index])} inside"
            for index in np.flatnonzero(depths > task.tolerances + _ROUNDING).tolist()
        ]
    return reasons


def _perhaps_out_of_reach(task: Task, longest: float) -> NDArray[np.intp]:
    """Return the indices of targets that no point tried of the link's reach is near enough to.

    It is quickly said whether a point is in the reach, slowly how far it is from it.
    """
    reach, step = LinkReach(task.robot.link), 0.999 * longest
    x, y, z = task.positions_in_base.T
    seen, left = np.column_stack([np.hypot(x, y), 0.0 * x, z - task.robot.d12]), np.arange(len(x))
    for angle in np.linspace(0.0, 2.0 * np.pi, _DIRECTIONS, endpoint=False):
        tried = seen[left] + step * np.array([np.cos(angle), 0.0, np.sin(angle)])
        left = left[~reach.contains(tried)]
    return left
