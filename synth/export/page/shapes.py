"""The shapes: two turns about axes and what is fixed to them; and the figures to compare them by."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from synth.robot import ArmBody, Workspace
from synth.rounding import Unit, rounded_down, rounded_up
from synth.synthesis import clearance_told

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.robot import Arm
    from synth.synthesis import Design, Solution

_SPACING = 0.01  # m, of the centreline that is drawn
_MOST_OF_CENTRELINE = 500  # points: of a long link they are farther apart
_DIGITS = 6  # of a metre, of the line that is drawn


def shape_content(solution: Solution, number: int, design: Design, drawn: NDArray[np.intp]) -> dict[str, Any]:
    """Return one shape: its arm, and what becomes of the targets that are drawn.

    Args:
        solution: What a synthesis found.
        number: Which of its shapes this is, counted from 1, the best.
        design: The shape.
        drawn: Indices of the targets that are drawn, shape (k,).
    """
    check, found = design.verification, design.verification.found
    return {
        "number": number,
        "found": found,
        "category": design.arm.category.value,
        "arm": _arm(design.arm, with_markers=found),
        "within": [check.within_tolerance[index] for index in drawn.tolist()],
        "joints": check.joints[drawn],
        "missed_by": [rounded_up(miss, digits=3) for miss in check.misses[drawn].tolist()],
        "clear": [_clear(value) for value in check.clearances[drawn].tolist()]
        if solution.task.solids
        else None,
        "ways": [{"told": way.describe().replace(" deg", "°"), "joints": way.joints} for way in design.ways]
        if found
        else [],
    }


def _clear(clearance: float) -> str | None:
    return None if math.isinf(clearance) else clearance_told(clearance)


def _arm(arm: Arm, *, with_markers: bool) -> dict[str, Any]:
    """Return an arm: a point of the rigid link is at T1 Rz(theta1) T2 Rx(theta2) point.

    The pose T1 of joint 1 is the base's in the task frame; T2, of joint 2, is that of the circle of P5 in the
    base frame, with axis 2 as its x axis.
    """
    kinematics, body = arm.kinematics, ArmBody(arm)
    limits = Workspace.within_limits(arm).limits
    rotation, end = arm.end_frame
    spacing = max(_SPACING, arm.shape.length / _MOST_OF_CENTRELINE)
    along_axis = (arm.axis_points[2:] - kinematics.centre) @ rotation
    return {
        "limits": [[limits.base.lower, limits.base.upper], [limits.second.lower, limits.second.upper]],
        "joint1": {"rotation": arm.base.rotation, "origin": arm.base.position},
        "joint2": {"rotation": rotation, "origin": kinematics.centre},
        "axis1": arm.axis_points[:2],
        "centreline": (arm.shape.centreline(spacing) + arm.base_joint[1]).round(_DIGITS),
        "length": arm.shape.length,
        "link_end": (end - kinematics.centre) @ rotation,
        "axis2": along_axis,
        "p5": np.array([0.0, 0.0, -float(kinematics.radius)]),
        "markers": with_markers,
        "tube_radius": body.tube_radius,
        "rod_radius": body.rod_radius,
    }


def compared(solution: Solution) -> list[dict[str, Any]]:
    """Return the figures by which a person chooses a shape, a row each and a column for each shape."""
    columns = [_figures(design) for design in solution.designs]
    names = dict.fromkeys(name for column in columns for name in column)
    return [{"name": name, "values": [column.get(name, "–") for column in columns]} for name in names]


def _figures(design: Design) -> dict[str, str]:
    """Return the figures of a shape in words, rounded to the side on which they stay true."""
    arm, figures = design.arm, design.figures
    told = {
        "worst miss, mm": rounded_up(float(design.verification.misses.max()), digits=3),
        "kind": arm.category.value,
        "link length, mm": f"{1e3 * arm.shape.length:.1f}",
        "tightest bend, radius, mm": rounded_down(arm.shape.min_bend_radius),
        "bend in all, °": f"{math.degrees(arm.shape.total_bend):.0f}",
    }
    if not arm.robot.rigid_link.is_fixed:
        told["rigid link, d35 and d45, mm"] = f"{1e3 * arm.d35:.1f}, {1e3 * arm.d45:.1f}"
    if figures is None or not design.verification.found:
        return told
    hand, margins = figures.forgiveness, figures.margins
    told |= {
        "by a hand, worst miss expected, mm": rounded_up(hand.expected_worst_miss),
        "by a hand, all within at first": hand.chance_told.replace("less than", "<").replace("about ", ""),
        "largest swing of a joint, °": rounded_up(figures.largest_swing, Unit.DEG, 0),
        "joint 1 off its limits, °": rounded_down(margins.joint1, Unit.DEG, 0),
        "joint 2 off its limits, °": rounded_down(margins.joint2, Unit.DEG, 0),
        "ways not found": f"{figures.ways_missing}",
    }
    if not math.isinf(margins.clearance):
        told["clear of obstacles by, mm"] = clearance_told(margins.clearance).replace(" mm", "")
    return told
