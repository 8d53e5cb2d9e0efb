"""Sizes that cannot be meant: the traces that a mistaken unit of length leaves.

A unit mistaken makes a length 10, 100 or 1000 times too large or too small. Ten times is within what people
ask in earnest: a target out of reach is an honest impossible task, and so is one near the base. Hundred and
thousand times are not, and a search for such a task takes long and ends in a reason that does not help. So
what is asked about is what no task means:

- all targets within a hundredth of the robot's reach about P1: that is inside the base's own column (12 mm
  for the prototype, whose link is 50 mm thick);
- all targets farther from P1 than 20 times the reach;
- a surface smaller than a 500th of the reach, larger than 40 times or all farther away than 20 times that;
- a link shorter than a 20th of the longer of d12 and d34, or longer than 1000 times that one (the
  prototype's is 12 times as long).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from synth.errors import Mistake
from synth.rounding import Unit, rounded_down, rounded_up

if TYPE_CHECKING:
    from collections.abc import Callable

    from synth.robot import Robot
    from synth.surfaces import Surface
    from synth.task.model import Task

PER_METRE = {"mm": 1000.0, "cm": 100.0, "m": 1.0}  # to divide by: 455 / 1000 is 0.455 exactly
_TOLD_IN_METRES = 100.0  # m, a length from which on millimetres help nobody
_NEAR = 0.01  # of the reach: targets that are all nearer are in another unit
_FAR = 20.0  # of the reach, likewise targets that are all farther
_SHORT = 0.05  # of the longer of d12 and d34, likewise a shorter link
_LONG = 1000.0  # of that, likewise a longer one
_SMALL = 0.002  # of the reach: a surface that is smaller is in another unit
_LARGE = 40.0  # of the reach, likewise a larger one
_MEANT = (0.1, 1.5)  # of the reach: where the farthest target is in a unit that may be meant


def unmeant_sizes(task: Task, unit: str | None = None) -> list[Mistake]:
    """Return what is wrong with the sizes of a task, its robot's among them.

    Args:
        task: The task.
        unit: What its file states as the unit of length; None for a task in metres from Python.
    """
    return [
        *(_with_key(wrong, f"robot.{wrong.key}") for wrong in unmeant_sizes_of_robot(task.robot)),
        *unmeant_distances(task, unit),
    ]


def unmeant_sizes_of_robot(robot: Robot) -> list[Mistake]:
    """Return what is wrong with the sizes of a robot."""
    baseline = max(robot.d12, robot.d34)
    longest = robot.link.length.upper
    if _SHORT * baseline <= longest <= _LONG * baseline:
        return []
    name, wrong = ("d12" if robot.d12 == baseline else "d34"), "short" if longest < baseline else "long"
    return [
        Mistake(
            f"a link of {_told(longest)} is too {wrong} beside {name} = {_told(baseline)}: "
            "are all lengths of the robot in one unit, and is that unit right?",
            key="link.length",
        )
    ]


def unmeant_distances(task: Task, unit: str | None = None) -> list[Mistake]:
    """Return what is wrong with the distances of all targets from P1, beside what the robot reaches."""
    reach = reach_of(task.robot)
    surfaces = [
        Mistake(wrong, key=f"surface[{number}]" if len(task.surfaces) > 1 else "surface")
        for number, surface in enumerate(task.surfaces)
        if (wrong := _unmeant_surface(surface, task, reach))
    ]
    if surfaces:
        return surfaces
    distances = np.linalg.norm(task.positions_in_base, axis=1)
    nearest, farthest = float(distances.min()), float(distances.max())
    if _NEAR * reach <= farthest and nearest <= _FAR * reach:
        return []
    if farthest < _NEAR * reach:
        where = f"all targets are within {_told(farthest, rounded_up)} of P1"
    else:
        where = f"all targets are at least {_told(nearest, rounded_down)} from P1"
    sentence = f"{where}, and this robot reaches {_told(reach, rounded_up)} at most"
    number, stated = farthest * PER_METRE[unit or "m"], unit or "m"
    question = f"is length_unit: {stated} right?" if unit else "are they in metres?"
    for other, per_metre in PER_METRE.items():
        if other != stated and _MEANT[0] * reach <= number / per_metre <= _MEANT[1] * reach:
            question += f" In {other} the farthest would be {_told(number / per_metre, rounded_up)} away"
            break
    return [Mistake(f"{sentence}: {question}", key="targets")]


def _unmeant_surface(surface: Surface, task: Task, reach: float) -> str:
    """Return what is wrong with a surface's size, or with how far away it is; nothing if it may be meant."""
    points = surface.samples.points
    size = float(np.linalg.norm(np.ptp(points, axis=0)))
    nearest = float(np.linalg.norm(task.base.to_base(points), axis=1).min())
    told = f"this robot reaches {_told(reach, rounded_up)} at most"
    if len(points) > 1 and size < _SMALL * reach:
        wrong = f"{surface.name} is {_told(size)} large, and {told}"
    elif size > _LARGE * reach:
        wrong = f"{surface.name} is {_told(size, rounded_down)} large, and {told}"
    elif nearest > _FAR * reach:
        return (
            f"{surface.name} is at least {_told(nearest, rounded_down)} from P1, and {told}: is its "
            "length_unit right, and are its coordinates those of the task frame (pose moves it)?"
        )
    else:
        return ""
    meant = [
        f"a length_unit {by:g} times as {'long' if by > 1.0 else 'short'} would make it {_told(by * size)}"
        for by in (1000.0, 100.0, 10.0, 0.1, 0.01, 0.001)
        if _MEANT[0] * reach <= by * size <= _MEANT[1] * reach
    ]
    return ": ".join([f"{wrong}: is its length_unit right?", *meant[:1]]).replace("?:", "?")


def reach_of(robot: Robot) -> float:
    """Return a distance from P1 that P5 never exceeds, m: column, link and rigid link in line."""
    rods = [
        math.hypot(*map(float, robot.end_effector_circle(d35, d45)))
        for link in robot.possible_rigid_links
        for d35 in (link.d35.lower, link.d35.upper)
        for d45 in (link.d45.lower, link.d45.upper)
    ]
    return robot.d12 + robot.link.length.upper + max(rods)


def _told(length: float, rounded: Callable[[float, Unit, int], str] = rounded_up) -> str:
    """Return a length with its unit and four digits or more, rounded up or down."""
    unit = Unit.MM if length < _TOLD_IN_METRES else Unit.M
    number = float(unit.of(length))
    digits = max(3 - math.floor(math.log10(number)), 0) if number > 0.0 else 0
    return f"{float(rounded(length, unit, digits)):.10g} {unit.symbol}"


def _with_key(mistake: Mistake, key: str) -> Mistake:
    return Mistake(mistake.message, mistake.file, mistake.line, key)
