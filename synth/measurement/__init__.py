"""The measured robot: from distances or markers to what shape it is in, and how sure that is.

Measured distances are in general those of no points at all: `nearest_realisable` finds the points in space
that come nearest within the bounds of the measurement, `find_misprint` the number that cannot be right,
`sample_shapes` what the bounds leave open, `fit_link` a shape of the link that takes the pose. `inspect` asks
all of them.

    Measurement -> misprint -> nearest points -> samples and their spread -> Inspection

Markers say where both axes are: `examine` refuses or mends what cannot be, `fit_arm` finds the
arm that stands there, with its covariance.

    Readings -> Examination -> ArmFit
"""

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
from synth.measurement.markers import (
    MARKER_ERROR,
    ArmFit,
    Calibration,
    Examination,
    Marker,
    Place,
    Readings,
    StandingArm,
    calibrate,
    cross,
    examine,
    fit_arm,
    joints_closest_to,
    joints_following,
    left_to_joints,
    load_points,
    load_readings,
    marker_named,
    marker_positions,
    onto_vertical,
    rotation_matrix,
    sigma_of,
)
from synth.measurement.schema import measured_schema

__all__ = [
    "MARKER_ERROR",
    "ArmFit",
    "Calibration",
    "Examination",
    "Fit",
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
    "calibrate",
    "cross",
    "examine",
    "find_misprint",
    "fit_arm",
    "fit_link",
    "inspect",
    "joints_closest_to",
    "joints_following",
    "left_to_joints",
    "load_measurements",
    "load_points",
    "load_readings",
    "marker_named",
    "marker_positions",
    "measured_schema",
    "nearest_realisable",
    "onto_vertical",
    "rotation_matrix",
    "sample_shapes",
    "sigma_of",
]
