"""Gauss-Newton on many shapes at once: from promising starts to the bottoms of their valleys.

It knows neither the floor nor the gentlest bend, and it is not exact: it only finds out cheaply which
of some hundred starts lead anywhere, so that the nonlinear program need not try them all.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from synth.robot import into_turn
from synth.synthesis.population import Population, into_limits
from synth.task import Topology

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.robot import Interval, Kinematics
    from synth.task import Task

_ITERATIONS = 14
_DIFFERENCE = 1e-6  # step of the finite differences over the unknowns, which are of order one
_ARM_LENGTH = 0.5  # an axis 1 rad off its category puts P5 about this far off, m
_LEAST_DAMPING, _MOST_DAMPING = 1e-9, 1e9


@dataclass(frozen=True, eq=False)
class Refined:
    """Shapes at the bottoms of their valleys, or nearly.

    Attributes:
        population: The shapes, of shape (N,).
        joints: Their joint angles for each target, shape (N, n, 2), rad.
        cost: Their mean squared misses, weighted with `relative_weights`, shape (N,), m^2.
    """

    population: Population
    joints: FloatArray
    cost: FloatArray

    def chosen_with(self, other: Refined, chosen: NDArray[np.intp]) -> Refined:
        """Return some of these and of others, counted through: these first, then the others."""
        unknowns = np.concatenate([self.population.unknowns, other.population.unknowns])
        joints, cost = np.concatenate([self.joints, other.joints]), np.concatenate([self.cost, other.cost])
        return Refined(Population(self.population.robot, unknowns[chosen]), joints[chosen], cost[chosen])

    def improved_by(self, other: Refined) -> Refined:
        """Return as many of the best of these and others as there are of these."""
        order = np.argsort(np.concatenate([self.cost, other.cost]), kind="stable")
        return self.chosen_with(other, order[: len(self.cost)])


def refine(task: Task, population: Population, theta2: FloatArray, iterations: int = _ITERATIONS) -> Refined:
    """Improve shapes by damped Gauss-Newton steps, their limits and those of the joints observed.

    Each target keeps its own joint angles, which follow the shape: the residual is what is left of
    P5 - target across the directions in which the joints are free to move.

    Args:
        task: The task.
        population: The starts, of shape (N,).
        theta2: Angle of joint 2 at which each start is nearest to each target, shape (N, n), rad.
        iterations: Number of steps.

    Returns:
        The improved shapes.
    """
    limits = task.robot.joint_limits
    weights = relative_weights(task)
    joints = with_theta1(task, population, theta2)
    cost, damping = _cost(task, population, joints, weights), np.full(len(theta2), 1e-3)
    for _ in range(iterations):
        step, follow = _step(task, population, joints, weights, damping)
        moved = Population(task.robot, into_limits(task.robot, population.unknowns + step))
        # By how much the joints follow is only known to first order: theta1 is then set right.
        theta2 = np.clip(joints[..., 1] + follow, limits.second.lower, limits.second.upper)
        moved_joints = with_theta1(task, moved, theta2)
        moved_cost = _cost(task, moved, moved_joints, weights)
        better = moved_cost < cost
        population = Population(task.robot, np.where(better[:, None], moved.unknowns, population.unknowns))
        joints = np.where(better[:, None, None], moved_joints, joints)
        cost = np.where(better, moved_cost, cost)
        damping = np.clip(np.where(better, 0.2 * damping, 8.0 * damping), _LEAST_DAMPING, _MOST_DAMPING)
    return Refined(population, joints, cost)


def nearest_theta2(task: Task, kinematics: Kinematics) -> FloatArray:
    """Return the better branch of joint 2 for each target, moved into its limits, shape (..., n), rad.

    Args:
        task: The task.
        kinematics: The joints of shapes, of shape (...).
    """
    limits, one = task.robot.joint_limits, kinematics.each_target()
    both = into_turn(one.branches(task.positions)[..., 1], limits.second.middle)
    both = np.clip(both, limits.second.lower, limits.second.upper)
    misses = one.each_target().miss(both, task.positions[:, None], limits.base)
    return np.asarray(np.take_along_axis(both, np.argmin(misses, axis=-1)[..., None], axis=-1)[..., 0])


def relative_weights(task: Task) -> FloatArray:
    """Return each target's factor of its squared miss, shape (n,); the tightest has about 1 / n."""
    weights = task.weights * (task.tolerances.min() / task.tolerances) ** 2
    return np.asarray(weights / len(weights))


