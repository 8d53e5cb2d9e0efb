"""Measured markers: where an arm stands, what it is, and how well its errors are known."""

from synth.measurement.markers.arm_fit import ArmFit, fit_arm, marker_positions
from synth.measurement.markers.calibration import Calibration, calibrate
from synth.measurement.markers.examination import Examination, examine
from synth.measurement.markers.marker_file import load_points, load_readings
from synth.measurement.markers.marker_rows import row_schema
from synth.measurement.markers.markers import MARKER_ERROR, Marker, Place, Readings, marker_named, sigma_of
from synth.measurement.markers.standing_arm import StandingArm, cross, onto_vertical, rotation_matrix
from synth.measurement.markers.standing_joints import joints_closest_to, joints_following, left_to_joints

__all__ = [
    "MARKER_ERROR",
    "ArmFit",
    "Calibration",
    "Examination",
    "Marker",
    "Place",
    "Readings",
    "StandingArm",
    "calibrate",
    "cross",
    "examine",
    "fit_arm",
    "joints_closest_to",
    "joints_following",
    "left_to_joints",
    "load_points",
    "load_readings",
    "marker_named",
    "marker_positions",
    "onto_vertical",
    "rotation_matrix",
    "row_schema",
    "sigma_of",
]
