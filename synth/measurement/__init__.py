"""The measured robot: from distances or markers to what shape it is in, and how sure that is.

Measured distances are in general those of no points at all: `nearest_realisable` finds the points in space
that come nearest within the bounds of the measurement, `find_misprint` the number that cannot be right,
`sample_shapes` what the bounds leave open, `fit_link` a shape of the link that takes the pose. `inspect` asks
all of them.

    Measurement -> misprint -> nearest points -> samples and their spread -> Inspection

Markers say where both axes are: `examine` refuses or mends what cannot be, `fit_arm` finds the
arm that stands there, with its covariance.

    Readings -> Examination -> ArmFit

Checks of what a hand bent tell how good it is: `learned_hand`.
"""

from synth.measurement.calibration import Calibration, calibrate
from synth.measurement.distances import (
    Fit,
    Inspection,
    LinkFit,
    Measurement,
    Misprint,
    Nearest,
    Samples,
    Spread,
    Suspect,
    find_misprint,
    fit_link,
    inspect,
    load_measurements,
    nearest_realisable,
    sample_shapes,
)
from synth.measurement.hand import (
    CHECK_SCHEMA,
    HAND_SCHEMA,
    SUPPOSED_COUNT,
    Deed,
    Hand,
    HandError,
    aim_of_check,
    errors_of_checks,
    hand_error,
    learned_hand,
    load_hand,
    random_errors,
)
from synth.measurement.markers import (
    MARKER_ERROR,
    ArmFit,
    Examination,
    Marker,
    Place,
    Readings,
    StandingArm,
    at_rest,
    cross,
    examine,
    examine_file,
    fit_arm,
    joints_closest_to,
    joints_following,
    left_to_joints,
    load_points,
    load_readings,
    marker_named,
    marker_positions,
    matched,
    onto_vertical,
    readings_of_lines,
    recorded_frames,
    rotation_between,
    rotation_matrix,
    sigma_of,
)
from synth.measurement.schema import measured_schema

__all__ = [
    "CHECK_SCHEMA",
    "HAND_SCHEMA",
    "MARKER_ERROR",
    "SUPPOSED_COUNT",
    "ArmFit",
    "Calibration",
    "Deed",
    "Examination",
    "Fit",
    "Hand",
    "HandError",
    "Inspection",
    "LinkFit",
    "Marker",
    "Measurement",
    "Misprint",
    "Nearest",
    "Place",
    "Readings",
    "Samples",
    "Spread",
    "StandingArm",
    "Suspect",
    "aim_of_check",
    "at_rest",
    "calibrate",
    "cross",
    "errors_of_checks",
    "examine",
    "examine_file",
    "find_misprint",
    "fit_arm",
    "fit_link",
    "hand_error",
    "inspect",
    "joints_closest_to",
    "joints_following",
    "learned_hand",
    "left_to_joints",
    "load_hand",
    "load_measurements",
    "load_points",
    "load_readings",
    "marker_named",
    "marker_positions",
    "matched",
    "measured_schema",
    "nearest_realisable",
    "onto_vertical",
    "random_errors",
    "readings_of_lines",
    "recorded_frames",
    "rotation_between",
    "rotation_matrix",
    "sample_shapes",
    "sigma_of",
]
