"""The peers that work on the quartic Gamma, in the squared distances: Ipopt, and SCIP for the bound."""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING

import casadi as ca
import numpy as np
import pyscipopt

from synth.errors import GeometryError
from synth.geometry import ArmDistances, SweptCircle
from synth.geometry._gamma_polynomials import workspace_polynomials
from synth.geometry.distances import realise
from synth.synthesis.shapes.shapes import Shapes

if TYPE_CHECKING:
    from peer_race import Race

    from synth.robot import Robot
    from synth.task import Task

_TYPICAL = 0.2  # slope of Gamma / (s12 s34 / 4), m^3: brings Gamma to the scale of a length


def _hardware(robot: Robot) -> tuple[float, float, float, float]:
    """Return s12, s34, s35, s45."""
    rigid = robot.rigid_link
    return robot.d12**2, robot.d34**2, rigid.d35.lower**2, rigid.d45.lower**2


def _longest(robot: Robot) -> tuple[np.ndarray, np.ndarray]:
    """Return the box of s13, s14, s23, s24: no longer than a straight link allows."""
    reach = robot.link.length.upper + max(robot.tip_offset, robot.d34 - robot.tip_offset)
    return np.zeros(4), np.array([reach + robot.d12, reach + robot.d12, reach, reach]) ** 2


def _gamma_terms(robot: Robot, s) -> tuple:
    """Return q0, ..., q5 over s12 s34 / 4 of numbers or symbols s = (s13, s14, s23, s24)."""
    s12, s34, s35, s45 = _hardware(robot)
    q, _ = workspace_polynomials(s12, s[0], s[1], s[2], s[3], s34, s35, s45)
    return tuple(term * (4.0 / (s12 * s34)) for term in q)


def _feasibility(robot: Robot, s) -> list:
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
    q = _gamma_terms(robot, [s[i] for i in range(4)])
    objective = ca.SX(0.0)
    for x, y, z in targets:
        n = x * x + y * y + z * z
        monomials = (n * n, robot.d12 * z * n, x * x + y * y, z * z, robot.d12 * z, 1.0)
        gamma = sum(term * monomial for term, monomial in zip(q, monomials, strict=True))
        objective += (1e3 * gamma / _TYPICAL) ** 2 / len(targets)
    constraints = ca.vertcat(*_feasibility(robot, [s[i] for i in range(4)]))
    options = {"print_time": False, "ipopt.print_level": 0, "ipopt.sb": "yes", "ipopt.tol": 1e-10}
    solver = ca.nlpsol("raw", "ipopt", {"x": s, "f": objective, "g": constraints}, options)
    lower, upper = _longest(robot)
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


def scip_bound(task: Task, seconds: float) -> tuple[float, float, float, str]:
    """Let SCIP minimise the worst miss over all surfaces: return bound, best, time and status.

    Unknowns: the four squared distances, the coefficients of Gamma, and for each target the point
    (rho, z) of the surface in its half-plane. Link and joint limits are ignored.
    """
    robot, model = task.robot, pyscipopt.Model()
    model.hideOutput()
    model.setParam("limits/time", seconds)
    lower, upper = _longest(robot)
    s = [model.addVar(f"s{i}", lb=lower[i], ub=upper[i]) for i in range(4)]
    for slack in _feasibility(robot, s):
        model.addCons(slack >= 0.0)
    q = []
    for i, term in enumerate(_gamma_terms(robot, s)):
        q.append(model.addVar(f"q{i}", lb=None))
        model.addCons(q[-1] == term)
    far = robot.d12 + robot.link.length.upper + robot.rigid_link.d35.upper + robot.d34
    worst = model.addVar("worst", lb=0.0, ub=far)
    for i, (x, y, z_target) in enumerate(task.positions_in_base):
        rho, z = model.addVar(f"rho{i}", lb=0.0, ub=far), model.addVar(f"z{i}", lb=-far, ub=far)
        n = model.addVar(f"N{i}", lb=0.0, ub=far**2)
        model.addCons(n == rho * rho + z * z)
        height = robot.d12 * z
        model.addCons(
            q[0] * n * n + q[1] * height * n + q[2] * rho * rho + q[3] * z * z + q[4] * height + q[5] == 0.0
        )
        off = (rho - math.hypot(x, y)) * (rho - math.hypot(x, y)) + (z - z_target) * (z - z_target)
        model.addCons(off <= worst * worst)
    model.setObjective(worst)
    began = time.perf_counter()
    model.optimize()
    best = model.getObjVal() if model.getNSols() else math.inf
    return model.getDualbound(), best, time.perf_counter() - began, model.getStatus()
