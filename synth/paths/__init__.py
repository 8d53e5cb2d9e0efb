"""Paths to be followed: waypoints, and the curve through them."""

from synth.paths.path import SAMPLES, Interpolation, Path

__all__ = ["SAMPLES", "Interpolation", "Path"]
