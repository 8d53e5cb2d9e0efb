"""Captures: what the software of tracking systems exports, as a table of frames."""

from synth.measurement.captures.capture import FARTHEST, MISTAKES_AT_MOST, Capture, Track, shown
from synth.measurement.captures.cells import is_gap, number_of
from synth.measurement.captures.content import content_of

__all__ = ["FARTHEST", "MISTAKES_AT_MOST", "Capture", "Track", "content_of", "is_gap", "number_of", "shown"]
