"""Damped Gauss-Newton steps of many shapes at once, in a norm of the misses that may get sharper."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from synth.synthesis.shapes import Postures, TargetsSeen, category_offsets, category_slopes, overlaps
from synth.synthesis.starts.refined import Refined, Trimmed, relative_weights
from synth.synthesis.starts.residuals import Residuals
from synth.task import Objective

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from synth.arrays import FloatArray
    from synth.synthesis.shapes import Shapes
    from synth.task import Task

# After so many steps each target may take the nearer branch of joint 2, wherever it is.
_STEPS_ON_BRANCHES = 4
_FIRST_DAMPING = 1e-3
_LEAST_DAMPING = 1e-9
_MOST_DAMPING = 1e9
# Exponents of the misses, and from which share of the steps on: where the worst miss counts, a norm that is
# smooth comes first, because its valleys are wide, and then one that is nearly the worst.
_SQUARES = 2.0
_EXPONENTS = {
    Objective.LEAST_SQUARES: ((0.0, _SQUARES),),
    Objective.MINIMAX: ((0.0, _SQUARES), (0.25, 4.0), (0.4, 12.0)),
}
_LEVELLING_STEPS = 6  # with each of ever larger exponents
_LEVELLING_DAMPING = 1e-4
_CLEARING = 10  # steps out of obstacles
_MARGIN = 4e-3  # m, what to keep from these
_DIFFERENCE = 1e-5  # of an unknown, which tells which way leads out
ENOUGH = 20  # shapes that meet all targets, after which the others need not arrive, too
EXACT = 1e-13  # m^2, of squared misses that count as that
_TINY = 1e-30  # m^2


class Descent:
    """Shapes on their way down, each with its postures."""

    def __init__(
        self,
        task: Task,
        aims: TargetsSeen,
        shapes: Shapes,
        postures: Postures,
        is_up: Callable[[], bool],
        *,
        clear: bool,
    ) -> None:
        self._is_up = is_up
        self._task, self._aims, self._weights, self._clear = task, aims, relative_weights(task), clear
        self._trimmed = Trimmed(task)
        self._shapes, self._postures = shapes, postures
        self._damping = np.full(len(shapes.length), _FIRST_DAMPING)
        self._exponent = _SQUARES
        self._cost = self._cost_of(shapes, postures)

    def after(
        self, iterations: int, *, keep_branches: bool, near: bool, enough: int = ENOUGH, met: float = EXACT
    ) -> Refined:
        """Return the shapes after so many steps, or once enough of them cost no more than what is met."""
        for iteration in range(iterations):
            self._measure_by(_exponent_at(self._task, iteration / iterations, near=near))
            self._step()
            if np.count_nonzero(self._cost < met) >= enough or self._is_up():
                break
            last = iteration == iterations - 1
            if not (keep_branches or last) and (iteration + 1) % _STEPS_ON_BRANCHES == 0:
                nearest = Postures.nearest(self._seen_by(self._shapes), self._shapes.kinematics)
                self._postures = nearest.where(nearest.squared < self._postures.squared, self._postures)
                self._cost = self._cost_of(self._shapes, self._postures)
        return Refined(self._shapes, self._postures.joints, self._cost)

    def cleared(self) -> Refined:
        """Return the shapes after steps out of obstacles, with the costs of their misses."""
        self.after(_CLEARING, keep_branches=True, near=True)
        self._clear = False
        return Refined(self._shapes, self._postures.joints, self._cost_of(self._shapes, self._postures))

    def level(self, exponents: Sequence[float]) -> Refined:
        """Return the shapes after steps in ever sharper norms."""
        for exponent in exponents:
            self._measure_by(exponent)
            self._damping = np.full_like(self._damping, _LEVELLING_DAMPING)
            for _ in range(_LEVELLING_STEPS):
                if self._is_up():
                    break
                self._step()
        return Refined(self._shapes, self._postures.joints, self._cost)

    def _seen_by(self, shapes: Shapes) -> TargetsSeen:
        return self._aims if shapes.places is None else TargetsSeen.by(self._task, shapes)

    def _measure_by(self, exponent: float) -> None:
        if exponent != self._exponent:
            self._exponent = exponent
            self._cost = self._cost_of(self._shapes, self._postures)

    def _shares(self, postures: Postures) -> tuple[FloatArray, FloatArray]:
        """Return the squared p-norm of the misses, (N,), and its derivatives by the squared misses, (N, n).

        It is the mean over the targets of weighted misses to the power of the exponent p, to the power of
        2 / p: the mean squared miss for p = 2, nearly the worst, and never above it, for a large p.
        """
        if self._exponent == _SQUARES:
            return self._trimmed.shares(postures.squared)
        weights = len(self._weights) * self._weights
        squared = postures.squared * weights
        worst = squared.max(axis=1) + _TINY
        half = 0.5 * self._exponent
        relative = squared / worst[:, None]
        # Where all targets are met exactly there is no slope, whatever the norm.
        mean = np.maximum(np.mean(relative**half, axis=1), _TINY)
        slopes = (mean ** (1.0 / half - 1.0))[:, None] * relative ** (half - 1.0) * self._weights
        return worst * mean ** (1.0 / half), slopes

    def _cost_of(self, shapes: Shapes, postures: Postures) -> FloatArray:
        off = category_offsets(self._task, shapes)
        cost = self._shares(postures)[0] + np.einsum("ni,ni->n", off, off)
        if self._clear:
            depth = overlaps(self._task, shapes, postures.joints, margin=_MARGIN, is_up=self._is_up)
            cost += np.mean(depth**2, axis=-1)
        return np.asarray(cost)

    def _step(self) -> None:
        """Move each shape by a damped step if that makes it better."""
        residuals = Residuals(self._shapes, self._postures, self._seen_by(self._shapes))
        cost, shares = self._shares(self._postures)
        curvature, slope = residuals.normal_equations(shares)
        if self._exponent != _SQUARES:
            curvature = _curvature_of_norm(self._exponent, cost, curvature, slope)
        by_end = category_slopes(self._task, self._shapes)
        curvature[:, :6, :6] += by_end.transpose(0, 2, 1) @ by_end
        off = category_offsets(self._task, self._shapes)
        slope[:, :6] += np.einsum("nki,nk->ni", by_end, off)

        motion = self._shapes.motion
        by_unknowns = motion.transpose(0, 2, 1)
        by_unknown, curvature = (by_unknowns @ slope[..., None])[..., 0], by_unknowns @ curvature @ motion
        if self._clear:
            depth, deeper = self._depths(residuals)
            by_unknown += np.einsum("ntk,nt->nk", deeper, depth) / depth.shape[1]
            curvature += deeper.transpose(0, 2, 1) @ deeper / depth.shape[1]
        step = _damped_step(self._shapes, curvature, by_unknown, self._damping)
        moved = self._shapes.moved(step)
        second = self._aims.limits.second
        # By how much joint 2 follows is only known to first order; joint 1 is at its best in any case.
        theta2 = self._postures.theta2 + residuals.following((motion @ step[..., None])[..., 0])
        aims = self._seen_by(moved)
        postures = Postures.at(aims, moved.kinematics, np.clip(theta2, second.lower, second.upper))
        cost = self._cost_of(moved, postures)
        if self._clear and self._is_up():
            return  # not all obstacles were looked at
        better = cost < self._cost
        self._shapes = moved.where(better, self._shapes)
        self._postures = postures.where(better[:, None], self._postures)
        self._cost = np.where(better, cost, self._cost)
        self._damping = np.clip(
            np.where(better, 0.2 * self._damping, 8.0 * self._damping), _LEAST_DAMPING, _MOST_DAMPING
        )

    def _depths(self, residuals: Residuals) -> tuple[FloatArray, FloatArray]:
        """Return the depths in obstacles, shape (N, n), m, and by differences how unknowns change them."""
        here, motion, second = self._shapes, self._shapes.motion, self._aims.limits.second
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
            shapes = replace(here, unknowns=moved)
            theta2 = self._postures.theta2 + residuals.following(_DIFFERENCE * motion[..., unknown])
            theta2 = np.clip(theta2[deep], second.lower, second.upper)
            joints = Postures.at(self._seen_by(shapes), shapes.kinematics, theta2).joints
            changed = overlaps(self._task, shapes, joints, margin=_MARGIN, is_up=self._is_up)
            deeper[deep, :, unknown] = (changed - depth[deep]) / _DIFFERENCE
        return depth, deeper


def _exponent_at(task: Task, share: float, *, near: bool) -> float:
    """Return the exponent of the misses after a share of the steps."""
    exponents = _EXPONENTS[task.objective]
    share = max(share, exponents[1][0]) if near and len(exponents) > 1 else share
    return next(exponent for since, exponent in reversed(exponents) if since <= share)


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


def _damped_step(shapes: Shapes, curvature: FloatArray, slope: FloatArray, damping: FloatArray) -> FloatArray:
    """Return the Gauss-Newton steps of the unknowns that their limits allow, shape (N, unknowns)."""
    free, unit = shapes.free_directions(slope), np.eye(slope.shape[1])
    diagonal = np.einsum("npp->np", curvature)
    # The floor of the scale keeps unknowns that nothing depends on from running away.
    scale = diagonal + 1e-3 * diagonal.max(axis=1, keepdims=True) + 1e-12
    # The brackets matter: to add the unit and take it away again would round a small curvature to nothing.
    damped = free @ (curvature + (damping[:, None] * scale)[:, :, None] * unit) @ free + (unit - free)
    return np.asarray(-np.linalg.solve(damped, free @ slope[..., None])[..., 0])
