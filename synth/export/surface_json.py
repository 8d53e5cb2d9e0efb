"""What a solution covers of surfaces, and how it follows paths, as plain data."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from synth.synthesis import Between, Design

_MOST_POINTS = 10_000  # that are not covered of a surface; of more these, and how many there are


def surfaces_to_json(design: Design) -> list[object]:
    """Return what is covered of each surface, and what is proven of it between its samples."""
    proven = {each.name: each for each in design.verification.between}
    return [
        {
            "name": each.name,
            "coverage": each.asked,
            "share": each.share,
            "covered": each.met and getattr(proven.get(each.name), "met", True),
            "largest": each.largest,
            "rms": each.rms,
            "percentile_95": each.percentile_95,
            "uncovered": each.uncovered[:_MOST_POINTS],
            "uncovered_points": len(each.uncovered),
            "between": _between(proven.get(each.name)),
        }
        for each in design.verification.coverings
    ]


def paths_to_json(design: Design) -> list[object]:
    """Return how each path is followed: the joint angles along it, and how far P5 strays at most."""
    return [
        {
            "name": each.name,
            "followed": each.met,
            "tolerance": each.tolerance,
            "largest": each.largest,
            "seen": each.seen,
            "lengths": each.lengths,
            "times": each.times if each.met else None,
            "points": each.points,
            "joints": each.joints,
            "joint_speeds": each.joint_speeds,
            "breaks": each.breaks,
            "jump": each.jump,
        }
        for each in design.verification.followed
    ]


def _between(proven: Between | None) -> dict[str, object] | None:
    """Return what is proven of a surface; None where it is not known between its points, or not looked at."""
    if proven is None:
        return None
    return {"share": proven.share, "largest": proven.largest, "cells": proven.cells, "width": proven.width}
