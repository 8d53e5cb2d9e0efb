"""`inspect.json`: an inspection as plain data of the schema `synth.inspection/1`, in metres and radians."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from synth.export.json_data import plain
from synth.version import __version__

if TYPE_CHECKING:
    from collections.abc import Sequence

    from synth.measurement import Inspection, Nearest

SCHEMA = "synth.inspection/1"


def inspections_to_json(inspections: Sequence[Inspection]) -> dict[str, Any]:
    """Return inspections as plain data.

    Args:
        inspections: One for each measured shape.

    Returns:
        Dictionaries, lists, strings, numbers and None, for `json.dumps(..., allow_nan=False)`.
    """
    content = {
        "schema": SCHEMA,
        "version": __version__,
        "realisable": all(inspection.is_realisable for inspection in inspections),
        "configurations": [_configuration(inspection) for inspection in inspections],
    }
    return plain(content)


def _configuration(inspection: Inspection) -> dict[str, object]:
    measurement, misprint = inspection.measurement, inspection.misprint
    distances, shape = measurement.distances, inspection.link.arm.shape
    return {
        "name": measurement.name,
        "intended": None if measurement.intended is None else measurement.intended.value,
        "realisable": inspection.is_realisable,
        "measured": {
            name: {"value": value, "lower": lower, "upper": upper}
            for name, value, lower, upper in zip(
                distances.names, distances.values, distances.lower, distances.upper, strict=True
            )
        },
        "misprint": None
        if misprint is None
        else {"reasons": misprint.reasons, "suspects": misprint.suspects},
        "axes": _nearest(inspection.axes),
        "with_end_effector": _nearest(inspection.whole) if measurement.has_pose else None,
        "invariants": inspection.invariants,
        "category_distances": inspection.category_distances,
        "misfit": inspection.misfit,
        "samples": 0 if inspection.samples is None else len(inspection.samples),
        "spreads": inspection.spreads,
        "link": {
            "found": inspection.link.found,
            "obstacle": inspection.link.obstacle or None,
            "beyond": inspection.link.beyond,
            "length": shape.length,
            "min_bend_radius": shape.min_bend_radius,
            "arcs": [
                {"curvature": curvature, "length": length}
                for curvature, length in zip(shape.curvatures, shape.lengths, strict=True)
            ],
        },
        "seed": inspection.seed,
    }


def _nearest(nearest: Nearest) -> dict[str, object]:
    names = nearest.measured.names
    return {
        "fit": nearest.fit.value,
        "points": {f"P{index + 1}": point for index, point in enumerate(nearest.points)},
        "distances": dict(zip(names, nearest.distances, strict=True)),
        "residuals": dict(zip(names, nearest.residuals, strict=True)),
        "beyond": dict(zip(names, nearest.beyond, strict=True)),
    }