def category_offsets(task: Task, frame: FloatArray, position: FloatArray) -> FloatArray:
    """Return how far ends of the link are from the category asked for, shape (..., 2), m.

    Args:
        task: The task.
        frame: Rotation of the link's end, shape (..., 3, 3).
        position: The link's end in the base frame, shape (..., 3), m.
    """
    match task.topology:
        case Topology.SCARA:
            return np.asarray(_ARM_LENGTH * frame[..., :2, 0])
        case Topology.SPHERICAL | Topology.PUMA:
            height = 0.0 if task.topology is Topology.SPHERICAL else task.robot.d12
            from_point = position - np.array([0.0, 0.0, height])
            return np.asarray(np.einsum("...i,...ij->...j", from_point, frame[..., 1:]))
        case Topology.ANY | Topology.GENERAL:
            return np.zeros((*position.shape[:-1], 2))


def with_theta1(task: Task, population: Population, theta2: FloatArray) -> FloatArray:
    """Return joint angles, shape (N, n, 2), with joint 1 at its best for angles of joint 2, (N, n), rad."""
    kinematics = population.kinematics.each_target()
    theta1 = kinematics.best_theta1(theta2, task.positions, task.robot.joint_limits.base)
    return np.stack([theta1, theta2], axis=-1)


def _cost(task: Task, population: Population, joints: FloatArray, weights: FloatArray) -> FloatArray:
    reached = population.kinematics.each_target().forward(joints[..., 0], joints[..., 1])
    misses = np.einsum("...ni,...ni,n->...", reached - task.positions, reached - task.positions, weights)
    return np.asarray(misses + np.sum(category_offsets(task, *population.end) ** 2, axis=-1))


def _step(
    task: Task, population: Population, joints: FloatArray, weights: FloatArray, damping: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the damped step of the unknowns (N, p) and how far theta2 follows it (N, n)."""
    kinematics = population.kinematics.each_target()
    reached = kinematics.forward(joints[..., 0], joints[..., 1])
    residual = reached - task.positions
    count = population.unknowns.shape[-1]
    nearby = Population(task.robot, population.unknowns[:, None] + _DIFFERENCE * np.eye(count))
    moved = nearby.kinematics.each_target().forward(joints[:, None, :, 0], joints[:, None, :, 1])
    jacobian = (moved - reached[:, None]) / _DIFFERENCE  # (N, p, n, 3)

    # An orthonormal basis of the directions in which the joints are free to move P5.
    limits = task.robot.joint_limits
    by_theta1, by_theta2 = kinematics.velocities(joints, reached)
    first = _unit(by_theta1) * _free(joints[..., 0], limits.base, by_theta1, residual)[..., None]
    second = by_theta2 - np.einsum("...i,...i", by_theta2, first)[..., None] * first
    free = _free(joints[..., 1], limits.second, by_theta2, residual)
    second = _unit(second) * free[..., None]
    across, along = residual, []
    for direction in (first, second):
        across = across - np.einsum("...i,...i", across, direction)[..., None] * direction
        along.append(np.einsum("apni,ani->apn", jacobian, direction))
    projected = jacobian - along[0][..., None] * first[:, None] - along[1][..., None] * second[:, None]

    normal = np.einsum("apni,aqni,n->apq", projected, projected, weights)
    slope = np.einsum("apni,ani,n->ap", projected, across, weights)
    offsets = category_offsets(task, *population.end)
    by_offset = (category_offsets(task, *nearby.end) - offsets[:, None]) / _DIFFERENCE
    normal += np.einsum("apk,aqk->apq", by_offset, by_offset)
    slope += np.einsum("apk,ak->ap", by_offset, offsets)
    diagonal = np.einsum("app->ap", normal)
    # The floor of the scale keeps unknowns that nothing depends on from running away.
    scale = diagonal + 1e-3 * diagonal.max(axis=1, keepdims=True) + 1e-12
    damped = normal + damping[:, None, None] * scale[:, :, None] * np.eye(count)
    step = -np.linalg.solve(damped, slope[..., None])[..., 0]

    # theta2 takes up what the step and the residual leave along its own direction.
    to_take_up = residual + np.einsum("apni,ap->ani", jacobian, step)
    length = np.einsum("...i,...i", second, by_theta2)
    follow = -np.einsum("...i,...i", to_take_up, second) / np.maximum(length, 1e-6)
    return step, np.clip(follow, -0.5, 0.5)


def _unit(vectors: FloatArray) -> FloatArray:
    """Return vectors of length one; zero vectors stay zero."""
    return np.asarray(vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-9))


def _free(angle: FloatArray, limits: Interval, velocity: FloatArray, residual: FloatArray) -> FloatArray:
    """Return 1 where a joint may move so as to lessen the residual, 0 where its limit forbids it."""
    uphill = np.einsum("...i,...i", velocity, residual)
    held = ((angle <= limits.lower + 1e-9) & (uphill > 0.0)) | (
        (angle >= limits.upper - 1e-9) & (uphill < 0.0)
    )
    return np.where(held, 0.0, 1.0)
