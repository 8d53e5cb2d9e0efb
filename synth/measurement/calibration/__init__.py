"""The real arm from positions of its end effector, after the link was stiffened."""

from synth.measurement.calibration.calibration import Calibration, calibrate

__all__ = ["Calibration", "calibrate"]
