"""What stands about the arm: targets and obstacles, in the task frame and in metres."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from synth.export.sheet import listed_targets
from synth.geometry import Box
from synth.rounding import rounded_down
from synth.task import DEFAULT_TOLERANCE

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.synthesis import Solution
    from synth.task import Obstacle

MOST_DRAWN = 1000  # targets without a line in the table: more cover each other
_MOST_OF_PATH = 400  # points of a path's line


def targets_content(solution: Solution) -> tuple[NDArray[np.intp], dict[str, Any]]:
    """Return which targets have a mark, and what is said of them whatever the shape.

    Args:
        solution: What a synthesis found.

    Returns:
        Indices of those that are drawn, shape (k,), and what the page says of them: all that have a line in
        the sheet's table, and of many others an even choice.
    """
    task = solution.task
    count, listed = len(task.targets), np.asarray(listed_targets(solution), dtype=np.intp)
    step = -(-count // MOST_DRAWN)
    drawn = np.union1d(listed, np.arange(0, count, step))
    followed = np.isin(drawn, np.flatnonzero(task.path_of_targets >= 0))
    return drawn, {
        "count": count,
        "positions": task.table.positions[drawn].round(7),
        "on_path": followed,
        "listed": [
            {
                "drawn": int(np.searchsorted(drawn, index)),
                "number": index + 1,
                "name": task.targets[index].name,
                "tolerance": rounded_down(task.targets[index].tolerance, digits=3),
                "default": task.targets[index].tolerance == DEFAULT_TOLERANCE,
            }
            for index in listed.tolist()
        ],
    }


def paths_content(solution: Solution) -> list[dict[str, Any]]:
    """Return the paths as lines through their samples, by name."""
    task, found = solution.task, []
    for number, path in enumerate(task.paths):
        samples = np.flatnonzero(task.path_of_targets == number)
        step = -(-len(samples) // _MOST_OF_PATH)
        chosen = np.union1d(samples[::step], samples[-1:])
        found.append({"name": path.name, "points": task.table.positions[chosen].round(7)})
    return found


def obstacle_content(obstacle: Obstacle) -> dict[str, Any]:
    """Return an obstacle: a box by its centre, size and axes, what is round by its ends and its radius."""
    solid = obstacle.solid
    if isinstance(solid, Box):
        return {"name": obstacle.name, "centre": solid.centre, "size": solid.size, "axes": solid.axes}
    return {"name": obstacle.name, "ends": solid.ends, "radius": solid.radius}
