"""What the page shows, as plain data: scene, shapes, the words of the sheet. In metres and radians."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from synth.checks import refuse_unless
from synth.export.page.scene import obstacle_content, paths_content, targets_content
from synth.export.page.shapes import compared, shape_content
from synth.export.sheet import headline_told, help_in_few, why_told
from synth.guide import base_sentence, instructions, points_sentence
from synth.synthesis import Solution
from synth.version import __version__

if TYPE_CHECKING:
    from synth.guide import Guide

SCHEMA = "synth.page/1"


def page_content(solution: Solution, guide: Guide | None) -> dict[str, Any]:
    """Return all that the page shows of a solution.

    Args:
        solution: What a synthesis found, whatever its status.
        guide: The guide to its first shape, or None if there is no shape.

    Returns:
        Dictionaries, lists, arrays, strings, finite numbers and None. Of a task that is missed there is
        nothing that a person could bend a link to: no instructions, no markers.
    """
    refuse_unless("solution", solution, Solution)
    task, designs, met = solution.task, solution.designs, guide is not None and guide.met
    listed, targets = targets_content(solution)
    floor = task.floor_height
    return {
        "schema": SCHEMA,
        "version": __version__,
        "name": task.name,
        "robot": task.robot.name,
        "seed": solution.seed,
        "found": met,
        "headline": headline_told(solution),
        "why": [] if met else why_told(solution),
        "help": [] if met else help_in_few(solution),
        "floor": floor,
        "targets": targets,
        "paths": paths_content(solution),
        "obstacles": [obstacle_content(obstacle) for obstacle in task.obstacles],
        "shapes": [
            shape_content(solution, number, design, listed)
            for number, design in zip(solution.shape_numbers[: len(designs)], designs, strict=True)
        ],
        "compared": compared(solution),
        "instructions": _instructions(guide) if guide is not None and guide.met else None,
    }


def _instructions(guide: Guide) -> dict[str, Any]:
    """Return what a person does to bend the link to the first shape, and the points that are to be met."""
    angle = math.degrees(guide.hold.joint1)
    return {
        "hold": [guide.posture.joint1, guide.posture.joint2],
        "kind": f"Kind of shape: {guide.arm.category_distances.describe()}.",
        "base": base_sentence(guide),
        "steps": instructions(guide),
        "points_title": f"{points_sentence(guide).rstrip(':')}, joint 1 at {angle:z.1f}°",
        "points": [
            {"name": name, "position": point, "told": [f"{1e3 * value:z.1f}" for value in point]}
            for name, point in guide.points(guide.hold).items()
        ],
    }
