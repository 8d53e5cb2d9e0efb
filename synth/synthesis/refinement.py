"""Gauss-Newton on many shapes at once: from promising starts to the bottoms of their valleys.

It knows neither the floor nor the gentlest bend: it finds out cheaply which of some hundred starts lead
anywhere, so that the nonlinear program need not try them all.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, compared_by_value
from synth.synthesis.category_offsets import category_offsets, category_slopes
from synth.synthesis.population import Population, free_directions, into_limits
from synth.synthesis.postures import Aims, Postures
from synth.synthesis.residuals import Residuals
from synth.synthesis.separation import overlaps
from synth.synthesis.watch import never
from synth.task import Objective

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from synth.task import Task

_ITERATIONS = {Objective.LEAST_SQUARES: 20, Objective.MINIMAX: 24}
# After so many steps each target may take the nearer branch of joint 2, wherever it is.
_STEPS_ON_BRANCHES = 4
_FIRST_DAMPING, _LEAST_DAMPING, _MOST_DAMPING = 1e-3, 1e-9, 1e9
# Exponents of the misses, and from which share of the steps on: where the worst miss counts, a norm that is
# smooth comes first, because its valleys are wide, and then one that is nearly the worst.
_SQUARES = 2.0
_EXPONENTS = {
    Objective.LEAST_SQUARES: ((0.0, _SQUARES),),
    Objective.MINIMAX: ((0.0, _SQUARES), (0.25, 4.0), (0.4, 12.0)),
}
# Steps with each of ever larger exponents, until the norm is the worst miss to a few parts in 10,000; half
# the way on, the shapes that are no longer promising are given up.
_LEVELLING = tuple(12.0 * 1.5**k for k in range(1, 8)), tuple(12.0 * 1.5**k for k in range(8, 17))
_LEVELLING_STEPS, _LEVELLED = 6, 10
_LEVELLING_DAMPING = 1e-4
# Steps out of obstacles, what to keep from them, m, and the differences of unknowns that tell which way.
_CLEARING, _MARGIN, _DIFFERENCE = 10, 4e-3, 1e-5
_TOGETHER = 4000  # postures, so that the arrays stay in the cache
# So many shapes with squared misses below this, m^2, are enough: the others need not arrive, too.
_ENOUGH, _EXACT = 20, 1e-13
_TINY = 1e-30  # m^2


@compared_by_value
@dataclass(frozen=True, eq=False)
class Refined:
    """Shapes at the bottoms of their valleys, or nearly.

    Attributes:
        population: The shapes, of shape (N,).
        joints: Their joint angles for each target, shape (N, n, 2), rad.
        cost: Their mean squared misses, weighted with `relative_weights`, shape (N,), m^2; where the worst
            miss counts, nearly that one squared, and not above it where the valley ends.
    """

    population: Population
    joints: FloatArray
    cost: FloatArray

    @classmethod
    def joined(cls, parts: list[Refined]) -> Refined:
        """Return the shapes of all parts, in order."""
        unknowns = np.concatenate([part.population.unknowns for part in parts])
        joints = np.concatenate([part.joints for part in parts])
        cost = np.concatenate([part.cost for part in parts])
        return cls(Population(parts[0].population.robot, unknowns), joints, cost)

    def take(self, chosen: NDArray[np.intp]) -> Refined:
        """Return some of the shapes."""
        return Refined(self.population.take(chosen), self.joints[chosen], self.cost[chosen])

    def best(self, count: int) -> Refined:
        """Return the best shapes in order, `count` at most."""
        return self.take(np.argsort(self.cost, kind="stable")[:count])


def refine(
    task: Task,
    population: Population,
    theta2: FloatArray | None = None,
    iterations: int | None = None,
    *,
    near: bool = False,
    is_up: Callable[[], bool] = never,
) -> Refined:
    """Improve shapes by damped Gauss-Newton steps, their limits and those of the joints observed.

    Each target keeps its own joint angles, which follow the shape: the residual is what is left of
    P5 - target across the directions in which the joints are free to move.

    Args:
        task: The task.
        population: The starts, of shape (N,).
        theta2: Angle of joint 2 at which each start shall meet each target, shape (N, n), rad, and stay on
            that branch; by default the nearest one, which is looked for again from time to time.
        iterations: Number of steps; by default enough to arrive, mostly.
        near: Whether the starts were refined before: the norm whose valleys are the widest is left out.
        is_up: Asked after each step whether to end with what there is.

    Returns:
        The improved shapes.
    """
    iterations = iterations or _ITERATIONS[task.objective]
    return _descents(
        task,
        population,
        theta2,
        lambda descent: descent.after(iterations, keep_branches=theta2 is not None, near=near),
        is_up,
    )


def _descents(
    task: Task,
    population: Population,
    theta2: FloatArray | None,
    led: Callable[[_Descent], Refined],
    is_up: Callable[[], bool],
    *,
    clear: bool = False,
) -> Refined:
    """Return shapes after their descents, led a part of them at a time."""
    aims = Aims(task.positions, task.robot.joint_limits)
    together = max(1, _TOGETHER // len(task.positions))
    parts = []
    for first in range(0, len(population.length), together):
        some = slice(first, first + together)
        part = population.take(some)
        if theta2 is None:
            postures = Postures.nearest(aims, part.kinematics)
        else:
            postures = Postures.at(aims, part.kinematics, theta2[some])
        parts.append(led(_Descent(task, aims, part, postures, is_up, clear=clear)))
    return Refined.joined(parts)


def level(task: Task, refined: Refined, is_up: Callable[[], bool] = never) -> Refined:
    """Lower the worst miss of shapes for which it is nearly the least already.

    The exponent of the norm is raised step by step: each norm's least is close to that of the one before, so
    a few steps lead from one to the next, however sharp the norm has become.

    Args:
        task: The task, for the worst miss.
        refined: Shapes, each with the branches of joint 2 on which it stays.
        is_up: Asked after each step whether to end with what there is.

    Returns:
        The best of the shapes, with lower ones; their costs are nearly the worst misses squared, m^2.
    """
    for exponents in _LEVELLING:
        led = partial(_Descent.level, exponents=exponents)
        refined = _descents(task, refined.population, refined.joints[..., 1], led, is_up).best(_LEVELLED)
    return refined


def cleared(task: Task, refined: Refined, is_up: Callable[[], bool] = never) -> Refined:
    """Move shapes out of obstacles and out of themselves, as their targets allow.

    Args:
        task: The task.
        refined: Shapes, each with the branches of joint 2 on which it stays.
        is_up: Asked after each step whether to end with what there is.

    Returns:
        The shapes; their costs count the misses alone.
    """
    return _descents(task, refined.population, refined.joints[..., 1], _Descent.cleared, is_up, clear=True)


def relative_weights(task: Task) -> FloatArray:
    """Return each target's factor of its squared miss, shape (n,); the tightest has about 1 / n."""
    weights = task.weights * (task.tolerances.min() / task.tolerances) ** 2
    return np.asarray(weights / len(weights))


