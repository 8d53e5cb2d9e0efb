"""From a file of markers to what is to be believed of it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from synth.measurement.markers.examination import Examination, examine
from synth.measurement.markers.marker_file import load_readings, load_unnamed
from synth.measurement.markers.markers import markers_named
from synth.measurement.markers.matching import matched

if TYPE_CHECKING:
    import os

    from synth.measurement.markers.standing_arm import StandingArm
    from synth.robot import Robot


def examine_file(
    path: str | os.PathLike[str],
    robot: Robot,
    wanted: StandingArm,
    sigma: float,
    *,
    base_calibrated: bool,
    markers: str = "",
) -> Examination:
    """Return what is to be believed of a file of markers; what was noticed is among the warnings of `used`.

    Args:
        path: The file.
        robot: The hardware.
        wanted: The arm that should stand there, with joint 1 where the sheet holds it.
        sigma: Standard deviation of each coordinate of a marker, m.
        base_calibrated: Whether axis 1 is known to be the z axis of the frame.
        markers: Names of the markers that the arm bears, with spaces between, where the file does not say
            which is which.

    Raises:
        InputError: The file cannot be read or is wrong, or there are no such markers.
    """
    if not markers:
        readings = load_readings(path, robot, wanted.joint1)
        return examine(readings, wanted, robot, sigma, base_calibrated=base_calibrated)
    borne = markers_named(markers, robot)
    found = matched(
        load_unnamed(path), borne, wanted, robot.tip_offset, sigma, base_calibrated=base_calibrated
    )
    if found.refusal:
        return Examination(None, found.readings, refusal=found.refusal)
    return examine(found.readings, wanted, robot, sigma, base_calibrated=base_calibrated)
