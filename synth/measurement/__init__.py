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

from synth.measurement.arm_fit import ArmFit, fit_arm, marker_positions
from synth.measurement.examination import Examination, examine
from synth.measurement.inspection import Inspection, inspect
from synth.measurement.link_fit import LinkFit, fit_link
from synth.measurement.markers import MARKER_ERROR, Marker, Place, Readings, marker_named, sigma_of
from synth.measurement.misprint import Misprint, Suspect, find_misprint
from synth.measurement.nearest import Fit, Nearest, nearest_realisable
from synth.measurement.sampling import Samples, Spread, sample_shapes
from synth.measurement.standing_arm import StandingArm, rotation_matrix

__all__ = [
    "MARKER_ERROR",
    "ArmFit",
    "Examination",
    "Fit",
    "Inspection",
    "LinkFit",
    "Marker",
    "Misprint",
    "Nearest",
    "Place",
    "Readings",
    "Samples",
    "Spread",
    "StandingArm",
    "Suspect",
    "examine",
    "find_misprint",
    "fit_arm",
    "fit_link",
    "inspect",
    "marker_named",
    "marker_positions",
    "nearest_realisable",
    "rotation_matrix",
    "sample_shapes",
    "sigma_of",
]
