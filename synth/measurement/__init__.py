"""The measured robot: from distances or markers to what shape it is in, and how sure that is.

Measured distances are in general those of no points at all: `nearest_realisable` finds the points in space
that come nearest within the bounds of the measurement, `find_misprint` the number that cannot be right,
`sample_shapes` what the bounds leave open, `fit_link` a shape of the link that takes the pose. `inspect` asks
all of them.

    Measurement -> misprint -> nearest points -> samples and their spread -> Inspection
"""

from synth.measurement.inspection import Inspection, inspect
from synth.measurement.link_fit import LinkFit, fit_link
from synth.measurement.misprint import Misprint, Suspect, find_misprint
from synth.measurement.nearest import Fit, Nearest, nearest_realisable
from synth.measurement.sampling import Samples, Spread, sample_shapes

__all__ = [
    "Fit",
    "Inspection",
    "LinkFit",
    "Misprint",
    "Nearest",
    "Samples",
    "Spread",
    "Suspect",
    "find_misprint",
    "fit_link",
    "inspect",
    "nearest_realisable",
    "sample_shapes",
]
