"""The nonlinear program that polishes a shape, in CasADi: the only module that imports it.

"Gamma passes through the targets" is not written as Gamma = 0. In three of the four categories Gamma
is a perfect square, so it vanishes together with its gradient and no constraint qualification holds.
The program is lifted instead: each target keeps its joint angles and its miss as unknowns, tied by

    P5(theta1, theta2; end of the link) - target = miss,

which is the same surface (Gamma = 0 where the miss is zero) and is regular for every shape.

Unknowns, in metres and radians but for the curvatures, which are in units of the largest one:

    curvature   (kx, ky) of each of the equal arcs             2 m
    length      of the link                                    1
    s           s13, s14, s23, s24                             4
    rigid       s35, s45, and the circle of P5, where free     0 or 4
    joints      theta1, theta2 of each target                  2 n
    miss        vector from each target to P5                  3 n
    overlap     depth in obstacles allowed at each target      n + 1, where planes are given
    worst       largest weighted (miss / tolerance)^2          1, for the minimax objective

Objective: the weighted (miss / tolerance)^2, summed or worst, plus a small multiple of the bending
energy, which chooses the gentlest among the shapes that miss alike. Overlaps cost more than any miss.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import casadi as ca
import numpy as np

from synth.errors import SolverError
from synth.robot import Arm, LinkShape
from synth.synthesis.separation import COLUMN, PIECES, ROD
from synth.task import Objective, Topology

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import ArrayLike

    from synth.arrays import FloatArray
    from synth.robot import Robot
    from synth.synthesis.separation import Separation
    from synth.task import Task

# The weight of r * (bending energy) against squared misses in units of the tolerance. It shifts a
# miss by about 1e-6 of the tolerance: invisible, and yet it settles every free direction.
_GENTLENESS = 1e-4
# Curvature 1e-5 / m is straight; it keeps |k| differentiable at zero.
_STRAIGHT = 1e-10
# The solver keeps this much clear, m, so that what it oversteps is not missing afterwards.
_CLEARANCE = 2e-4
# An overlap costs as much as the last bit of a miss of this size, m; it is measured in units of this
# length, m, because the solver scales the objective down by its steepest slope.
_LARGE_MISS = 0.01
_OVERLAP_UNIT = 1e-3
# Barrier and distance from the bounds with which the solver begins near the answer.
_NEAR = 1e-6
_PUSHES = ("ipopt.bound_push", "ipopt.bound_frac", "ipopt.slack_bound_push", "ipopt.slack_bound_frac")
# With a smaller circle of the end effector, m, the second joint is not worth its name.
_LEAST_RADIUS = 1e-3
# `topology: general` keeps this far from the special categories: twice what still counts as one.
_GENERAL_DISTANCE = 2e-3
_GENERAL_ANGLE = math.radians(0.2)

_ANSWERS = frozenset(
    {
        "Solve_Succeeded",
        "Solved_To_Acceptable_Level",
        "Feasible_Point_Found",
        "Search_Direction_Becomes_Too_Small",
        "Maximum_Iterations_Exceeded",
        "Maximum_WallTime_Exceeded",
        "User_Requested_Stop",
        "Infeasible_Problem_Detected",
        "Restoration_Failed",
        "Diverging_Iterates",
    }
)


@dataclass(frozen=True)
class NlpAnswer:
    """Where the solver stopped. A claim only: the verification decides what it is worth.

    Attributes:
        arm: The robot in the shape found.
        joints: Its joint angles for each target, shape (n, 2), rad.
        status: The solver's own word for how it ended.
        iterations: How many iterations it took.
    """

    arm: Arm
    joints: FloatArray
    status: str
    iterations: int


@dataclass
class _Block:
    """A named group of unknowns or constraints with its bounds."""

    expressions: list[ca.SX] = field(default_factory=list)
    lower: list[FloatArray] = field(default_factory=list)
    upper: list[FloatArray] = field(default_factory=list)

    def add(self, expression: ca.SX, lower: float, upper: float) -> ca.SX:
        count = expression.numel()
        self.expressions.append(ca.vec(expression))
        self.lower.append(np.full(count, lower))
        self.upper.append(np.full(count, upper))
        return expression

    def unknown(self, name: str, shape: tuple[int, int], lower: float, upper: float) -> ca.SX:
        return self.add(ca.SX.sym(name, *shape), lower, upper)


@dataclass(frozen=True)
class _Piece:
    """A convex piece of the arm at joint 1 = 0: its ends, and what is within how far of their chord, m."""

    ends: list[ca.SX]
    thickness: ca.SX


@dataclass(frozen=True)
class Structure:
    """What tasks have in common that are solved by one program; all else it gets as parameters.

    Attributes:
        robot: The hardware.
        count: Number n of targets.
        has_floor: Whether there is a floor, at whatever height.
        topology: Kind of shape asked for.
        objective: Norm of the misses.
    """

    robot: Robot
    count: int
    has_floor: bool
    topology: Topology
    objective: Objective

    @classmethod
    def of(cls, task: Task) -> Structure:
        """Return the structure of a task."""
        return cls(task.robot, len(task.targets), task.floor is not None, task.topology, task.objective)


@lru_cache(maxsize=16)
def shared_nlp(structure: Structure, arcs: int, near: bool, thread: int) -> SynthesisNlp:
    """Return the program of a structure, without planes: to build it takes as long as three solves.

    A solver holds the iterates of its run, and two threads in one solver crash the interpreter. So the
    calling thread, `threading.get_ident()`, is part of the key: each thread has programs of its own.
    Nothing is remembered from one solve to the next; it only saves the time to build the same again.
    """
    del thread
    return SynthesisNlp(structure, arcs, near=near)


class SynthesisNlp:
    """The program of tasks of one structure, built once and solved from many starts.

    Args:
        structure: What the tasks have in common.
        arcs: Number m of equal arcs of the link, a divisor of PIECES.
        planes: What keeps the arm apart from obstacles and from itself.
        near: Whether it starts near the answer, as from the solution of a neighbour.
    """

    def __init__(
        self, structure: Structure, arcs: int, planes: Sequence[Separation] = (), *, near: bool = False
    ) -> None:
        self._structure = structure
        self._near = near
        self._arcs = arcs
        robot, count = structure.robot, structure.count
        self._x, self._g = _Block(), _Block()
        x = self._x
        positions = ca.SX.sym("positions", count, 3)
        weights = ca.SX.sym("weights", count)  # over the squared tolerances
        self._floor = ca.SX.sym("floor")
        steepest = ca.SX.sym("steepest")

        curvature = x.unknown("curvature", (2, arcs), -1.0, 1.0)
        length = x.unknown("length", (1, 1), robot.link.length.lower, robot.link.length.upper)
        pieces, position, frame = self._link(curvature, length)
        u, v, t = frame[:, 0], frame[:, 1], frame[:, 2]
        p3 = position - robot.tip_offset * u
        p4 = p3 + robot.d34 * u

        s = x.unknown("s", (4, 1), 0.0, math.inf)
        p1, p2 = ca.DM.zeros(3), ca.DM([0.0, 0.0, robot.d12])
        ends = ((p1, p3), (p1, p4), (p2, p3), (p2, p4))
        self._equal(s - ca.vertcat(*(ca.sumsqr(b - a) for a, b in ends)))
        for point in (p3, p4):
            self._above_floor(point[2])
        self._ask_for_topology(position, u, v, t)

        offset, radius = self._end_effector_circle()
        centre = position + offset * u
        base, second = robot.joint_limits.base, robot.joint_limits.second
        theta1 = x.unknown("theta1", (count, 1), base.lower, base.upper)
        theta2 = x.unknown("theta2", (count, 1), second.lower, second.upper)
        miss = x.unknown("miss", (count, 3), -math.inf, math.inf)
        px, py, pz = (
            centre[axis] + radius * (ca.sin(theta2) * v[axis] - ca.cos(theta2) * t[axis]) for axis in range(3)
        )
        reached = ca.horzcat(
            ca.cos(theta1) * px - ca.sin(theta1) * py, ca.sin(theta1) * px + ca.cos(theta1) * py, pz
        )
        self._equal(reached - positions - miss)
        self._above_floor(pz - 0.5 * robot.rigid_link.diameter)
        self._overlaps = len(planes) and count + 1
        overlap = x.unknown("overlap", (self._overlaps, 1), 0.0, math.inf)
        tip = ca.horzcat(px, py, pz)
        for plane in planes:
            self._keep_apart(plane, pieces, tip, theta1, overlap)

        weighted = ca.sum2(miss**2) * weights
        if structure.objective is Objective.MINIMAX:
            misses = x.unknown("worst", (1, 1), 0.0, math.inf)
            self._g.add(weighted - misses, -math.inf, 0.0)
        else:
            misses = ca.sum1(weighted)
        bending_energy = ca.sumsqr(curvature) * length / (arcs * robot.link.min_bend_radius)
        objective = misses + _GENTLENESS * bending_energy + steepest * ca.sum1(overlap)
        self._solver = self._build(objective, ca.vertcat(ca.vec(positions), weights, self._floor, steepest))

    def solve(
        self, task: Task, start: Arm, joints: FloatArray, stop: Callable[[], bool] | None = None
    ) -> NlpAnswer:
        """Polish a shape.

        Args:
            task: The task, of this structure.
            start: The robot in a shape of `arcs` equal arcs.
            joints: Joint angles for each target to start from, shape (n, 2), rad.
            stop: Asked once an iteration; when it says yes, the solver ends with what it has.

        Returns:
            Where the solver stopped, whether or not that is any good.

        Raises:
            SolverError: The solver broke down without an answer.
            KeyboardInterrupt: The user interrupted the solver (which swallows the exception).
        """
        weights = task.weights / task.tolerances**2
        floor, steepest = task.floor or 0.0, 2.0 * _LARGE_MISS * _OVERLAP_UNIT * float(weights.max())
        self._watch.stop = stop
        x = self._solver(
            x0=self._pack(task, start, joints),
            p=np.concatenate([task.positions.T.ravel(), weights, [floor, steepest]]),
            lbx=np.concatenate(self._x.lower),
            ubx=np.concatenate(self._x.upper),
            lbg=np.concatenate(self._g.lower),
            ubg=np.concatenate(self._g.upper),
        )["x"]
        self._watch.stop = None
        statistics = self._solver.stats()
        status = str(statistics["return_status"])
        if status == "NonIpopt_Exception_Thrown":
            raise KeyboardInterrupt
        values = np.asarray(x.full()).ravel()
        if status not in _ANSWERS or not np.isfinite(values).all():
            raise SolverError(f"Ipopt ended with {status}")
        arm, found_joints = self._unpack(task, values)
        return NlpAnswer(arm, found_joints, status, int(statistics["iter_count"]))

    def _build(self, objective: ca.SX, parameters: ca.SX) -> ca.Function:
        x, g = ca.vertcat(*self._x.expressions), ca.vertcat(*self._g.expressions)
        options: dict[str, Any] = {
            "print_time": False,
            "ipopt.print_level": 0,
            "ipopt.sb": "yes",
            "ipopt.linear_solver": "mumps",
            "ipopt.max_iter": 300,
            "ipopt.tol": 1e-8,
            "ipopt.constr_viol_tol": 1e-9,
        }
        if self._near:
            options |= {"ipopt.mu_init": _NEAR} | dict.fromkeys(_PUSHES, _NEAR)
        elif self._overlaps:
            # From a shape that is nearly clear short first steps lead to a clear one; long ones lose it.
            options |= {"ipopt.mu_init": 1e-4} | dict.fromkeys(_PUSHES, 1e-5)
        # The solver keeps no reference to its callback: this object must.
        self._watch = options["iteration_callback"] = _Watch(x.numel(), g.numel(), parameters.numel())
        problem = {"x": x, "p": parameters, "f": objective, "g": g}
        return ca.nlpsol("synthesis", "ipopt", problem, options)

    def _equal(self, expression: ca.SX) -> None:
        self._g.add(expression, 0.0, 0.0)

    def _above_floor(self, height: ca.SX) -> None:
        if self._structure.has_floor:
            self._g.add(height - self._floor, 0.0, math.inf)

    def _link(self, curvature: ca.SX, length: ca.SX) -> tuple[dict[int, _Piece], ca.SX, ca.SX]:
        """Follow the arcs from P2 to the link's end, under the limits of bending and the floor.

        Returns:
            The pieces of the tube, position and frame of the link's end.
        """
        robot = self._structure.robot
        link, radius = robot.link, 0.5 * robot.link.diameter
        position: ca.SX = ca.SX([0.0, 0.0, robot.d12])
        frame: ca.SX = ca.SX.eye(3)
        pieces = {COLUMN: _Piece([ca.SX.zeros(3), position], ca.SX(radius))}
        arc_length, total_bend = length / self._arcs, ca.SX(0.0)
        parts = PIECES // self._arcs
        for arc in range(self._arcs):
            kx, ky = curvature[0, arc] * link.max_curvature, curvature[1, arc] * link.max_curvature
            bend = ca.sqrt(kx**2 + ky**2 + _STRAIGHT)
            # A piece bulges from its chord by (1 - cos(k l / 2)) / k <= k l^2 / 8.
            thickness = radius + bend * (arc_length / parts) ** 2 / 8.0
            before = position
            for part in range(1, parts + 1):
                turn = bend * arc_length * part / parts
                sine, versine = ca.sin(turn) / bend, 2.0 * (ca.sin(0.5 * turn) / bend) ** 2
                point = position + frame @ ca.vertcat(kx * versine, ky * versine, sine)
                self._above_floor(point[2] - thickness)
                # The link's very start is in its mount: it cannot move, and need not.
                pieces[len(pieces)] = _Piece([before, point] if len(pieces) > 1 else [point], thickness)
                before = point
            turned = ca.vertcat(
                ca.horzcat(1.0 - kx**2 * versine, -kx * ky * versine, kx * sine),
                ca.horzcat(-kx * ky * versine, 1.0 - ky**2 * versine, ky * sine),
                ca.horzcat(-kx * sine, -ky * sine, ca.cos(turn)),
            )
            position, frame = point, frame @ turned
            self._g.add(ca.sumsqr(curvature[:, arc]), -math.inf, 1.0)
            total_bend += turn
        if link.max_total_bend < math.inf:
            self._g.add(total_bend, -math.inf, link.max_total_bend)
        return pieces, position, frame

    def _keep_apart(
        self, plane: Separation, pieces: dict[int, _Piece], tip: ca.SX, theta1: ca.SX, overlap: ca.SX
    ) -> None:
        """Keep a piece on its side of a plane; `tip` is P5 at joint 1 = 0 for each target, (n, 3)."""
        normal: ca.SX = ca.SX(ca.DM(plane.normal))
        one = pieces[plane.piece] if plane.piece != ROD else self._rod(plane, pieces[PIECES], tip)
        thickness, allowed = one.thickness, _OVERLAP_UNIT * overlap[plane.target]  # ANY_TARGET is the last
        if plane.other is None:
            c, s = ca.cos(theta1[plane.target]), ca.sin(theta1[plane.target])
            # The direction turned back is the same as the piece turned forward.
            normal = ca.vertcat(c * normal[0] + s * normal[1], c * normal[1] - s * normal[0], normal[2])
            beyond = [ca.SX(plane.offset)]
        else:
            beyond = [ca.dot(normal, end) for end in pieces[plane.other].ends]
            thickness = thickness + pieces[plane.other].thickness
        for end in one.ends:
            for other in beyond:
                self._g.add(ca.dot(normal, end) - other - thickness + allowed, _CLEARANCE, math.inf)

    def _rod(self, plane: Separation, last: _Piece, tip: ca.SX) -> _Piece:
        """Return the rigid link; where it is kept apart from the tube, without the joint's diameter."""
        robot = self._structure.robot
        start, end = last.ends[-1], tip[plane.target, :].T
        if plane.other is not None:
            along = end - start
            start = start + robot.link.diameter / ca.norm_2(along) * along
        return _Piece([start, end], ca.SX(0.5 * robot.rigid_link.diameter))

    def _end_effector_circle(self) -> tuple[ca.SX, ca.SX]:
        """Return offset along axis 2 and radius of P5's circle; free rigid links get s35 and s45."""
        robot, rigid = self._structure.robot, self._structure.robot.rigid_link
        if rigid.is_fixed:
            fixed_offset, fixed_radius = robot.end_effector_circle(rigid.d35.lower, rigid.d45.lower)
            return ca.SX(fixed_offset), ca.SX(fixed_radius)
        s35 = self._x.unknown("s35", (1, 1), rigid.d35.lower**2, rigid.d35.upper**2)
        s45 = self._x.unknown("s45", (1, 1), rigid.d45.lower**2, rigid.d45.upper**2)
        # The circle is unknown, too, so that no step of the solver meets the root of a negative number.
        from_p3 = self._x.unknown("from_p3", (1, 1), -math.inf, math.inf)
        radius = self._x.unknown("radius", (1, 1), _LEAST_RADIUS, math.inf)
        self._equal(s35 - from_p3**2 - radius**2)
        self._equal(s45 - (from_p3 - robot.d34) ** 2 - radius**2)
        return from_p3 - robot.tip_offset, radius

    def _ask_for_topology(self, position: ca.SX, u: ca.SX, v: ca.SX, t: ca.SX) -> None:
        """Constrain the axes: two regular equations for each special category."""

        def from_axis_2(point: ca.DM) -> ca.SX:
            return ca.vertcat(ca.dot(position - point, v), ca.dot(position - point, t))

        p1, p2 = ca.DM.zeros(3), ca.DM([0.0, 0.0, self._structure.robot.d12])
        match self._structure.topology:
            case Topology.SPHERICAL:
                self._equal(from_axis_2(p1))
            case Topology.PUMA:
                self._equal(from_axis_2(p2))
            case Topology.SCARA:
                self._equal(u[:2])
            case Topology.GENERAL:
                for point in (p1, p2):
                    self._g.add(ca.sumsqr(from_axis_2(point)), _GENERAL_DISTANCE**2, math.inf)
                self._g.add(ca.sumsqr(u[:2]), math.sin(_GENERAL_ANGLE) ** 2, math.inf)
            case Topology.ANY:
                pass

    def _pack(self, task: Task, arm: Arm, joints: FloatArray) -> FloatArray:
        """Return the unknowns of a shape, in the order in which they were made."""
        radius = task.robot.link.min_bend_radius
        misses = arm.base.to_base(arm.forward_kinematics(joints[:, 0], joints[:, 1])) - task.positions
        squared = arm.squared_distances
        parts: list[ArrayLike] = [
            (arm.shape.curvatures * radius).ravel(),
            [arm.shape.length],
            squared[[0, 0, 1, 1], [2, 3, 2, 3]],
            [] if task.robot.rigid_link.is_fixed else self._rigid_link(arm),
            joints.T.ravel(),
            misses.T.ravel(),
            np.zeros(self._overlaps),
        ]
        if task.objective is Objective.MINIMAX:
            worst = np.max(task.weights * (np.linalg.norm(misses, axis=1) / task.tolerances) ** 2)
            parts.append([worst])
        return np.concatenate([np.asarray(part, dtype=np.float64) for part in parts])

    def _rigid_link(self, arm: Arm) -> list[float]:
        """Return the unknowns of a free rigid link: s35, s45, and the circle of P5."""
        offset, radius = arm.robot.end_effector_circle(arm.d35, arm.d45)
        return [arm.d35**2, arm.d45**2, float(offset) + arm.robot.tip_offset, float(radius)]

    def _unpack(self, task: Task, values: FloatArray) -> tuple[Arm, FloatArray]:
        """Return the shape that the unknowns describe, rounded into the bounds of the hardware."""
        arcs, robot, rigid = self._arcs, task.robot, task.robot.rigid_link
        curvature, rest = values[: 2 * arcs].reshape(arcs, 2), values[2 * arcs :]
        # The solver may overstep a bound by its own tolerance, 1e-8.
        curvature = curvature / np.maximum(1.0, np.linalg.norm(curvature, axis=1))[:, None]
        length = float(np.clip(rest[0], robot.link.length.lower, robot.link.length.upper))
        shape = LinkShape(curvature * robot.link.max_curvature, np.full(arcs, length / arcs))
        rest = rest[5:]
        d35, d45 = rigid.d35.lower, rigid.d45.lower
        if not rigid.is_fixed:
            d35 = float(np.clip(math.sqrt(rest[0]), rigid.d35.lower, rigid.d35.upper))
            d45 = float(np.clip(math.sqrt(rest[1]), rigid.d45.lower, rigid.d45.upper))
            rest = rest[4:]
        limits = robot.joint_limits
        joints = rest[: 2 * len(task.targets)].reshape(2, -1).T
        joints = np.clip(
            joints, [limits.base.lower, limits.second.lower], [limits.base.upper, limits.second.upper]
        )
        return Arm(robot, shape, d35, d45, task.base), joints


class _Watch(ca.Callback):
    """Asked by Ipopt once an iteration whether to go on."""

    def __init__(self, unknowns: int, constraints: int, parameters: int) -> None:
        ca.Callback.__init__(self)
        self._rows = {"x": unknowns, "lam_x": unknowns, "f": 1, "g": constraints, "lam_g": constraints}
        self._rows["lam_p"] = parameters
        self.stop: Callable[[], bool] | None = None
        self.construct("watch", {})

    def get_n_in(self) -> int:
        return int(ca.nlpsol_n_out())

    def get_n_out(self) -> int:
        return 1

    def get_name_in(self, index: int) -> str:
        return str(ca.nlpsol_out(index))

    def get_sparsity_in(self, index: int) -> ca.Sparsity:
        return ca.Sparsity.dense(self._rows.get(ca.nlpsol_out(index), 0), 1)

    def eval(self, _arguments: Sequence[ca.DM]) -> list[int]:
        return [int(self.stop is not None and self.stop())]
