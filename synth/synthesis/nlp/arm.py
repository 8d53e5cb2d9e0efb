"""The arm in CasADi: the same robot as `synth.robot.Arm`, of unknown shape, at unknown joint angles.

Its link is followed arc by arc from P2, in pieces as `separation` numbers them; at the end sits axis 2,
with P3 and P4 on it and the circle of P5 about it. What the hardware can take, the floor and the category
asked for are constraints on the way; planes that keep it apart from something are added to a whole arm.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import casadi as ca

from synth.synthesis.nlp.planes import COLUMN, PIECES, ROD
from synth.task import Topology

if TYPE_CHECKING:
    from synth.synthesis.nlp.blocks import Constraints, Unknowns
    from synth.synthesis.nlp.planes import Separation
    from synth.synthesis.nlp.structure import Structure

# Curvature 1e-5 / m is straight; it keeps |k| differentiable at zero.
_STRAIGHT = 1e-10
# The solver keeps this much clear, m, so that what it oversteps is not missing afterwards.
_CLEARANCE = 2e-4
# With a smaller circle of the end effector, m, the second joint is not worth its name.
_LEAST_RADIUS = 1e-3
# `topology: general` keeps this far from the special categories: twice what still counts as one.
_GENERAL_DISTANCE = 2e-3
_GENERAL_ANGLE = math.radians(0.2)


@dataclass(frozen=True, eq=False)
class _Piece:
    """A convex piece of the arm at joint 1 = 0: its ends, and what is within how far of their chord, m."""

    ends: list[ca.SX]
    thickness: ca.SX


class SymbolicArm:
    """The arm at each of n targets, in one shape; its making adds its unknowns and constraints to a program.

    Args:
        structure: What it is an arm of, and what is asked of it.
        arcs: Number m of equal arcs of the link, a divisor of PIECES.
        floor: Height of the floor, m, if there is one.
        x: Gets the unknowns: curvature, length, s, rigid, joints.
        g: Gets the constraints.

    Attributes:
        p5: The end effector at each target, in the base frame, shape (n, 3), m.
        pointing: Direction of the rigid link there, from axis 2 to P5, shape (n, 3).
        bending_energy: Of the link, in units of one over the least bend radius.
    """

    def __init__(self, structure: Structure, arcs: int, floor: ca.SX, x: Unknowns, g: Constraints) -> None:
        self._structure, self._floor, self._x, self._g = structure, floor, x, g
        robot, count = structure.robot, structure.count
        curvature = x.new("curvature", (2, arcs), -1.0, 1.0)
        length = x.new("length", (1, 1), robot.link.length.lower, robot.link.length.upper)
        self.bending_energy = ca.sumsqr(curvature) * length / (arcs * robot.link.min_bend_radius)
        self._pieces, position, frame = self._link(curvature, length / arcs)
        u, v, t = frame[:, 0], frame[:, 1], frame[:, 2]
        p3 = position - robot.tip_offset * u
        p4 = p3 + robot.d34 * u
        self._tie_squared_distances(p3, p4)
        for point in (p3, p4):
            self._above_floor(point[2])
        _ask_for_topology(structure, g, position, u, v, t)

        offset, radius = self._end_effector_circle()
        centre = position + offset * u
        base, second = robot.joint_limits.base, robot.joint_limits.second
        theta1 = self._theta1 = x.new("theta1", (count, 1), base.lower, base.upper)
        theta2 = x.new("theta2", (count, 1), second.lower, second.upper)
        x2, y2, z2 = (ca.sin(theta2) * v[axis] - ca.cos(theta2) * t[axis] for axis in range(3))
        px, py, pz = (centre[axis] + radius * along for axis, along in enumerate((x2, y2, z2)))
        self._unturned_p5 = ca.horzcat(px, py, pz)  # at joint 1 = 0
        self.p5 = _turned(theta1, px, py, pz)
        self.pointing = _turned(theta1, x2, y2, z2)

    def _link(self, curvature: ca.SX, arc_length: ca.SX) -> tuple[dict[int, _Piece], ca.SX, ca.SX]:
        """Follow the arcs from P2 to the link's end, under the limits of bending and the floor.

        Returns:
            The pieces of the tube, position and frame of the link's end.
        """
        robot, arcs = self._structure.robot, curvature.shape[1]
        link, radius = robot.link, 0.5 * robot.link.diameter
        position: ca.SX = ca.SX([0.0, 0.0, robot.d12])
        frame: ca.SX = ca.SX.eye(3)
        pieces = {COLUMN: _Piece([ca.SX.zeros(3), position], ca.SX(radius))}
        total_bend = ca.SX(0.0)
        parts = PIECES // arcs
        for arc in range(arcs):
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
            self._g.between(ca.sumsqr(curvature[:, arc]), -math.inf, 1.0)
            total_bend += turn
        if link.max_total_bend < math.inf:
            self._g.between(total_bend, -math.inf, link.max_total_bend)
        return pieces, position, frame

    def _tie_squared_distances(self, p3: ca.SX, p4: ca.SX) -> None:
        """Make s13, s14, s23, s24 unknowns, equal to what they are between these points."""
        s = self._x.new("s", (4, 1), 0.0, math.inf)
        p1, p2 = ca.DM.zeros(3), ca.DM([0.0, 0.0, self._structure.robot.d12])
        ends = ((p1, p3), (p1, p4), (p2, p3), (p2, p4))
        self._g.zero(s - ca.vertcat(*(ca.sumsqr(b - a) for a, b in ends)))

    def _end_effector_circle(self) -> tuple[ca.SX, ca.SX]:
        """Return offset along axis 2 and radius of P5's circle; free rigid links get s35 and s45."""
        robot, rigid = self._structure.robot, self._structure.robot.rigid_link
        if rigid.is_fixed:
            fixed_offset, fixed_radius = robot.end_effector_circle(rigid.d35.lower, rigid.d45.lower)
            return ca.SX(fixed_offset), ca.SX(fixed_radius)
        s35 = self._x.new("s35", (1, 1), rigid.d35.lower**2, rigid.d35.upper**2)
        s45 = self._x.new("s45", (1, 1), rigid.d45.lower**2, rigid.d45.upper**2)
        # The circle is unknown, too, so that no step of the solver meets the root of a negative number.
        from_p3 = self._x.new("from_p3", (1, 1), -math.inf, math.inf)
        radius = self._x.new("radius", (1, 1), _LEAST_RADIUS, math.inf)
        self._g.zero(s35 - from_p3**2 - radius**2)
        self._g.zero(s45 - (from_p3 - robot.d34) ** 2 - radius**2)
        return from_p3 - robot.tip_offset, radius

    def _above_floor(self, height: ca.SX) -> None:
        if self._structure.has_floor:
            self._g.between(height - self._floor, 0.0, math.inf)

    def keep_end_effector_above_floor(self) -> None:
        """Keep the rigid link's lowest side at P5 above the floor, if there is one, at each target."""
        self._above_floor(self.p5[:, 2] - 0.5 * self._structure.robot.rigid_link.diameter)

    def keep_apart(self, plane: Separation, allowed: ca.SX) -> None:
        """Keep a piece on its side of a plane, but for an allowed overlap, m."""
        normal: ca.SX = ca.SX(ca.DM(plane.normal))
        one = self._pieces[plane.piece] if plane.piece != ROD else self._rod(plane)
        thickness = one.thickness
        if plane.other is None:
            c, s = ca.cos(self._theta1[plane.target]), ca.sin(self._theta1[plane.target])
            # The direction turned back is the same as the piece turned forward.
            normal = ca.vertcat(c * normal[0] + s * normal[1], c * normal[1] - s * normal[0], normal[2])
            beyond = [ca.SX(plane.offset)]
        else:
            beyond = [ca.dot(normal, end) for end in self._pieces[plane.other].ends]
            thickness = thickness + self._pieces[plane.other].thickness
        for end in one.ends:
            for other in beyond:
                self._g.between(ca.dot(normal, end) - other - thickness + allowed, _CLEARANCE, math.inf)

    def _rod(self, plane: Separation) -> _Piece:
        """Return the rigid link; where it is kept apart from the tube, without the joint's diameter."""
        robot = self._structure.robot
        start, end = self._pieces[PIECES].ends[-1], self._unturned_p5[plane.target, :].T
        if plane.other is not None:
            along = end - start
            start = start + robot.link.diameter / ca.norm_2(along) * along
        return _Piece([start, end], ca.SX(0.5 * robot.rigid_link.diameter))


