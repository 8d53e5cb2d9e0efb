"""The kinematics of an arm as a CasADi function, for programs of one's own, and as C code."""

from __future__ import annotations

from typing import TYPE_CHECKING

import casadi as ca

from synth.checks import refuse_unless
from synth.robot import Arm

if TYPE_CHECKING:
    from synth.arrays import FloatArray


def casadi_kinematics(arm: Arm) -> ca.Function:
    """Return the forward kinematics of an arm and their Jacobian as a CasADi function.

    Args:
        arm: The arm.

    Returns:
        `kinematics(joints) -> (p5, jacobian)`: angles (theta1, theta2), shape (2,), rad; P5 in the task
        frame, shape (3,), m; and its derivatives by the angles, shape (3, 2), m/rad. It can be called with
        numbers, and with expressions inside another program.
    """
    refuse_unless("arm", arm, Arm)
    joints = ca.SX.sym("joints", 2)
    frame, circle = arm.kinematics.frame, arm.circle
    across = ca.sin(joints[1]) * _column(frame[:, 1]) - ca.cos(joints[1]) * _column(frame[:, 2])
    swept = _column(circle.centre) + circle.radius * across
    base = arm.base
    p5 = _column(base.position) + ca.DM(base.rotation) @ _turn(joints[0]) @ swept
    names = ["joints"], ["p5", "jacobian"]
    return ca.Function("kinematics", [joints], [p5, ca.densify(ca.jacobian(p5, joints))], *names)


def kinematics_c_code(arm: Arm) -> str:
    """Return `casadi_kinematics` as C code that needs nothing but the C standard library.

    Args:
        arm: The arm.

    Returns:
        The text of a C file. `int kinematics(const double** arg, double** res, ...)` takes the joint angles
        in `arg[0]`, and puts P5 into `res[0]` and the Jacobian, column by column, into `res[1]`.
    """
    generator = ca.CodeGenerator("kinematics")
    generator.add(casadi_kinematics(arm))
    return str(generator.dump())


def _column(vector: FloatArray) -> ca.DM:
    return ca.DM(vector.tolist())


def _turn(angle: ca.SX) -> ca.SX:
    """Return the rotation about axis 1."""
    c, s = ca.cos(angle), ca.sin(angle)
    return ca.vertcat(ca.horzcat(c, -s, 0), ca.horzcat(s, c, 0), ca.horzcat(0, 0, 1))
