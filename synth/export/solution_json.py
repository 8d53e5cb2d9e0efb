"""`solution.json`: a solution as plain data of the schema `synth.solution/2`, in metres and radians."""

from __future__ import annotations

import math
from dataclasses import asdict, fields
from typing import TYPE_CHECKING, Any

import numpy as np

from synth.checks import refuse_unless
from synth.export.json_data import Plain, plain
from synth.export.surface_json import paths_to_json, surfaces_to_json
from synth.export.task_json import arcs_to_json, targets_asked_for, task_to_json
from synth.guide import MARKERS, make_guide
from synth.synthesis import Bound, Solution, TargetResult, target_results, worst_targets

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.guide import Guide
    from synth.robot import Arm
    from synth.synthesis import Design, Motion, Release
    from synth.task import Task

SCHEMA = "synth.solution/2"
_CENTRELINE_SPACING = 0.01  # m
_MOST_OF_CENTRELINE = 1000  # points: of a link longer than 10 m they are farther apart
MOST_TARGETS = 10_000  # of which it is told in full what becomes of them; of more, the worst
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
    refuse_unless("solution", solution, Solution)
    task, designs = solution.task, solution.designs
    guide = make_guide(task, designs[0]) if designs else None
    shape = dict.fromkeys(_SHAPE_FIELDS) if guide is None else _shape(guide)
    content = {
        "schema": SCHEMA,
        "version": solution.version,
        "task": task_to_json(task),
        "status": solution.status.value,
        "message": solution.message,
        "reasons": solution.reasons,
        "seed": solution.seed,
        "starts": solution.starts,
        "shape": solution.shape if designs else None,
        "time": solution.time,
        **shape,
        "targets": _targets(task, designs[0]) if designs else _targets_missed(task),
        "targets_left_out": max(len(task.targets) - MOST_TARGETS, 0),
        "targets_unseen": designs[0].verification.unseen if designs else 0,
        "surfaces": surfaces_to_json(designs[0]) if designs else None,
        "paths": paths_to_json(designs[0]) if designs else None,
        "ways": None if guide is None else [_way(motion) for motion in designs[0].ways or guide.ways],
        "figures": designs[0].figures if designs else None,
        "bound": _bound(solution.bound),
        "explained": solution.explained,
        "releases": [_release(task, each) for each in solution.releases],
        "notes": solution.notes,
        "breakdown": solution.breakdown,
        "alternatives": [
            {"shape": number, **_design(task, design)}
            for number, design in zip(solution.shape_numbers[1:], designs[1:], strict=True)
        ],
    }
    return plain(content)


_SHAPE_FIELDS = (
    "distances",
    "squared_distances",
    "gamma",
    "invariants",
    "category",
    "category_distances",
    "base",
    "link",
    "rigid_link",
    "guide",
)


def _bound(bound: Bound | None) -> dict[str, object] | None:
    return None if bound is None else {**asdict(bound), "gap": bound.gap}


def _release(task: Task, release: Release) -> dict[str, object]:
    """Return what would release a task: the task released, and the shape that then meets it."""
    released = task_to_json(release.task)
    if release.task.table == task.table:
        del released["targets"]
    return {
        "limit": release.limit,
        "amount": release.amount,
        "share": release.share,
        "sentence": release.sentence,
        "task": released,
        "design": _design(release.task, release.design),
    }


def _way(motion: Motion) -> dict[str, object]:
    return {"from": motion.start, "to": motion.end, "found": motion.found, "joints": motion.joints}


def _shape(guide: Guide) -> dict[str, object]:
    """Return all that describes the shape of a guide, with the keys `_SHAPE_FIELDS`."""
    arm = guide.arm
    squared = _squared_distances(arm)
    spacing = max(_CENTRELINE_SPACING, arm.shape.length / _MOST_OF_CENTRELINE)
    centreline = arm.base.to_task(arm.shape.centreline(spacing) + arm.base_joint[1])
    values = (
        {pair: math.sqrt(s) for pair, s in squared.items()},
        squared,
        {"q": arm.surface.q},
        arm.invariants,
        arm.category.value,
        arm.category_distances,
        arm.base,
        {**_link(arm), "centreline": centreline},
        _rigid_link(arm),
        _guide(guide),
    )
    return dict(zip(_SHAPE_FIELDS, values, strict=True))


def _design(task: Task, design: Design) -> dict[str, object]:
    """Return another shape in short: enough to choose it, and to rebuild it from its arcs."""
    squared, check = _squared_distances(design.arm), design.verification
    return {
        "distances": {pair: math.sqrt(s) for pair, s in squared.items()},
        "category": design.arm.category.value,
        "base": design.arm.base,
        "link": _link(design.arm),
        "rigid_link": _rigid_link(design.arm),
        "ways": [_way(motion) for motion in design.ways],
        "figures": design.figures,
        "targets": [
            {
                "name": task.table.names[index],
                "miss": check.misses[index],
                "within_tolerance": check.within_tolerance[index],
                "joints": check.joints[index],
            }
            for index in _listed(task, design).tolist()
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
        "arcs": arcs_to_json(shape),
    }


def _rigid_link(arm: Arm) -> dict[str, object]:
    """Return d35 and d45 as they are, m; those of `distances` come out of the points, rounded.

    The name comes first where it was chosen from a catalogue.
    """
    name = arm.robot.name_of_rigid_link(arm.d35, arm.d45)
    return ({"name": name} if name else {}) | {"d35": arm.d35, "d45": arm.d45}


def _listed(task: Task, design: Design) -> NDArray[np.intp]:
    """Return the indices of the targets that are told of in full, in their order: the worst ones if many."""
    return np.sort(worst_targets(task, design.verification, MOST_TARGETS))


def _targets(task: Task, design: Design) -> list[object]:
    # The fields of a TargetResult bear the names of the contract.
    return list(target_results(task, design.arm, design.verification, _listed(task, design)))


def _targets_missed(task: Task) -> Plain:
    untold = dict.fromkeys(field.name for field in fields(TargetResult))
    untold |= {"within_tolerance": False, "alternatives": []}
    asked = targets_asked_for(task.table[:MOST_TARGETS])
    return Plain(untold | {key: each[key] for key in untold.keys() & each.keys()} for each in asked)


def _guide(guide: Guide) -> dict[str, object]:
    """Return the guide: everything stands where it is with the joints at `hold`.

    Of a task that is not met there is no tolerance to keep, and nothing to expect of a hand.
    """
    placement = guide.hold
    return {
        "hold": guide.posture,
        "markers": dict(zip(MARKERS, placement.markers, strict=True)),
        "axis2": {
            "point": placement.axis_point,
            "direction": placement.axis_direction,
            "elevation": placement.elevation,
            "heading": placement.heading,
        },
        "centreline": [
            {"name": name, "arc_length": station, "position": position}
            for name, station, position in zip(
                guide.station_names, guide.stations, placement.centreline, strict=True
            )
        ],
        "tolerance": guide.tolerance if guide.met else None,
        "forgiveness": guide.forgiveness,
        "base": guide.place,
    }