def _turned(theta1: ca.SX, x: ca.SX, y: ca.SX, z: ca.SX) -> ca.SX:
    """Return vectors turned by joint 1, shape (n, 3)."""
    return ca.horzcat(ca.cos(theta1) * x - ca.sin(theta1) * y, ca.sin(theta1) * x + ca.cos(theta1) * y, z)


def _ask_for_topology(
    structure: Structure, g: Constraints, position: ca.SX, u: ca.SX, v: ca.SX, t: ca.SX
) -> None:
    """Constrain the axes: two regular equations for each special category."""

    def from_axis_2(point: ca.DM) -> ca.SX:
        return ca.vertcat(ca.dot(position - point, v), ca.dot(position - point, t))

    p1, p2 = ca.DM.zeros(3), ca.DM([0.0, 0.0, structure.robot.d12])
    match structure.topology:
        case Topology.SPHERICAL:
            g.zero(from_axis_2(p1))
        case Topology.PUMA:
            g.zero(from_axis_2(p2))
        case Topology.SCARA:
            g.zero(u[:2])
        case Topology.GENERAL:
            for point in (p1, p2):
                g.between(ca.sumsqr(from_axis_2(point)), _GENERAL_DISTANCE**2, math.inf)
            g.between(ca.sumsqr(u[:2]), math.sin(_GENERAL_ANGLE) ** 2, math.inf)
        case Topology.ANY:
            pass
