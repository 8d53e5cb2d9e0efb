"""Measured distances: what d_ij of a configuration tell of the link, and which of them cannot be right."""

from synth.measurement.distances.inspection import Inspection, inspect
from synth.measurement.distances.link_fit import LinkFit, fit_link
from synth.measurement.distances.measured import Measurement
from synth.measurement.distances.misprint import Misprint, Suspect, find_misprint
from synth.measurement.distances.nearest import Fit, Nearest, nearest_realisable
from synth.measurement.distances.reading import load_measurements
from synth.measurement.distances.sampling import Samples, Spread, sample_shapes
from synth.measurement.distances.schema import MeasuredFile

__all__ = [
    "Fit",
    "Inspection",
    "LinkFit",
    "MeasuredFile",
    "Measurement",
    "Misprint",
    "Nearest",
    "Samples",
    "Spread",
    "Suspect",
    "find_misprint",
    "fit_link",
    "inspect",
    "load_measurements",
    "nearest_realisable",
    "sample_shapes",
]
