"""The program itself: what is unknown, what is to be least, and how a start is polished.

"Gamma passes through the targets" is not written as Gamma = 0. In three of the four categories Gamma
is a perfect square, so it vanishes together with its gradient and no constraint qualification holds.
The program is lifted instead: each target keeps its joint angles and its miss as unknowns, tied by

    P5(theta1, theta2; end of the link) - target = miss,

which is the same surface (Gamma = 0 where the miss is zero) and is regular for every shape.

Unknowns, in metres and radians but for the curvatures, which are in units of the largest one:

    curvature   (kx, ky) of each of the equal arcs             2 m
    length      of the link                                    1
    s           s13, s14, s23, s24                             4
    s35, s45    of the rigid link, where it is free            0 or 2
    from_p3     and radius: the circle of P5, likewise         0 or 2
    theta1      of each target, and theta2                     2 n
    miss        vector from each target to P5                  3 n
    overlap     depth in obstacles allowed at each target      n + 1, where planes are given
    astray      angle allowed beyond the directions asked for  n, where there are any
    worst       largest weighted (miss / tolerance)^2          1, for the minimax objective

Objective: the weighted (miss / tolerance)^2, summed or worst, plus a small multiple of the bending
energy, which chooses the gentlest among the shapes that miss alike. Overlaps cost more than any miss.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING

import casadi as ca
import numpy as np

from synth.arrays import FloatArray, frozen_value
from synth.synthesis.nlp.arm import SymbolicArm
from synth.synthesis.nlp.blocks import Constraints, Unknowns
from synth.synthesis.nlp.ipopt import Ipopt
from synth.synthesis.nlp.packing import packed, unpacked
from synth.task import Objective

if TYPE_CHECKING:
    from collections.abc import Sequence

    from synth.robot import Arm
    from synth.synthesis.nlp.planes import Separation
    from synth.synthesis.nlp.structure import Structure
    from synth.task import Task
    from synth.watch import Watch

# The weight of r * (bending energy) against squared misses in units of the tolerance. It shifts a
# miss by about 1e-6 of the tolerance: invisible, and yet it settles every free direction.
_GENTLENESS = 1e-4
# An overlap costs as much as the last bit of a miss of this size, m; it is measured in units of this
# length, m, because the solver scales the objective down by its steepest slope.
_LARGE_MISS = 0.01
_OVERLAP_UNIT = 1e-3
# An angle beyond the direction asked for costs as much as a depth; its cosine is measured in units of this.
_ASTRAY_UNIT, _WITHIN = 1e-3, 1e-8
# The objective is counted in that of the start, so that the solver meets numbers of about one, but no finer
# than this: a start may be the answer, and its miss then is only rounding.
_FINEST_UNIT = 1.0


@frozen_value
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


@lru_cache(maxsize=16)
def shared_nlp(structure: Structure, arcs: int, near: bool, thread: int) -> SynthesisNlp:
    """Return the program of a structure, without planes: to build it takes as long as three solves.

    A solver holds the iterates of its run, and two threads in one solver crash the interpreter. So the
    calling thread, `threading.get_ident()`, is part of the key: each thread has programs of its own.
    Nothing is remembered from one solve to the next; it only saves the time to build it anew.
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
        count = structure.count
        self._overlaps = len(planes) and count + 1
        x, g = Unknowns(), Constraints()
        positions = ca.SX.sym("positions", count, 3)
        weights = ca.SX.sym("weights", count)  # over the squared tolerances
        floor = ca.SX.sym("floor")
        steepest = ca.SX.sym("steepest")

        arm = SymbolicArm(structure, arcs, floor, x, g)
        miss = x.new("miss", (count, 3), -math.inf, math.inf)
        g.zero(arm.p5 - positions - miss)
        arm.keep_end_effector_above_floor()
        overlap = x.new("overlap", (self._overlaps, 1), 0.0, math.inf)
        for plane in planes:
            arm.keep_apart(plane, _OVERLAP_UNIT * overlap[plane.target])  # ANY_TARGET is the last

        directions, cosines = ca.SX.sym("directions", count, 3), ca.SX.sym("cosines", count)
        astray = x.new("astray", (count if structure.has_approaches else 0, 1), 0.0, math.inf)
        if structure.has_approaches:
            g.between(ca.sum2(arm.pointing * directions) - cosines + _ASTRAY_UNIT * astray, 0.0, math.inf)

        weighted = ca.sum2(miss**2) * weights
        if structure.objective is Objective.MINIMAX:
            misses = x.new("worst", (1, 1), 0.0, math.inf)
            g.between(weighted - misses, -math.inf, 0.0)
        else:
            misses = ca.sum1(weighted)
        too_much = steepest * (ca.sum1(overlap) + ca.sum1(astray))
        objective = misses + _GENTLENESS * arm.bending_energy + too_much
        parameters = ca.vertcat(ca.vec(positions), weights, floor, steepest, ca.vec(directions), cosines)
        self._x = x
        self._ipopt = Ipopt(x, g, parameters, objective, near=near, nearly_clear=bool(planes))

    def solve(self, task: Task, start: Arm, joints: FloatArray, watch: Watch | None = None) -> NlpAnswer:
        """Polish a shape.

        Args:
            task: The task, of this structure.
            start: The robot in a shape of `arcs` equal arcs.
            joints: Joint angles for each target to start from, shape (n, 2), rad.
            watch: Asked once an iteration; when it is up, the solver ends with what it has.

        Returns:
            Where the solver stopped, whether or not that is any good.

        Raises:
            SolverError: The solver broke down without an answer.
            KeyboardInterrupt: The user interrupted the solver (which swallows the exception).
        """
        weights = task.weights / task.tolerances**2 / _unit(task, start, joints)
        floor, steepest = task.floor_in_base or 0.0, 2.0 * _LARGE_MISS * _OVERLAP_UNIT * float(weights.max())
        parameters = np.concatenate(
            [task.positions_in_base.T.ravel(), weights, [floor, steepest], *_directions(task)]
        )
        values, status, iterations = self._ipopt.solve(
            self._x.vector_of(packed(task, start, joints, self._overlaps, weights)), parameters, watch
        )
        arm, found_joints = unpacked(task, self._x.by_name(values))
        return NlpAnswer(arm, found_joints, status, iterations)


def _directions(task: Task) -> tuple[FloatArray, FloatArray]:
    """Return the directions asked for, a column after the other, and the least cosines; 0 and -1 for none."""
    rows = task.approaches_in_base
    if rows is None:
        return np.zeros(3 * len(task.targets)), np.full(len(task.targets), -1.0)
    # A little within, by what the solver may overstep.
    cosines = np.minimum(np.cos(rows[:, 3]) + _WITHIN, 0.5 + 0.5 * np.cos(rows[:, 3]))
    return np.nan_to_num(rows[:, :3]).T.ravel(), np.nan_to_num(cosines, nan=-1.0)


def _unit(task: Task, arm: Arm, joints: FloatArray) -> float:
    """Return the worst weighted (miss / tolerance)^2 of a start, the unit of the objective."""
    misses = np.linalg.norm(arm.forward_kinematics(*joints.T) - task.table.positions, axis=1)
    return max(_FINEST_UNIT, float(np.max(task.weights * (misses / task.tolerances) ** 2)))