class _Descent:
    """Shapes on their way down, each with its postures."""

    def __init__(
        self,
        task: Task,
        aims: Aims,
        population: Population,
        postures: Postures,
        is_up: Callable[[], bool],
        *,
        clear: bool,
    ) -> None:
        self._is_up = is_up
        self._task, self._aims, self._weights, self._clear = task, aims, relative_weights(task), clear
        self._population, self._postures = population, postures
        self._damping = np.full(len(population.length), _FIRST_DAMPING)
        self._exponent = _SQUARES
        self._cost = self._cost_of(population, postures)

    def after(self, iterations: int, *, keep_branches: bool, near: bool) -> Refined:
        """Return the shapes after so many steps."""
        for iteration in range(iterations):
            self._measure_by(self._exponent_at(iteration / iterations, near=near))
            self._step()
            if np.count_nonzero(self._cost < _EXACT) >= _ENOUGH or self._is_up():
                break
            last = iteration == iterations - 1
            if not (keep_branches or last) and (iteration + 1) % _STEPS_ON_BRANCHES == 0:
                nearest = Postures.nearest(self._aims, self._population.kinematics)
                self._postures = nearest.where(nearest.squared < self._postures.squared, self._postures)
                self._cost = self._cost_of(self._population, self._postures)
        return Refined(self._population, self._postures.joints, self._cost)

    def cleared(self) -> Refined:
        """Return the shapes after steps out of obstacles, with the costs of their misses."""
        self.after(_CLEARING, keep_branches=True, near=True)
        self._clear = False
        return Refined(
            self._population, self._postures.joints, self._cost_of(self._population, self._postures)
        )

    def level(self, exponents: Sequence[float]) -> Refined:
        """Return the shapes after steps in ever sharper norms."""
        for exponent in exponents:
            self._measure_by(exponent)
            self._damping = np.full_like(self._damping, _LEVELLING_DAMPING)
            for _ in range(_LEVELLING_STEPS):
                if self._is_up():
                    break
                self._step()
        return Refined(self._population, self._postures.joints, self._cost)

    def _exponent_at(self, share: float, *, near: bool) -> float:
        exponents = _EXPONENTS[self._task.objective]
        share = max(share, exponents[1][0]) if near and len(exponents) > 1 else share
        return next(exponent for since, exponent in reversed(exponents) if since <= share)

    def _measure_by(self, exponent: float) -> None:
        if exponent != self._exponent:
            self._exponent = exponent
            self._cost = self._cost_of(self._population, self._postures)

    def _shares(self, postures: Postures) -> tuple[FloatArray, FloatArray]:
        """Return the squared p-norm of the misses, (N,), and its derivatives by the squared misses, (N, n).

        It is the mean over the targets of weighted misses to the power of the exponent p, to the power of
        2 / p: the mean squared miss for p = 2, nearly the worst, and never above it, for a large p.
        """
        if self._exponent == _SQUARES:
            return postures.squared @ self._weights, np.broadcast_to(self._weights, postures.squared.shape)
        weights = len(self._weights) * self._weights
        squared = postures.squared * weights
        worst = squared.max(axis=1) + _TINY
        half = 0.5 * self._exponent
        relative = squared / worst[:, None]
        # Where all targets are met exactly there is no slope, whatever the norm.
        mean = np.maximum(np.mean(relative**half, axis=1), _TINY)
        slopes = (mean ** (1.0 / half - 1.0))[:, None] * relative ** (half - 1.0) * self._weights
        return worst * mean ** (1.0 / half), slopes

    def _cost_of(self, population: Population, postures: Postures) -> FloatArray:
        off = category_offsets(self._task, population)
        cost = self._shares(postures)[0] + np.einsum("ni,ni->n", off, off)
        if self._clear:
            depth = overlaps(self._task, population, postures.joints, margin=_MARGIN, is_up=self._is_up)
            cost += np.mean(depth**2, axis=-1)
        return np.asarray(cost)

    def _step(self) -> None:
        """Move each shape by a damped step if that makes it better."""
        residuals = Residuals(self._population, self._postures, self._aims.limits.second)
        cost, shares = self._shares(self._postures)
        curvature, slope = residuals.normal_equations(shares)
        if self._exponent != _SQUARES:
            curvature = _curvature_of_norm(self._exponent, cost, curvature, slope)
        by_end = category_slopes(self._task, self._population)
        curvature[:, :6, :6] += by_end.transpose(0, 2, 1) @ by_end
        off = category_offsets(self._task, self._population)
        slope[:, :6] += np.einsum("nki,nk->ni", by_end, off)

        robot, motion = self._population.robot, self._population.motion
        by_unknowns = motion.transpose(0, 2, 1)
        by_unknown, curvature = (by_unknowns @ slope[..., None])[..., 0], by_unknowns @ curvature @ motion
        if self._clear:
            depth, deeper = self._depths(residuals)
            by_unknown += np.einsum("ntk,nt->nk", deeper, depth) / depth.shape[1]
            curvature += deeper.transpose(0, 2, 1) @ deeper / depth.shape[1]
        step = _damped_step(self._population, curvature, by_unknown, self._damping)
        moved = Population(robot, into_limits(robot, self._population.unknowns + step))
        second = self._aims.limits.second
        # By how much joint 2 follows is only known to first order; joint 1 is at its best in any case.
        theta2 = self._postures.theta2 + residuals.following((motion @ step[..., None])[..., 0])
        postures = Postures.at(self._aims, moved.kinematics, np.clip(theta2, second.lower, second.upper))
        cost = self._cost_of(moved, postures)
        if self._clear and self._is_up():
            return  # not all obstacles were looked at
        better = cost < self._cost
        self._population = moved.where(better, self._population)
        self._postures = postures.where(better[:, None], self._postures)
        self._cost = np.where(better, cost, self._cost)
        self._damping = np.clip(
            np.where(better, 0.2 * self._damping, 8.0 * self._damping), _LEAST_DAMPING, _MOST_DAMPING
        )

    def _depths(self, residuals: Residuals) -> tuple[FloatArray, FloatArray]:
        """Return the depths in obstacles, shape (N, n), m, and by differences how unknowns change them."""
        here, motion, second = self._population, self._population.motion, self._aims.limits.second
        depth = overlaps(self._task, here, self._postures.joints, margin=_MARGIN, is_up=self._is_up)
        deeper = np.zeros((*depth.shape, here.unknowns.shape[1]))
        if not depth.any():
            return depth, deeper
        deep = np.flatnonzero(depth.any(axis=1))
        for unknown in range(deeper.shape[2]):
            if self._is_up():
                break
            moved = here.unknowns[deep]
            moved[:, unknown] += _DIFFERENCE
            population = Population(here.robot, moved)
            theta2 = self._postures.theta2 + residuals.following(_DIFFERENCE * motion[..., unknown])
            theta2 = np.clip(theta2[deep], second.lower, second.upper)
            joints = Postures.at(self._aims, population.kinematics, theta2).joints
            changed = overlaps(self._task, population, joints, margin=_MARGIN, is_up=self._is_up)
            deeper[deep, :, unknown] = (changed - depth[deep]) / _DIFFERENCE
        return depth, deeper


