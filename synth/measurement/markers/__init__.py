"""Measured markers: where an arm stands, what it is, and how well its errors are known."""

from synth.measurement.markers.arm_fit import ArmFit, fit_arm, marker_positions
from synth.measurement.markers.capture_markers import streamed_markers
from synth.measurement.markers.examination import Examination, examine
from synth.measurement.markers.examined_file import examine_file
from synth.measurement.markers.frame_by_frame import (
    at_rest,
    readings_of_lines,
    readings_of_points,
    recorded_frames,
)
from synth.measurement.markers.frames import axis_up, turn_to_z
from synth.measurement.markers.marker_file import load_points, load_readings, load_unnamed
from synth.measurement.markers.marker_rows import row_schema
from synth.measurement.markers.markers import (
    MARKER_ERROR,
    Marker,
    Place,
    Readings,
    marker_named,
    markers_named,
    sigma_of,
)
from synth.measurement.markers.matching import Matched, matched
from synth.measurement.markers.standing_arm import (
    StandingArm,
    cross,
    onto_vertical,
    rotation_between,
    rotation_matrix,
)
from synth.measurement.markers.standing_joints import joints_closest_to, joints_following, left_to_joints

__all__ = [
    "MARKER_ERROR",
    "ArmFit",
    "Examination",
    "Marker",
    "Matched",
    "Place",
    "Readings",
    "StandingArm",
    "at_rest",
    "axis_up",
    "cross",
    "examine",
    "examine_file",
    "fit_arm",
    "joints_closest_to",
    "joints_following",
    "left_to_joints",
    "load_points",
    "load_readings",
    "load_unnamed",
    "marker_named",
    "marker_positions",
    "markers_named",
    "matched",
    "onto_vertical",
    "readings_of_lines",
    "readings_of_points",
    "recorded_frames",
    "rotation_between",
    "rotation_matrix",
    "row_schema",
    "sigma_of",
    "streamed_markers",
    "turn_to_z",
]
