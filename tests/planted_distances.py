"""Distances of planted points, as they are measured."""

import numpy as np
from planted import planted_arm

from synth.geometry import squared_distances
from synth.measurement.distances.measured import MeasuredDistances, Precision

MILLIMETRE = Precision.from_rounding(1e-3)
HARDWARE = ("d12", "d34", "d35", "d45")


def named(points):
    s = np.sqrt(squared_distances(points))
    return {f"d{i + 1}{j + 1}": float(s[i, j]) for i in range(len(s)) for j in range(i + 1, len(s))}


def planted_points(seed):
    rng = np.random.default_rng(seed)
    arm = planted_arm(rng)
    return np.vstack([arm.axis_points, arm.kinematics.forward(0.0, rng.uniform(0.9, 5.4))])


def as_measured(distances, precision=MILLIMETRE):
    known = {name: value for name, value in distances.items() if name in HARDWARE}
    return MeasuredDistances.of({k: v for k, v in distances.items() if k not in HARDWARE}, precision, known)


def rounded(distances):
    return {name: value if name in HARDWARE else round(value, 3) for name, value in distances.items()}