def _curvature_of_norm(
    exponent: float, cost: FloatArray, curvature: FloatArray, slope: FloatArray
) -> FloatArray:
    """Return half the second derivative of the squared p-norm C of the misses, as Gauss and Newton take it.

    With J^T W J and g = J^T W r of the weights W that `_shares` gives it is
    (p - 1) J^T W J - (p - 2) g g^T / C. The second term is what makes the steps long where all misses shrink
    together; by Cauchy and Schwarz the difference is never less than J^T W J.
    """
    along = slope / np.sqrt(np.maximum(cost, _TINY))[:, None]
    return (exponent - 1.0) * curvature - (exponent - 2.0) * along[:, :, None] * along[:, None, :]


def _damped_step(
    population: Population, curvature: FloatArray, slope: FloatArray, damping: FloatArray
) -> FloatArray:
    """Return the Gauss-Newton steps of the unknowns that their limits allow, shape (N, unknowns)."""
    free, unit = free_directions(population, slope), np.eye(slope.shape[1])
    diagonal = np.einsum("npp->np", curvature)
    # The floor of the scale keeps unknowns that nothing depends on from running away.
    scale = diagonal + 1e-3 * diagonal.max(axis=1, keepdims=True) + 1e-12
    # The brackets matter: to add the unit and take it away again would round a small curvature to nothing.
    damped = free @ (curvature + (damping[:, None] * scale)[:, :, None] * unit) @ free + (unit - free)
    return np.asarray(-np.linalg.solve(damped, free @ slope[..., None])[..., 0])
