"""`solution.json`: a solution as plain data of the schema `synth.solution/1`, in metres and radians."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from synth.export.plain import plain
from synth.guide import MARKERS, make_guide
from synth.synthesis import MOST_MOTIONS, Bound, motions
from synth.synthesis.solution import target_results
from synth.version import __version__

if TYPE_CHECKING:
    from synth.guide import Guide, Placement
    from synth.robot import Arm
    from synth.synthesis import Design, Solution
    from synth.task import Task

SCHEMA = "synth.solution/1"
_CENTRELINE_SPACING = 0.01  # m
# What is fixed or shaped: all pairs but 15 and 25, which change as the robot moves.
_PAIRS = ("12", "13", "14", "23", "24", "34", "35", "45")


def solution_to_json(solution: Solution) -> dict[str, Any]:
    """Return a solution as plain data.

    Args:
        solution: What a synthesis found. If it found no shape, all that describes one is None, and
            the targets are listed without misses.

    Returns:
        Dictionaries, lists, strings, numbers and None, for `json.dumps(..., allow_nan=False)`: what
        JSON cannot hold, NaN and infinity, is None.
    """
    task, designs = solution.task, solution.designs
    shape = _shape(task, designs[0]) if designs else dict.fromkeys(_SHAPE_FIELDS)
    content = {
        "schema": SCHEMA,
        "version": __version__,
        "task": task.name,
        "status": solution.status.value,
        "message": solution.message,
        "reasons": solution.reasons,
        "seed": solution.seed,
        "starts": solution.starts,
        "time": solution.time,
        **shape,
        "targets": _targets(task, designs[0]) if designs else _targets_missed(task),
        "figures": designs[0].figures if designs else None,
        "motions": list(motions(task, designs[0])) if _has_motions(solution) else None,
        "bound": _bound(solution.bound),
        "releases": [
            {"limit": each.limit, "amount": each.amount, "share": each.share, "sentence": each.sentence}
            for each in solution.releases
        ],
        "alternatives": [_alternative(task, design) for design in designs[1:]],
    }
    return plain(content)


def _has_motions(solution: Solution) -> bool:
    """Whether ways from target to target mean anything: there is a shape, and the targets are no cloud."""
    return bool(solution.designs) and len(solution.task.targets) <= MOST_MOTIONS


_SHAPE_FIELDS = (
    "distances",
    "squared_distances",
    "gamma",
    "invariants",
    "category",
    "category_distances",
    "base",
    "link",
    "guide",
)


def _bound(bound: Bound | None) -> dict[str, object] | None:
    return None if bound is None else {"lower_bound": bound.lower_bound, "gap": bound.gap}


def _shape(task: Task, design: Design) -> dict[str, object]:
    """Return all that describes one shape of the robot, with the keys `_SHAPE_FIELDS`."""
    arm = design.arm
    squared = _squared_distances(arm)
    centreline = arm.base.to_task(arm.shape.centreline(_CENTRELINE_SPACING) + arm.base_joint[1])
    values = (
        {pair: math.sqrt(s) for pair, s in squared.items()},
        squared,
        {"q": arm.surface.q},
        arm.invariants,
        arm.category.value,
        arm.category_distances,
        arm.base,
        {**_link(arm), "centreline": centreline},
        _guide(make_guide(task, design)),
    )
    return dict(zip(_SHAPE_FIELDS, values, strict=True))


def _alternative(task: Task, design: Design) -> dict[str, object]:
    """Return another shape in short: enough to choose it, and to rebuild it from its arcs."""
    squared = _squared_distances(design.arm)
    return {
        "distances": {pair: math.sqrt(s) for pair, s in squared.items()},
        "category": design.arm.category.value,
        "link": _link(design.arm),
        "figures": design.figures,
        "targets": [
            {"name": target.name, "miss": miss, "within_tolerance": within}
            for target, miss, within in zip(
                task.targets, design.verification.misses, design.verification.within_tolerance, strict=True
            )
        ],
    }


def _squared_distances(arm: Arm) -> dict[str, float]:
    return {pair: float(arm.squared_distances[int(pair[0]) - 1, int(pair[1]) - 1]) for pair in _PAIRS}


def _link(arm: Arm) -> dict[str, object]:
    shape = arm.shape
    return {
        "length": shape.length,
        "min_bend_radius": shape.min_bend_radius,
        "total_bend": shape.total_bend,
        "arcs": [
            {"curvature": curvature, "length": length}
            for curvature, length in zip(shape.curvatures, shape.lengths, strict=True)
        ],
    }


def _targets(task: Task, design: Design) -> list[object]:
    # The fields of a TargetResult bear the names of the contract.
    return list(target_results(task, design))


def _targets_missed(task: Task) -> list[object]:
    return [
        {
            "name": target.name,
            "position": target.position,
            "reached": None,
            "miss": None,
            "tolerance": target.tolerance,
            "within_tolerance": False,
            "clearance": None,
            "joints": None,
            "alternatives": [],
        }
        for target in task.targets
    ]


def _guide(guide: Guide) -> dict[str, object]:
    """Return the guide: the points at joint 1 = 0, and under `hold` those at an angle it can hold."""
    return {
        **_placement(guide, guide.at_zero),
        "hold": {"joint1": guide.hold.joint1, **_placement(guide, guide.hold)},
        "tolerance": guide.tolerance,
    }


def _placement(guide: Guide, placement: Placement) -> dict[str, object]:
    return {
        "markers": dict(zip(MARKERS, placement.markers, strict=True)),
        "axis2": {"point": placement.axis_point, "direction": placement.axis_direction},
        "centreline": [
            {"name": name, "arc_length": station, "position": position}
            for name, station, position in zip(
                guide.station_names, guide.stations, placement.centreline, strict=True
            )
        ],
    }
