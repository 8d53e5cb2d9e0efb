"""`markers.csv`: the points of the guide, for a spreadsheet or a motion capture program."""

from __future__ import annotations

import csv
import io
import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from synth.guide import Guide

COLUMNS = ("marker", "x_mm", "y_mm", "z_mm", "joint1_deg")


def markers_csv(guide: Guide | None) -> str:
    """Return the points at `guide.hold`, the posture that the operator measures against, as CSV.

    Args:
        guide: The guide, or None if there is no shape.

    Returns:
        A header, then a row for each of P1, ..., P4, L050, L100, ..., END: its place in the task frame
        in mm, and the angle of joint 1 at which it is there, in degrees. Only the header without a guide,
        or if the task is not met: these are no points to bend to.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    if guide is not None and guide.met:
        joint1 = f"{math.degrees(guide.hold.joint1):z.4f}"
        for name, point in guide.points(guide.hold).items():
            writer.writerow([name, *(f"{1e3 * value:z.4f}" for value in point), joint1])
    return text.getvalue()
