"""The peer that works on the quartic Gamma, in the squared distances, and what a bound by it needs."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import casadi as ca
import numpy as np

from synth.errors import GeometryError
from synth.geometry import ArmDistances, SweptCircle
from synth.geometry._gamma_polynomials import workspace_polynomials
from synth.geometry.distances import realise
from synth.synthesis.shapes.shapes import Shapes

if TYPE_CHECKING:
    from peer_race import Race

    from synth.robot import Robot

_TYPICAL = 0.2  # slope of Gamma / (s12 s34 / 4), m^3: brings Gamma to the scale of a length


def _hardware(robot: Robot) -> tuple[float, float, float, float]:
    """Return s12, s34, s35, s45."""
    rigid = robot.rigid_link
    return robot.d12**2, robot.d34**2, rigid.d35.lower**2, rigid.d45.lower**2


def longest(robot: Robot) -> tuple[np.ndarray, np.ndarray]:
    """Return the box of s13, s14, s23, s24: no longer than a straight link allows."""
    reach = robot.link.length.upper + max(robot.tip_offset, robot.d34 - robot.tip_offset)
    return np.zeros(4), np.array([reach + robot.d12, reach + robot.d12, reach, reach]) ** 2


def gamma_terms(robot: Robot, s) -> tuple:
    """Return q0, ..., q5 over s12 s34 / 4 of numbers or symbols s = (s13, s14, s23, s24)."""
    s12, s34, s35, s45 = _hardware(robot)
    q, _ = workspace_polynomials(s12, s[0], s[1], s[2], s[3], s34, s35, s45)
    return tuple(term * (4.0 / (s12 * s34)) for term in q)


def feasibility(robot: Robot, s) -> list:
    """Return what must not be negative for P1, ..., P4 to exist: four triangles, one tetrahedron."""
    s12, s34, *_ = _hardware(robot)
    triangles = [(s12, s[0], s[2]), (s12, s[1], s[3]), (s[0], s[1], s34), (s[2], s[3], s34)]
    areas = [
        2.0 * (a * b + b * c + c * a) - a * a - b * b - c * c  # 16 times the squared area
        for a, b, c in triangles
    ]
    # The Gram matrix of P2, P3, P4 seen from P1.
    g23, g24, g34 = (s12 + s[0] - s[2]) / 2, (s12 + s[1] - s[3]) / 2, (s[0] + s[1] - s34) / 2
    volume = s12 * (s[0] * s[1] - g34 * g34) - g23 * (g23 * s[1] - g34 * g24) + g24 * (g23 * g34 - s[0] * g24)
    return [*areas, volume / (s12 * s34)]


def surface_misses(robot: Robot, s: np.ndarray, targets: np.ndarray) -> np.ndarray:
    """Return the distances of targets from the surface of an arm, its link and joint limits ignored."""
    distances = ArmDistances(robot.d12**2, *s, *_hardware(robot)[1:])
    # What the solver's tolerance left over goes; the surface judged is that of the points themselves.
    p3, p4 = realise(distances.axis_matrix, tolerance=1e-3)[2:]
    rigid = robot.rigid_link
    offset, radius = robot.end_effector_circle(rigid.d35.lower, rigid.d45.lower)
    axis = (p4 - p3) / np.linalg.norm(p4 - p3)
    return SweptCircle(p3 + (float(offset) + robot.tip_offset) * axis, axis, float(radius)).distance(targets)


def raw_gamma(race: Race) -> None:
    """Multi-start Ipopt: the sum of Gamma^2 over the targets, in s13, s14, s23, s24."""
    robot, targets = race.task.robot, race.targets
    s = ca.SX.sym("s", 4)
    q = gamma_terms(robot, [s[i] for i in range(4)])
    objective = ca.SX(0.0)
    for x, y, z in targets:
        n = x * x + y * y + z * z
        monomials = (n * n, robot.d12 * z * n, x * x + y * y, z * z, robot.d12 * z, 1.0)
        gamma = sum(term * monomial for term, monomial in zip(q, monomials, strict=True))
        objective += (1e3 * gamma / _TYPICAL) ** 2 / len(targets)
    constraints = ca.vertcat(*feasibility(robot, [s[i] for i in range(4)]))
    options = {"print_time": False, "ipopt.print_level": 0, "ipopt.sb": "yes", "ipopt.tol": 1e-10}
    solver = ca.nlpsol("raw", "ipopt", {"x": s, "f": objective, "g": constraints}, options)
    lower, upper = longest(robot)
    while not race.over:
        shapes = Shapes(robot, race.starts())
        for index in range(len(shapes.length)):
            start = shapes.arm(index, race.task.base).squared_distances[[0, 0, 1, 1], [2, 3, 2, 3]]
            answer = solver(x0=start, lbx=lower, ubx=upper, lbg=0.0, ubg=math.inf)["x"]
            try:
                misses = surface_misses(robot, np.asarray(answer.full()).ravel(), targets)
            except GeometryError:
                continue  # the solver stopped at distances that no points have
            if race.offer_misses(misses):
                return
