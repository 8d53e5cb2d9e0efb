"""Which marker is which, where a file does not say: the names with which all fit one arm.

Points are assigned to the markers that an arm would show there (Kuhn 1955, the assignment of least distance),
the arm is fitted to them, and both again until nothing changes: iterated closest points (Besl, McKay 1992).
It begins with arms as a hand may have placed them. Distances between markers on one axis, and to the end
effector, tell wrong names from right ones; where two ways of naming fit as well, neither is believed.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import frozen_value
from synth.measurement.markers.arm_fit import fit_arm, marker_positions
from synth.measurement.markers.examination import what_is_missing
from synth.measurement.markers.frames import PLAUSIBLE, frames_with_z_up
from synth.measurement.markers.marker_file import STRAIGHT_ON
from synth.measurement.markers.markers import Place, Readings

if TYPE_CHECKING:
    from collections.abc import Sequence

    from synth.arrays import FloatArray
    from synth.measurement.markers.markers import Marker
    from synth.measurement.markers.standing_arm import StandingArm

_NONE = Readings((), np.empty((0, 3)), np.empty((0, 2)))
_STARTS = 24
_PLACED = np.repeat([10e-3, np.radians(4.0)], 3)  # m and rad, about twice as far as a hand is off
_ITERATIONS = 8
_FAR, _NEAR = 0.08, 0.004  # m; how far a point may be from its marker, at first and in the end


@frozen_value
class Matched:
    """Points with names, or the reason why they have none.

    Attributes:
        readings: The points that are markers; none if they cannot be told.
        refusal: Why not, as a sentence, or empty.
    """

    readings: Readings
    refusal: str = ""


def matched(
    points: FloatArray,
    markers: Sequence[Marker],
    wanted: StandingArm,
    tip_offset: float,
    sigma: float,
    *,
    base_calibrated: bool,
) -> Matched:
    """Return points with the names of the markers that they are.

    Args:
        points: Where something was seen while the arm was at rest, shape (n, 3), m; not all need be markers.
        markers: The markers that the arm bears; not all need have been seen.
        wanted: The arm that should stand there, with joint 1 where it stood; joint 2 stood straight on.
        tip_offset: From P3 along axis 2 to the link's end, m.
        sigma: Standard deviation of each coordinate of a marker, m.
        base_calibrated: Whether axis 1 is known to be the z axis of the frame.
    """
    markers = tuple(marker for marker in markers if marker.place is not Place.LINK)
    template = Readings(
        markers, np.zeros((len(markers), 3)), np.tile([wanted.joint1, STRAIGHT_ON], (len(markers), 1))
    )
    named: dict[tuple[int, ...], Readings] = {}
    rng = np.random.default_rng(0)
    displaced = _PLACED * rng.normal(size=(_STARTS, 6)) / np.sqrt(3.0)
    displaced[0] = 0.0
    for said, turn in frames_with_z_up().items():
        turned = points @ turn.T
        for start in displaced:
            found = _iterated(
                turned, template, wanted.moved(start), tip_offset, sigma, calibrated=base_calibrated
            )
            if found is not None:
                assigned, readings = found
                named[assigned] = replace(readings, warnings=(said,) if said else ())
    return _chosen(named, len(points), [marker.name for marker in markers])


def _iterated(
    points: FloatArray,
    template: Readings,
    arm: StandingArm,
    tip_offset: float,
    sigma: float,
    *,
    calibrated: bool,
) -> tuple[tuple[int, ...], Readings] | None:
    """Return for each marker the number of its point, or -1, and the readings; None if no arm fits."""
    from scipy.optimize import linear_sum_assignment  # type: ignore[import-untyped]  # noqa: PLC0415

    far, before = _FAR, None
    for _ in range(_ITERATIONS):
        expected = marker_positions(arm, template, tip_offset)
        away = np.linalg.norm(expected[:, None] - points, axis=-1)
        rows, columns = linear_sum_assignment(np.minimum(away, far))
        assigned = np.full(len(expected), -1)
        near = away[rows, columns] < far
        assigned[rows[near]] = columns[near]
        seen = np.flatnonzero(assigned >= 0).tolist()
        some = template.take(seen)
        readings = Readings(some.markers, points[assigned[seen]], some.joints)
        if not seen or what_is_missing(readings, base_calibrated=calibrated):
            return None
        fit = fit_arm(readings, arm, tip_offset, sigma, base_calibrated=calibrated)
        arm = fit.arm
        now = tuple(assigned.tolist())
        if far == _NEAR and before == now:
            return (now, readings) if fit.plausibility >= PLAUSIBLE else None
        far, before = max(0.5 * far, _NEAR), now
    return None


def _chosen(named: dict[tuple[int, ...], Readings], count: int, names: Sequence[str]) -> Matched:
    """Return the naming with the most markers, if it is the only one."""
    if not named:
        of = ", ".join(names)
        return Matched(
            _NONE, f"the {count} points fit no arm with the markers {of} near where it should stand"
        )
    most = max(len(readings.markers) for readings in named.values())
    best = [readings for readings in named.values() if len(readings.markers) == most]
    if len(best) > 1:
        first, second = (
            {name: tuple(p) for name, p in zip(r.names, r.positions, strict=True)} for r in best[:2]
        )
        differ = [name for name in first if second.get(name) != first[name]] or list(first)
        return Matched(
            _NONE,
            f"which point is {' and which '.join(differ[:3])} cannot be told: name them, or add a marker",
        )
    readings, said = best[0], list(best[0].warnings)
    said.append(f"names were given by where the arm must be: {', '.join(readings.names)}")
    unseen = [name for name in names if name not in readings.names]
    said += [f"{name} was not seen" for name in unseen]
    if count > most:
        said.append(f"passed over, being no markers of this arm: {count - most} points")
    return Matched(replace(readings, warnings=tuple(said)))
