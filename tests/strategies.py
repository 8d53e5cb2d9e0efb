"""Hypothesis samplers of arms, with the degenerate families mixed in."""

import math
from typing import NamedTuple

import numpy as np
from hypothesis import strategies as st

from synth.geometry import ArmDistances, SweptCircle

# a, alpha, z0, h of each family; what it leaves open is drawn. All but the first are the
# places where a formula that was only tried on skew axes breaks.
FAMILIES = ("skew", "mirror", "parallel", "at P1", "at P2", "meeting", "coincident")
COPLANAR = ("parallel", "at P1", "at P2", "meeting")
HARDWARE = {"d12": 0.058, "d34": 0.049, "offset": -0.0222}  # m, the published prototype
LONG = {"d12": 0.5, "d34": 0.6, "offset": 0.25}


class Arm(NamedTuple):
    """An arm by axis 2 and its circle, with axis points marked on both axes."""

    family: str
    a: float
    alpha: float
    z0: float
    h: float
    circle: SweptCircle
    d12: float
    d34: float
    offset: float

    @property
    def distances(self) -> ArmDistances:
        return self.circle.squared_distances(self.d12, self.d34, self.offset)

    @property
    def axis_points(self):
        """P1, P2, P3, P4 by their definition, shape (4, 3)."""
        p3 = self.circle.centre - self.offset * self.circle.axis
        return np.array([[0, 0, 0], [0, 0, self.d12], p3, p3 + self.d34 * self.circle.axis])


def end_effector(circle, theta1, theta2):
    """P5 = Rz(theta1) [c + R (-cos(theta2) t - sin(theta2) u x t)], t any unit vector across u."""
    t = np.linalg.svd(circle.axis[None])[2][1]
    across = np.multiply.outer(np.cos(theta2), t) + np.multiply.outer(
        np.sin(theta2), np.cross(circle.axis, t)
    )
    x, y, z = np.moveaxis(circle.centre - circle.radius * across, -1, 0)
    c, s = np.cos(theta1), np.sin(theta1)
    return np.stack([c * x - s * y, s * x + c * y, z], axis=-1)


def make_arm(family, *, a=0.2, alpha=1.1, z0=0.15, h=0.3, radius=0.45, yaw=0.4, hand=1.0, baselines=HARDWARE):
    """Return an arm, with the numbers that its family fixes put in."""
    d12 = baselines["d12"]
    if family == "mirror":
        alpha, h = math.pi / 2, 0.0
    if family in {"parallel", "coincident"}:
        alpha = 0.0 if alpha < math.pi / 2 else math.pi
    if family in {"at P1", "at P2", "meeting", "coincident"}:
        a = 0.0
    z0 = {"at P1": 0.0, "at P2": d12}.get(family, z0)
    # sin(pi) is not 0 in floating point, but parallel shall mean parallel.
    sine = 0.0 if alpha in {0.0, math.pi} else hand * math.sin(alpha)
    c, s = math.cos(yaw), math.sin(yaw)
    rotation = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    axis = np.array([0.0, sine, math.cos(alpha)])
    circle = SweptCircle(rotation @ (np.array([a, 0.0, z0]) + h * axis), rotation @ axis, radius)
    return Arm(family, a, alpha, z0, h, circle, **baselines)


@st.composite
def arms(draw, families=FAMILIES, baselines=(HARDWARE, LONG)):
    """Draw an arm of realistic size; skew axes are at least 50 mm and 17 deg from special ones."""
    return make_arm(
        draw(st.sampled_from(families)),
        a=draw(st.floats(0.05, 0.5)),
        alpha=draw(st.floats(0.3, math.pi - 0.3)),
        z0=draw(st.floats(-0.3, 0.6)),
        h=draw(st.floats(-0.5, 0.5)),
        radius=draw(st.floats(0.1, 0.6)),
        yaw=draw(st.floats(-math.pi, math.pi)),
        hand=draw(st.sampled_from([1.0, -1.0])),
        baselines=draw(st.sampled_from(baselines)),
    )


def angles():
    """Draw an angle of a joint."""
    return st.floats(-math.pi, math.pi)


def points(count, dimension=3):
    """Draw points in a box of one metre; coincident ones and common planes do occur."""
    coordinate = st.one_of(st.sampled_from([0.0, 0.25]), st.floats(-0.5, 0.5, width=32))
    return st.lists(coordinate, min_size=count * dimension, max_size=count * dimension).map(
        lambda values: np.array(values).reshape(count, dimension)
    )
