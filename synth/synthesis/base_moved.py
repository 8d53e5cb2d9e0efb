"""Where the base would have to stand for a task that cannot be met where it stands: found by trying."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from synth.robot import BaseRange, Interval
from synth.rounding import rounded_up
from synth.synthesis.placing import in_range
from synth.synthesis.solution import Release
from synth.synthesis.solve import follow

if TYPE_CHECKING:
    from synth.arrays import FloatArray
    from synth.synthesis.solution import Solution
    from synth.task import Task
    from synth.watch import Watch

_BASE_STEPS = 12
_BASE_DIGITS = (1, 2, 3)  # decimals of a millimetre; the more the nearer to what was found to do
_FARTHEST_BASE = 1.0  # m
_HALVINGS = 6
_AROUND = 0.4  # m either way, where a base is looked for that nothing nearby leads to


def base_moved(solution: Solution, watch: Watch, *, far: bool) -> Release | None:
    """Return another place of the base where the task is met, as near as such a place was found, or None.

    Args:
        solution: What a synthesis found where the base stands.
        watch: Its time.
        far: Whether a place is searched for all around where none nearby will do.
    """
    # A step towards thousands of samples costs as much as the whole search for a place.
    near = None if solution.task.surfaces else _moved_near(solution, watch)
    return _moved_far(solution, watch) if near is None and far else near


def _moved_near(solution: Solution, watch: Watch) -> Release | None:
    """Move the base by what targets are missed on average, again and again, then back as far as possible.

    With its joints as they are, an arm whose base moves takes the end effector along.
    """
    task = solution.task

    def moved(shift: FloatArray) -> Task:
        base = replace(task.base, position=task.base.position + shift)
        return replace(task, base=base, floor=task.floor_height)

    shift, designs = np.zeros(3), solution.designs[:1]
    for _ in range(_BASE_STEPS):
        if not designs or watch.is_up() or np.linalg.norm(shift) > _FARTHEST_BASE:
            return None
        check = designs[0].verification
        shift = shift + np.mean(task.table.positions - check.reached, axis=0)
        followed = follow(moved(shift), designs, watch=watch.aside())
        designs = followed.designs
        if followed.found:
            break
    else:
        return None
    too_little, enough = 0.0, 1.0
    for _ in range(_HALVINGS):
        if watch.is_up():
            break
        part = 0.5 * (too_little + enough)
        followed = follow(moved(part * shift), designs, watch=watch.aside())
        if followed.found:
            enough, designs = part, followed.designs
        else:
            too_little = part
    shift = enough * shift
    for digits in _BASE_DIGITS:  # what is told is what does: that place, not one that rounds to it
        told = np.round(1e3 * shift, digits) / 1e3
        followed = follow(moved(told), designs, watch=watch.aside())
        if followed.found:
            shift, designs = told, followed.designs
            break
    distance = float(np.linalg.norm(shift))
    x, y, z = (f"{1e3 * each:z.{digits}f}" for each in shift)
    return Release(
        "base", distance, distance / task.robot.link.length.upper,
        f"the base moved by {rounded_up(distance)} mm (x {x}, y {y}, z {z} mm)",
        designs[0], moved(shift),
    )  # fmt: skip


def _moved_far(solution: Solution, watch: Watch) -> Release | None:
    """Search for a place all around, upright and turned by anything."""
    task = solution.task
    if watch.is_up() or not task.base.is_upright:
        return None
    x, y, z = (Interval(float(c) - _AROUND, float(c) + _AROUND) for c in task.base.position)
    places = BaseRange(x, y, z, yaw=Interval(-math.pi, math.pi))
    free = replace(task, places=places, floor=task.floor_height)
    found = in_range(free, places, solution.seed, watch.aside()).solution()
    if not found.found:
        return None
    base = found.best.arm.base
    place = ", ".join(f"{1e3 * each:z.1f}" for each in base.position)
    distance = float(np.linalg.norm(base.position - task.base.position))
    there = replace(free, base=base, places=None)
    return Release(
        "base", distance, distance / task.robot.link.length.upper,
        f"the base at ({place}) mm, turned by {math.degrees(base.yaw):z.1f} deg,",
        found.best, there,
    )  # fmt: skip
