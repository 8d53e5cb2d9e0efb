"""The program that global solvers get: each shape is a point of it, at its worst miss and not below."""

import sys
from dataclasses import replace
from pathlib import Path

import casadi as ca
import numpy as np
import pytest
from planted import ROBOT

sys.path.insert(0, str(Path(__file__).parent / "benchmarks"))

from lifted_program import PER_METRE, LiftedProgram
from peer_tasks import noisy_task

from synth.robot import Interval
from synth.synthesis.shapes import Shapes


class Stated:
    """What a program states, to be asked whether values fulfil it."""

    def __init__(self, task, worst_known):
        self.limits, self.constraints, self.unknowns = {}, [], {}
        LiftedProgram(self.unknown, self.constraints.append, task, worst_known).state()

    def unknown(self, name, lower, upper):
        assert name not in self.limits
        self.limits[name] = lower, upper
        self.unknowns[name] = ca.SX.sym(name)
        return self.unknowns[name]

    def excess(self, values):
        """By how much values break the limits and the constraints, at most."""
        assert values.keys() == self.limits.keys()
        beyond = [max(low - values[name], values[name] - high) for name, (low, high) in self.limits.items()]
        sides = ca.vertcat(*(one.dep(0) - one.dep(1) for one in self.constraints))
        told = ca.Function("sides", list(self.unknowns.values()), [sides])
        off = told(*(values[name] for name in self.unknowns)).full().ravel()
        equal = np.array([one.is_op(ca.OP_EQ) for one in self.constraints])
        assert equal.any()
        assert not equal.all()
        return max(*beyond, *np.where(equal, np.abs(off), off))


def values_of(shapes, index, theta2, targets, worst):
    """The values of a shape's unknowns, its points at given angles of joint 2, dm."""
    task = noisy_task(0)
    arm = shapes.arm(index, task.base)
    frame, p = (PER_METRE**power * part[index] for power, part in enumerate(shapes.end))
    points = PER_METRE * arm.forward_kinematics(np.zeros(len(theta2)), theta2)
    u, t = frame[:, 0], frame[:, 2]
    c = p + PER_METRE * offset() * u
    azimuth = np.arctan2(u[1], u[0])
    turn = np.array(
        [[np.cos(azimuth), np.sin(azimuth), 0], [-np.sin(azimuth), np.cos(azimuth), 0], [0, 0, 1]]
    )
    turn[1] *= -1.0 if (turn @ c)[1] < 0.0 else 1.0
    u, t, c, points = turn @ u, turn @ t, turn @ c, points @ turn.T
    values = {"sin": u[0], "cos": u[2], "W": PER_METRE * worst, "c.c": c @ c, "u.c": u @ c, "t.c": t @ c}
    values |= dict(zip(("cx", "cy", "cz", "tx", "ty", "tz"), (*c, *t), strict=True))
    for i, (x, y, z) in enumerate(points):
        r, h = np.hypot(*targets[i, :2]) * PER_METRE, targets[i, 2] * PER_METRE
        rho = np.hypot(x, y)
        own = {"rho": rho, "x": x, "y": y, "z": z, "N": rho**2 + z**2, "out": rho - r, "up": z - h}
        values |= {f"{name}{i}": value for name, value in own.items()}
    return values


def offset():
    rigid = ROBOT.rigid_link
    return float(ROBOT.end_effector_circle(rigid.d35.lower, rigid.d45.lower)[0])


@pytest.fixture(scope="module")
def shapes():
    return Shapes.sample(ROBOT, 30, np.random.default_rng(0))


def test_every_shape_is_a_point_of_the_program_at_its_worst_miss_and_not_below(shapes):
    task = noisy_task(1, 6)
    targets = task.positions_in_base
    for index in range(30):
        arm = shapes.arm(index, task.base)
        joints, misses = arm.closest_joints(targets)
        worst = misses.max()
        values = values_of(shapes, index, joints[:, 1], targets, worst)
        assert Stated(task, worst + 1e-4).excess(values) < 1e-10
        # The dead zone of joint 1 is left out: what counts is the miss in the half-plane.
        seen = max(np.hypot(values[f"out{i}"], values[f"up{i}"]) for i in range(6))
        assert seen <= PER_METRE * worst + 1e-10
        assert Stated(task, worst + 1e-4).excess(values | {"W": 0.99 * seen}) > 1e-3 * seen**2


def test_what_joint_2_cannot_do_is_no_point_of_the_program(shapes):
    task = noisy_task(1, 6)
    folded = np.full(6, ROBOT.joint_limits.second.lower - 0.05)
    points = shapes.arm(0, task.base).forward_kinematics(np.zeros(6), folded)
    there = replace(
        task, targets=tuple(replace(t, position=p) for t, p in zip(task.targets, points, strict=True))
    )
    values = values_of(shapes, 0, folded, there.positions_in_base, 0.0)
    assert Stated(there, 1e-4).excess(values) > 0.1


def test_a_straight_link_just_fits_and_one_a_millimetre_shorter_does_not_reach_its_end():
    task, longest = noisy_task(1, 6), ROBOT.link.length.upper
    straight = Shapes(ROBOT, np.append(np.zeros(8), longest)[None])
    joints, misses = straight.arm(0, task.base).closest_joints(task.positions_in_base)
    values = values_of(straight, 0, joints[:, 1], task.positions_in_base, misses.max())
    assert Stated(task, misses.max() + 1e-4).excess(values) < 1e-10
    link = replace(ROBOT.link, length=Interval(ROBOT.link.length.lower, longest - 1e-3))
    shorter = replace(task, robot=replace(ROBOT, link=link))
    beyond = PER_METRE**2 * (longest**2 - (longest - 1e-3) ** 2)
    assert Stated(shorter, misses.max() + 1e-4).excess(values) == pytest.approx(beyond)
