"""Arms that stand somewhere else than they were wanted, and noisy markers of them."""

from __future__ import annotations

import numpy as np
from planted import ROBOT, planted_arm

from synth.measurement import MARKER_ERROR, Readings, StandingArm, marker_named, marker_positions, sigma_of

SIGMA = sigma_of(MARKER_ERROR)
BARS = "P1 P2 P3 P4 P5 A2:-150 A2:150"
HOLD = np.pi


def standing(seed, joint1=HOLD):
    """Return the arm that was wanted, and one whose end is some 9 mm and 4 deg off."""
    rng = np.random.default_rng(seed)
    wanted = StandingArm.of(planted_arm(rng), joint1)
    off = np.concatenate([rng.normal(size=3) * 5.5e-3, rng.normal(size=3) * 0.04])
    return wanted, wanted.moved(off)


def seen(arm, names, rng=None, joints=None):
    """Return readings of markers by name, with noise if there is a generator."""
    markers = tuple(marker_named(name, ROBOT) for name in names.split())
    joints = np.tile([arm.joint1, np.pi], (len(markers), 1)) if joints is None else np.asarray(joints)
    exact = Readings(markers, np.zeros((len(markers), 3)), joints)
    positions = marker_positions(arm, exact, ROBOT.tip_offset)
    noise = 0.0 if rng is None else SIGMA * rng.normal(size=positions.shape)
    return Readings(markers, positions + noise, joints)
